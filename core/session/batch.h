#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files_in_use.h"
#include "scene/job.h"
#include "session/audit.h"
#include "session/moments.h"

/// Many pictures, drawn one after the other.
namespace relevo::session {

/// Makes of each shot's scene what pictures carry: its moment in UTC, absolute paths, effects that
/// there are.
/// @throws Error (BadInput) for effects and parameters that there are not, with the name of the
///     first picture that would have them
void settle(std::vector<scene::Shot>& shots, Moments& moments);

/// Whether a file is a whole picture of exactly that scene, and no older than any of `inputs`.
bool is_made(const scene::Shot& shot, const std::vector<std::filesystem::path>& inputs);

/// Where the JSON beside a picture is.
std::filesystem::path sidecar_of(std::filesystem::path picture);

/// The same, to be written. @throws Error (BadInput) where it is a pipe or a device, which would
/// keep the program waiting though nobody has named it
std::filesystem::path sidecar_to_write(const std::filesystem::path& picture);

/// Whether it is there. @param audited  with an audit in it
bool has_sidecar(const std::filesystem::path& picture, bool audited);

/// Says that there is no ground in a picture. @throws Error (Failed), always
[[noreturn]] void refuse_blank(std::string_view who);

/// Puts shots in the order in which least is loaded and compiled again; shots that share DEM and
/// effects keep theirs.
void order_for_drawing(std::vector<scene::Shot>& shots);

struct BatchOptions {
    std::string device = "auto";  ///< as gl::Context takes it
    std::string version;          ///< of the program, for the pictures
    bool overwrite = false;
    bool sidecar = false;      ///< a JSON beside each picture, of its name and .json
    bool audit = false;        ///< puts the audit of the shadows into it; needs `sidecar`
    bool allow_blank = false;  ///< pictures without ground are written too
    /// A picture is there, or is not and why: both are called on one thread at a time.
    std::function<void(const scene::Shot&)> made = [](const scene::Shot&) {};
    std::function<void(const scene::Shot&, const std::string& why)> failed =
        [](const scene::Shot&, const std::string&) {};
    /// What an audit has found, on the thread that draws.
    std::function<void(const scene::Shot&, const ShadowAudit&)> audited = [](const scene::Shot&,
                                                                             const ShadowAudit&) {};
};

/// Draws pictures and writes them, each whole or not at all. Drawing goes on while pictures are
/// encoded on other threads; of a few at most the pixels are in memory. A picture that cannot be
/// made is told of by BatchOptions::failed, and the rest go on.
/// @param shots    settled, ordered
/// @param moments  has the DEMs that are open already
/// @returns how many failed
/// @throws Error where a first session cannot be opened, as Session's constructor
std::size_t draw_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                       Moments& moments, FilesInUse& files);

/// How long draw_batch() would take [s], as three of the shots do that are drawn, and nothing
/// written, on top of what opens the session.
/// @throws Error as Session's constructor, and where those cannot be drawn
double time_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                  Moments& moments);

}  // namespace relevo::session
