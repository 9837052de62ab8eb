#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shader/source.h"

/// Evaluates the #if directives of a file as far as their values are known before compilation: a
/// function that only an inactive branch calls can be omitted from the text.
namespace relevo::shader {

/// Macros by name. Empty: defined, but as a function or in an undecided branch.
using Macros = std::map<std::string, std::optional<std::string>, std::less<>>;

struct Conditions {
    std::vector<bool> active;  ///< per token: may be compiled
    /// The directives of each #if that must stay, tokens from the #if to the #endif.
    std::vector<std::vector<std::size_t>> undecided;
};

/// Evaluates a file's directives in order.
/// @param macros  that are defined before the file; the file's own are added
Conditions evaluate_conditions(const Source& source, Macros& macros);

/// The value of an #if expression of integers, `defined` and macros with such values; else none.
std::optional<long long> evaluate_expression(std::string_view expression, const Macros& macros);

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
