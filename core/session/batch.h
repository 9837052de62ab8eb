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
#include "session/scene_inputs.h"
#include "session/scene_times.h"

/// Draws many pictures, one after the other.
namespace relevo::session {

/// Completes a shot's scene as it is recorded in its picture: time in UTC, absolute paths,
/// installed effects only.
/// @throws Error (BadInput) for unknown effects and parameters
void settle(scene::Shot& shot, SceneTimes& times, SceneInputs& inputs);

/// Completes each shot's scene as it is recorded in its picture: time in UTC, absolute paths,
/// installed effects only.
/// @throws Error (BadInput) for unknown effects and parameters; the message names the first picture
///     that uses them
void settle(std::vector<scene::Shot>& shots, SceneTimes& times, SceneInputs& inputs);

/// Sorts shots so that DEMs and effects are loaded as rarely as possible. Shots that share both
/// keep their order.
void order_for_drawing(std::vector<scene::Shot>& shots);

struct BatchOptions {
    std::string device = "auto";  ///< as gl::Context
    bool overwrite = false;
    /// Pictures that are replaced even without `overwrite`, with their sidecars: OnDisk::Part.
    std::set<std::filesystem::path> parts;
    /// Writes a JSON sidecar for each picture (its name with .json). A picture whose format cannot
    /// hold its scene always gets one.
    bool sidecar = false;
    image::Encoding encoding{};  ///< of the pictures
    PictureFormat format{};
    bool audit = false;        ///< adds the shadow audit to the sidecar; needs `sidecar`
    bool allow_blank = false;  ///< also writes pictures without ground
    /// Callbacks for pictures that were written, failed, or show no ground of the DEM. They run on
    /// several threads, never two at once.
    std::function<void(const scene::Shot&)> made = [](const scene::Shot&) {};
    std::function<void(const scene::Shot&, const std::string& why)> failed =
        [](const scene::Shot&, const std::string&) {};
    std::function<void(const scene::Shot&)> blank = [](const scene::Shot&) {};
    /// Called with each audit, on the thread that draws.
    std::function<void(const scene::Shot&, const ShadowAudit&)> audited = [](const scene::Shot&,
                                                                             const ShadowAudit&) {};
};

/// Draws pictures and writes them; files appear complete or not at all. Pictures are encoded on
/// other threads while the next ones are drawn; only a few are in memory at once.
/// BatchOptions::failed or ::blank reports a picture that could not be written, and the batch
/// continues.
/// @param shots    settled and ordered
/// @param times  holds the DEMs that are already open
/// @param inputs   what pictures record of their input files
/// @returns the number of pictures that failed
/// @throws Error if the first session cannot be opened, as Session's constructor
std::size_t draw_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                       SceneTimes& times, SceneInputs& inputs, FilesInUse& files);

/// Estimates the duration of draw_batch() [s] from opening a session and drawing three of the
/// shots. Writes nothing.
/// @throws Error as Session's constructor, and if those shots cannot be drawn
double time_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                  SceneTimes& times);

}  // namespace relevo::session
