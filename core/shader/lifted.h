#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "shader/source_cursor.h"

/// Declarations that are lifted out of a file: the stitcher declares them for all files at once.
/// The cursor is after the name, and then after the semicolon. All throw Error (BadInput).
namespace relevo::shader {

using Qualifiers = std::set<std::string, std::less<>>;

/// A parameter or a sampler.
/// @param first  token of the declaration; its type and name are the tokens `type` and `name`
void read_uniform(SourceCursor& cursor, std::size_t first, std::size_t type, std::size_t name);
void read_varying(SourceCursor& cursor, std::size_t first, std::size_t type, std::size_t name,
                  const Qualifiers& qualifiers);
/// A ramp of colours, if the declaration of variables that ends before the cursor has an
/// annotation. It stays in the file.
/// @param names  that are declared
void read_ramp(SourceCursor& cursor, std::size_t first, std::size_t name, std::size_t names);

}  // namespace relevo::shader
