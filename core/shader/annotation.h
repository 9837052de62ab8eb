#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shader/params.h"

namespace relevo::shader {

/// One word of a `//@` comment: `range(0, 2)`, `static`.
struct AnnotationWord {
    std::string name;
    std::vector<std::string> arguments;  ///< trimmed; quoted ones without their quotes

    std::string written() const;  ///< "range(0, 2)"
};

/// Reads the text after `//@`.
/// @throws Error (BadInput) that names file and line
std::vector<AnnotationWord> parse_annotation(std::string_view text, std::string_view file,
                                             int line);

/// Reads a parameter from the parts of its declaration.
/// @param initial  the GLSL text of the default, "vec3(0.1, 0.2, 0.3)"
/// @throws Error (BadInput) that names file and line
Param parse_param(std::string_view type, std::string_view name, std::string_view initial,
                  std::string_view annotation, std::string_view file, int line);

/// The parameter type with that GLSL name; none if there is none.
std::optional<ParamType> param_type(std::string_view glsl_name);

/// "haze.noise_scale" for haze_noise_scale.
std::string address_of(std::string_view name);

}  // namespace relevo::shader
