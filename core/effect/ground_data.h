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

/// Values around the DEM by place, an entry of "textures" of the kind "field": from a raster that
/// the user chooses, or from the scene's weather. The plugin reads it by functions that
/// field_glsl() defines.
struct FieldSpec {
    std::string name;      ///< "local_cover"
    std::string resource;  ///< "clouds.local_cover"
    std::string file;      ///< "clouds.cover_file": the text with its path
    std::string weather;   ///< of weather::fact_fields(): taken without a file; may be empty
    double most = 1;       ///< largest value that there may be; the least is 0
    int line = 0;          ///< in plugin.json
};

/// As read_raster_spec().
FieldSpec read_field_spec(json::ObjectReader& object, const std::string& id,
                          const std::string& name, int line);

/// What a picture says while no file is set for data of an effect.
/// @param address  "drape.file"
std::string no_file_text(const std::string& address);

/// The function that reads a raster at a point of the ground: `vec4 <id>_<name>(in Surface s)` for
/// colours, `vec2 <id>_<name>(in Surface s)` for values.
std::string raster_glsl(const RasterSpec& raster, const std::string& id);

/// The functions that read a field at a place, metres east and north of the DEM's centre:
/// `vec2 <id>_<name>(in vec2 place_m)`, the value and the part of the place that has one;
/// `float <id>_<name>_mean()`, the mean over the DEM, and `float <id>_<name>_most()`, the largest
/// value: both -1 without a field.
std::string field_glsl(const FieldSpec& field, const std::string& id);

}  // namespace relevo::effect
