#pragma once

#include <optional>
#include <span>

#include "shader/conditions.h"

namespace relevo::shader {

/// Whole numbers of a plugin's GLSL that are known before compilation.
class Constants {
  public:
    /// Adds the largest values of a file's static parameters.
    void add_params(const Source& source);
    /// Adds what the token `i` of a file defines: a macro, or a `const int` or `const uint`.
    void add(const Source& source, std::size_t i);
    /// The value of an expression, of the length of an array for one; none if it is not known.
    std::optional<double> value(const Source& source, std::span<const Token> expression) const;

  private:
    Macros known_;
};

}  // namespace relevo::shader
