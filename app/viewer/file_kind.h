#pragma once

#include <string>

#include "effect/registry.h"

namespace relevo::viewer {

/// What the window does with a file that is dropped on it or opened.
enum class FileKind {
    Dem,         ///< opens it; also for files of unknown kinds, since errors say what is wrong
    Scene,       ///< opens the scene
    Job,         ///< opens the job's scene
    Picture,     ///< opens the scene in it
    Photograph,  ///< stands where it was taken, at its time
    Places,      ///< points: marks of an effect
    Lines,       ///< lines and polygons: lines of an effect
    Overlay,     ///< an image of the ground, or figures of the sun: on the ground
};

/// The kind of a file by its name and contents. Files that cannot be read are DEMs.
FileKind kind_of_file(const std::string& path);

/// Whether a name is that of a file that goes on or over a DEM: tracks, places, pictures, scenes.
bool is_name_of_layer(const std::string& path);

/// Whether GDAL opens a file as a raster.
bool is_raster_file(const std::string& path);

/// The text with the file of the first effect by id that draws places, such as "labels.file", or
/// lines.
/// @param kind  Places or Lines
/// @returns empty if no effect is installed that does
std::string file_text_for(FileKind kind, const effect::Registry& registry);

}  // namespace relevo::viewer
