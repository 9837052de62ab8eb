#include "effect/ground_data.h"

#include <fmt/format.h>

namespace relevo::effect {

RasterSpec read_raster_spec(json::ObjectReader& object, const std::string& id,
                            const std::string& name, int line) {
    RasterSpec spec;
    spec.name = name;
    spec.resource = id + '.' + name;
    spec.line = line;
    spec.file = id + '.' + object.string("from");
    spec.is_values = object.choice("holds", {"colours", "values"}, 0) == 1;
    if (const std::string colours = object.string("colours", ""); !colours.empty()) {
        if (spec.is_values)
            object.fail(object.line_of("colours"), "colours",
                        "expected it of a raster that holds colours only");
        spec.colours = id + '.' + colours;
    }
    return spec;
}

LinesSpec read_lines_spec(json::ObjectReader& object, const std::string& id,
                          const std::string& name, int line) {
    return {.name = name,
            .resource = id + '.' + name,
            .file = id + '.' + object.string("from"),
            .attribute = object.string("attribute", ""),
            .line = line};
}

std::string no_file_text(const std::string& address) {
    return fmt::format("{} draws nothing: no file is set; --set {}=FILE sets one",
                       address.substr(0, address.find('.')), address);
}

std::string raster_glsl(const RasterSpec& raster, const std::string& id) {
    const std::string name = id + '_' + raster.name;
    return fmt::format(
        "//@ include lib/raster.glsl\n"
        "uniform sampler2DArray {0}_pages;\n"
        "uniform usampler2D {0}_table;\n"
        "uniform vec4 {0}_place = vec4(0.0); //@ host\n"
        "uniform vec4 {0}_shape = vec4(0.0); //@ host\n"
        "{1} {0}(in Surface s) {{\n"
        "    return {2}(raster_texels({0}_pages, {0}_table, {0}_place, {0}_shape, s.post, "
        "s.pixel_posts));\n"
        "}}\n",
        name, raster.is_values ? "vec2" : "vec4",
        raster.is_values ? "raster_value" : "raster_colour");
}

}  // namespace relevo::effect
