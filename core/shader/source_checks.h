#pragma once

#include "shader/source.h"

/// Checks of a whole file before it is parsed. All throw Error (BadInput).
namespace relevo::shader {

/// A plugin's file has no words that are reserved for GLSL or core.
void check_words(const Source& source);

/// Every bracket is closed in its file and in its branch of a conditional. Otherwise an error would
/// name the next plugin. Sets Token::partner.
void pair_brackets(Source& source);

}  // namespace relevo::shader
