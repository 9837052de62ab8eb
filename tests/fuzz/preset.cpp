#include "effect/preset.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kPreset("preset", [](std::string_view bytes) {
    attempt([&] { effect::parse_setting(bytes); });
    if (!effect::is_preset_file(std::string(bytes)))
        attempt([&] { effect::load_preset(std::string(bytes)); });
    effect::load_preset(file(bytes, "preset.json"));
});

}  // namespace relevo::fuzz
