#include <string>

#include "fuzz/fuzz.h"
#include "shader/snippet.h"

namespace relevo::fuzz {

const Target kGlsl("glsl", [](std::string_view bytes) {
    attempt([&] { shader::parse_snippet("haze", "haze.glsl", bytes); });
    shader::parse_source(shader::SourceKind::Lib, "core", "lib.glsl", bytes);
});

}  // namespace relevo::fuzz
