#include "effect/ground_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "weather/facts.h"

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

FieldSpec read_field_spec(json::ObjectReader& object, const std::string& id,
                          const std::string& name, int line) {
    FieldSpec spec{.name = name, .resource = id + '.' + name, .line = line};
    spec.file = id + '.' + object.string("from");
    spec.weather = object.string("weather", "");
    if (!spec.weather.empty() && !contains(weather::fact_fields(), spec.weather))
        object.fail(object.line_of("weather"), "weather",
                    fmt::format("expected one of {} but got \"{}\"",
                                fmt::join(weather::fact_fields(), ", "), spec.weather));
    spec.most = object.number("most", 1, 1e-6, 1e9, false);
    return spec;
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

std::string field_glsl(const FieldSpec& field, const std::string& id) {
    return fmt::format(
        "//@ include lib/field.glsl\n"
        "uniform sampler2D {0}_texels;\n"
        "uniform vec4 {0}_place = vec4(0.0); //@ host\n"
        "uniform vec4 {0}_shape = vec4(1.0, 1.0, -1.0, -1.0); //@ host\n"
        "vec2 {0}(in vec2 place_m) {{\n"
        "    return field_value({0}_texels, {0}_place, {0}_shape, place_m);\n"
        "}}\n"
        "float {0}_mean() {{ return {0}_shape.z; }}\n"
        "float {0}_most() {{ return {0}_shape.w; }}\n",
        id + '_' + field.name);
}

}  // namespace relevo::effect
