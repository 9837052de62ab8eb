#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Parameters: annotated uniforms of a plugin's GLSL. Panel, JSON, command line and docs follow
/// from them.
///
///     uniform float haze_density = 0.08; //@ range(0, 2) unit(1/km) label("Density")
namespace relevo::shader {

enum class ParamType { Float, Int, Bool, Vec2, Vec3, Vec4 };

std::string_view glsl_name(ParamType type);  ///< "vec3"
int component_count(ParamType type);         ///< 1 to 4

/// The meaning of the components, if it changes how a value is written or uploaded.
enum class ParamRole {
    Plain,
    Colour,      ///< vec3 or vec4, linear light; #rrggbb is sRGB and is linearised
    ColourSrgb,  ///< vec3 or vec4, sRGB, not linearised; for `display` hooks
    Angle,       ///< float; degrees for people, radians in the shader
    Direction,   ///< vec3: east, north, up; normalised in the shader
};

/// A value as people write it (angles in degrees). Unused components are 0. A bool is 0 or 1, an
/// enum the index of its word.
using ParamValue = std::array<double, 4>;

struct ParamRange {
    double min = 0;
    double max = 1;
};

struct Param {
    std::string name;     ///< in GLSL: haze_density
    std::string address;  ///< elsewhere: haze.density
    ParamType type = ParamType::Float;
    ParamRole role = ParamRole::Plain;
    ParamValue initial{};             ///< the default
    std::optional<ParamRange> range;  ///< of every component, inclusive
    std::string unit;                 ///< "1/km", or empty
    std::string label;                ///< "Density"
    std::string description;          ///< a sentence, or empty
    std::vector<std::string> words;   ///< of an enum, for the values 0, 1, 2 ...
    bool is_static = false;           ///< a constant in the text: a new value needs a new program
    bool is_host = false;  ///< written by a native module for every frame; people cannot set it
    std::string file;      ///< where it is declared
    int line = 0;
};

/// Reads a value as people write it: `0.2`, `true`, `0.1,0.2,0.3`, `linear` (an enum's word),
/// `#ff8800` (a colour).
/// @throws Error (BadInput) that names address, type and range:
///         `haze.density: expected a float in [0, 2] 1/km but got "5"`
ParamValue parse_value(const Param& param, std::string_view text);

/// "#rrggbb", or with four components "#rrggbbaa", as sRGB from 0 to 1; none of another text.
std::optional<ParamValue> parse_hex_colour(std::string_view text, int components);

/// The shortest text that parse_value reads back as the same value.
std::string format_value(const Param& param, const ParamValue& value);

/// The values that a parameter takes: "a float in [0, 2] 1/km", "one of linear, square".
std::string describe_values(const Param& param);

/// The same for a given value, which may be a number outside a float's range.
std::string expected_values(const Param& param, const ParamValue& given);

/// Whether the parameter may have the value.
bool is_valid(const Param& param, const ParamValue& value);

/// The value for the shader: angles in radians, directions of unit length.
std::array<float, 4> shader_value(const Param& param, const ParamValue& value);

/// The value as a GLSL constant expression: `vec3(0.1, 0.2, 0.3)`.
std::string glsl_value(const Param& param, const ParamValue& value);

}  // namespace relevo::shader
