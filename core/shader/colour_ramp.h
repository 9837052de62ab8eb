#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

/// The meaning of a plugin's colours: an annotated constant of its GLSL. Its shader reads it, and
/// legends show it. A ramp is continuous, steps are classes between edges, entries have names.
///
///     const vec3 tint_slope[2] = vec3[](vec3(1.0, 1.0, 0.9), vec3(0.4, 0.1, 0.3)); //@ ramp(0, 60)
///     unit(°)
///     ... //@ steps(0, 30, 90) unit(°) label("Slope")
///     ... //@ entries(rock, "fresh snow") label("Ground")
namespace relevo::shader {

struct ColourRamp {
    /// A value: of the DEM, a number or a parameter.
    struct End {
        /// Of the DEM [m]: its lowest and highest post, and its lowest post if it has a sea floor.
        enum class Of { Number, Param, Lowest, Highest, Floor };
        Of of = Of::Number;
        double number = 0;
        std::string address;  ///< of a parameter: "tint.low_m"
    };
    std::string name;  ///< in GLSL: tint_slope
    std::vector<std::array<double, 3>>
        colours;           ///< sRGB, 0..1; of a ramp at equal steps of the value
    bool is_ring = false;  ///< directions, degrees clockwise from north; has no ends
    End from, to;
    std::vector<double> edges{};         ///< of steps, rising, one more than colours; else empty
    std::vector<std::string> entries{};  ///< a name for each colour; empty without entries
    std::string unit, label;
    std::string where, where_word;  ///< shown if that enum parameter has that word; or empty
    std::string file;               ///< where it is declared
    int line = 0;
};

/// Reads a ramp from the parts of its declaration.
/// @param owner  the plugin's id, whose parameters its words name
/// @param value  the GLSL text after the =: `vec3[](vec3(0.1, 0.2, 0.3), ...)`
/// @throws Error (BadInput) that names file and line
ColourRamp parse_ramp(std::string_view owner, std::string_view name, std::string_view value,
                      std::string_view annotation, std::string_view file, int line);

}  // namespace relevo::shader
