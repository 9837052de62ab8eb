#include "effect/preset.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    attempt([&] { effect::parse_setting(bytes); });
    effect::load_preset(file(bytes, "preset.json"));
}
