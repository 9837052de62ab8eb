#include "image/ktx.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    const image::TextureData texture = image::read_ktx(file(bytes, "texture.ktx2"));
    for (int level = 0; level < texture.levels(); ++level)
        if (!texture.level(level).empty() && texture.level(level).back() == std::byte{1}) return;
}
