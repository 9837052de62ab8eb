#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "chart/legend.h"
#include "scene/film_job.h"
#include "scene/scene.h"
#include "session/overlay_time.h"
#include "viewer/document.h"
#include "viewer/scene_thread.h"
#include "viewer/sun_model.h"

/// Exports from the window to files.
namespace relevo::viewer {

/// Thrown to end an export that the user has cancelled.
struct Cancelled {};

/// The document as `relevo capture` reads it from any working folder.
scene::Scene whole_scene(const Document& document, const Land& land, glm::ivec2 size_px);

/// Writes a file to the working folder under a free name such as relevo-1.png.
/// @param write  finishes the file
/// @returns the name
std::string write_under_free_name(const std::string& ending,
                                  const std::function<void(OutputFile&)>& write);

/// A name in the working folder that no file has: "day.mp4", "day-2.mp4" ...
/// @param stem  may have folders in front
std::string free_name(const std::string& stem, const std::string& ending);
/// The folder of a file, absolute, for a message.
std::string folder_of(const std::string& file);
/// A free name for a picture in the working folder: "picture.png", "picture-2.png" ...
std::string free_picture_name();
/// Writes the scene to the working folder under a free name.
/// @returns the message for the user
/// @throws Error as OutputFile
std::string save_scene(const scene::Scene& scene);
/// Writes a job that renders the scene at every hour of a day: from sunrise to sunset if the day
/// has both. Returns and throws as save_scene().
std::string save_job(const scene::Scene& scene, const SunDay& day, const sun::Zone& zone);

/// Writes the job of a film. Returns and throws as save_scene().
std::string save_film_job(const scene::Scene& scene, const scene::FilmJob& film);

/// The legends of a picture, and the time of its overlay if it is not the scene's.
struct Coloured {
    std::vector<chart::Legend> legends;
    std::optional<session::OverlayTime> overlay_time;
};

/// Writes a picture with the scene's stamps. Its metadata have the command that renders it.
/// @param scene   of the picture, with an eye
/// @param opened  its DEM
/// Returns and throws as save_scene(); also throws Error if a pixel is not a number.
std::string save_picture(const Picture& picture, scene::Scene scene, const Opened& opened,
                         const Coloured& coloured);

}  // namespace relevo::viewer
