#pragma once

#include <string>

#include "json/object_reader.h"

namespace relevo::effect {

/// A raster on the ground that the user chooses, an entry of "textures" of the kind "raster". The
/// plugin reads it by a function of its name that raster_glsl() defines.
struct RasterSpec {
    std::string name;        ///< "photo"
    std::string resource;    ///< "drape.photo": its name on the device
    std::string file;        ///< "drape.file": the text with its path
    std::string colours;     ///< "drape.colours": the text with the colours of one band; or empty
    bool is_values = false;  ///< values of a band; else colours
    int line = 0;            ///< in plugin.json
};

/// Reads an entry of "textures" without its "kind".
/// @param id  of the plugin
/// @throws Error (BadInput) with file and line
RasterSpec read_raster_spec(json::ObjectReader& object, const std::string& id,
                            const std::string& name, int line);

/// Lines on the ground that the user chooses, an entry of "textures" of the kind "lines".
struct LinesSpec {
    std::string name;       ///< "way"
    std::string resource;   ///< "tracks.way": its name for the stitcher
    std::string file;       ///< "tracks.file": address of the text with the file's path
    std::string attribute;  ///< a field's name, or the plugin's text "by" with it; may be empty
    int line = 0;           ///< in plugin.json
};

/// As read_raster_spec().
LinesSpec read_lines_spec(json::ObjectReader& object, const std::string& id,
                          const std::string& name, int line);

/// What a picture says while no file is set for data of an effect.
/// @param address  "drape.file"
std::string no_file_text(const std::string& address);

/// The function that reads a raster at a point of the ground: `vec4 <id>_<name>(in Surface s)` for
/// colours, `vec2 <id>_<name>(in Surface s)` for values.
std::string raster_glsl(const RasterSpec& raster, const std::string& id);

}  // namespace relevo::effect
