#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dem/source.h"
#include "effect/preset.h"
#include "scene/view.h"

namespace relevo::scene {

/// When, in the words that people use: what the command line takes as --time, --date and --tz.
struct Moment {
    std::string time;  ///< "2026-06-21T18:30+02:00", "sunset-30min"; empty: a summer morning
    std::string date;  ///< of an event
    std::string zone;  ///< "Europe/Zurich", "auto", "solar"; empty: auto, by the place
};

/// Which effects are on, with which values.
struct Effects {
    effect::Switches switches;
    std::vector<std::string> presets;  ///< names and paths, applied in turn before the rest
    std::vector<effect::Setting> settings;
    std::vector<std::string> plugin_path;  ///< folders of further plugins
};

/// Everything that decides about a picture but the device it is drawn on: a value, which the
/// command line, files and windows make, and a session draws.
struct Scene {
    std::vector<std::string> dems;  ///< names that GDAL opens; several are one DEM
    dem::LoadOptions dem;           ///< how they are read
    Moment moment;
    std::string refraction = "standard";  ///< standard, saemundsson or none
    View view;
    double exaggeration = 1;  ///< 0.01 to 1000
    Effects effects;
    int width_px = 1280, height_px = 1024;  ///< 1 to kMaxSide_px
    double exposure_ev = 0;                 ///< -20 to 20
    double pixel_error = 4;                 ///< 0 to 100: render::TerrainOptions
};

inline constexpr int kMaxSide_px = 16384;

/// Reads a scene from a file, docs/scene.md. Paths that are relative count from the file's folder.
/// @throws Error (BadInput) `scene: FILE:LINE: camera.fov: what, expected E but got G`
Scene read_scene(const std::filesystem::path& path);

/// The same from a text, such as that inside a picture.
/// @param file    as messages name it
/// @param folder  from which relative paths count
Scene read_scene_text(const std::string& text, const std::string& file,
                      const std::filesystem::path& folder);

/// Effects with a change: `only` and presets replace those before, the rest is added; what is
/// switched on is no longer off, and the other way round; of a parameter the last value counts.
Effects merge(Effects effects, const Effects& change);

/// The file of a scene. Paths below `folder` are written relative to it, others absolute.
std::string scene_text(const Scene& scene, const std::filesystem::path& folder);

/// The same on one line, with absolute paths: what pictures carry, and what tells whether two
/// scenes are one.
std::string scene_line(const Scene& scene);

/// The same with absolute names of the files there are, which then hold in any folder.
Scene with_absolute_paths(Scene scene);

}  // namespace relevo::scene
