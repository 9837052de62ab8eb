#pragma once

#include "shader/source.h"

/// Checks of a file as a whole, before it is taken apart. All throw Error (BadInput).
namespace relevo::shader {

/// Names that GLSL or core keep to themselves, in a plugin's file.
void check_words(const Source& source);

/// Every bracket is closed in its own file, and in its own branch of a conditional, so that a
/// forgotten brace is not blamed on the next plugin.
void check_brackets(const Source& source);

}  // namespace relevo::shader
