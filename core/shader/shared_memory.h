#pragma once

#include <cstddef>

#include "shader/source.h"

namespace relevo::shader {

/// Whether a declaration is `shared`: memory of a work group of a compute pass.
bool is_shared(const Source& source, const Item& item);

/// Bytes of a shared variable, each vector of three rounded up to four, as devices may lay it out.
/// Lengths of arrays are products of numbers and of constants and macros of the file that are
/// numbers.
/// @throws Error (BadInput) `shader: file:line: ...` for other types and lengths, for several
/// variables in one
///     declaration, and for initial values
std::size_t shared_bytes(const Source& source, const Item& item);

}  // namespace relevo::shader
