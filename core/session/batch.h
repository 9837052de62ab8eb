#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "scene/job.h"
#include "session/audit.h"
#include "session/moments.h"
#include "session/scene_inputs.h"

/// Many pictures, drawn one after the other.
namespace relevo::session {

/// Makes of each shot's scene what pictures carry: its moment in UTC, absolute paths, effects that
/// there are.
/// @throws Error (BadInput) for effects and parameters that there are not, with the name of the
///     first picture that would have them
void settle(std::vector<scene::Shot>& shots, Moments& moments, SceneInputs& inputs);

/// Puts shots in the order in which least is loaded and compiled again; shots that share DEM and
/// effects keep theirs.
void order_for_drawing(std::vector<scene::Shot>& shots);

struct BatchOptions {
    std::string device = "auto";  ///< as gl::Context takes it
    bool overwrite = false;
    /// Pictures that are replaced, with their sidecars, also without `overwrite`: OnDisk::Part.
    std::set<std::filesystem::path> parts;
    /// Writes a JSON beside each picture, of its name and .json; a picture whose format has no room
    /// for its scene has one in any case.
    bool sidecar = false;
    bool audit = false;        ///< puts the audit of the shadows into it; needs `sidecar`
    bool allow_blank = false;  ///< pictures without ground are written too
    /// A picture is there, or is not and why, or would show no ground of the DEM: each is called on
    /// one thread at a time.
    std::function<void(const scene::Shot&)> made = [](const scene::Shot&) {};
    std::function<void(const scene::Shot&, const std::string& why)> failed =
        [](const scene::Shot&, const std::string&) {};
    std::function<void(const scene::Shot&)> blank = [](const scene::Shot&) {};
    /// What an audit has found, on the thread that draws.
    std::function<void(const scene::Shot&, const ShadowAudit&)> audited = [](const scene::Shot&,
                                                                             const ShadowAudit&) {};
};

/// Draws pictures and writes them, each whole or not at all. Drawing goes on while pictures are
/// encoded on other threads; of a few at most the pixels are in memory. A picture that cannot be
/// made is reported by BatchOptions::failed or ::blank, and the rest go on.
/// @param shots    settled, ordered
/// @param moments  has the DEMs that are open already
/// @param inputs   what pictures say they were made from
/// @returns how many failed
/// @throws Error where a first session cannot be opened, as Session's constructor
std::size_t draw_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                       Moments& moments, SceneInputs& inputs, FilesInUse& files);

/// How long draw_batch() would take [s], as three of the shots do that are drawn, and nothing
/// written, on top of what opens the session.
/// @throws Error as Session's constructor, and where those cannot be drawn
double time_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                  Moments& moments);

}  // namespace relevo::session
