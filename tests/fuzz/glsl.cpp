#include <string>

#include "fuzz/fuzz.h"
#include "shader/snippet.h"

void relevo::fuzz::read(std::string_view bytes) {
    attempt([&] { shader::parse_snippet("haze", "haze.glsl", bytes); });
    shader::parse_source(shader::SourceKind::Lib, "core", "lib.glsl", bytes);
}
