#include "image/ktx.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kKtx("ktx", [](std::string_view bytes) {
    const image::TextureData texture = image::read_ktx(file(bytes, "texture.ktx2"));
    for (int level = 0; level < texture.levels(); ++level)
        if (!texture.level(level).empty() && texture.level(level).back() == std::byte{1}) return;
});

}  // namespace relevo::fuzz
