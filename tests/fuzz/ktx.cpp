#include "image/ktx.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

namespace {

/// What is read is written as it was.
void expect_same_again(const image::TextureData& read) {
    const std::filesystem::path path = folder() / "written.ktx2";
    std::filesystem::remove(path);
    image::write_ktx(path, read);
    const image::TextureData again = image::read_ktx(path);
    for (int level = 0; level < read.levels(); ++level)
        if (!std::ranges::equal(again.level(level), read.level(level))) std::abort();
}

}  // namespace

const Target kKtx("ktx", [](std::string_view bytes) {
    const image::TextureData texture = image::read_ktx(file(bytes, "texture.ktx2"));
    expect_same_again(texture);
});

}  // namespace relevo::fuzz
