#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "chart/legend.h"
#include "scene/scene.h"
#include "session/overlay_time.h"
#include "viewer/document.h"
#include "viewer/scene_thread.h"
#include "viewer/sun_model.h"

/// What is taken out of the window into files and the clipboard.
namespace relevo::viewer {

/// The document as `relevo capture` takes it from any folder.
scene::Scene whole_scene(const Document& document, const Land& land, glm::ivec2 size_px);

/// Writes to a name in the working folder that no file has, such as relevo-1.png. @returns it
/// @param write  which finishes the file
std::string write_under_free_name(const std::string& ending,
                                  const std::function<void(OutputFile&)>& write);

/// A name for a picture that the working folder does not have: "picture.png", "picture-2.png" ...
std::string free_picture_name();
/// Writes the scene into the working folder under a name that is free. @returns what to tell of it
/// @throws Error as OutputFile; likewise below
std::string save_scene(const scene::Scene& scene);
/// Likewise a job of the scene at every hour of a day, from sunrise to sunset where the sun rises
/// and sets on it.
std::string save_job(const scene::Scene& scene, const SunDay& day, const sun::Zone& zone);

/// What colours of a picture mean, and the time of the sun that they show where it is not the
/// scene's.
struct Coloured {
    std::vector<chart::Legend> legends;
    std::optional<session::OverlayTime> overlay_time;
};

/// Saves a picture with the scene's stamps and the command that takes it.
/// @param scene   of the picture, with an eye
/// @param opened  its DEM
/// @returns as save_job()
std::string save_picture(const Picture& picture, const scene::Scene& scene, const Opened& opened,
                         const Coloured& coloured);

}  // namespace relevo::viewer
