#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "fuzz/fuzz.h"
#include "image/png.h"
#include "image/xmp.h"
#include "session/record_reader.h"

namespace relevo::fuzz {

namespace {

/// A PNG of moderate size that is read is written as it was, with the texts that are read.
void expect_same_again(const std::filesystem::path& path) {
    image::Metadata texts;
    const image::Image8 read = image::read_png(path, &texts);
    const std::filesystem::path again = folder() / "again.png";
    OutputFile file(again, /*overwrite=*/true, "fuzz");
    image::write_png(file, read, texts);
    file.finish();
    if (image::read_png(again).values != read.values) std::abort();
}

/// The texts of a packet, in packets of our own pictures.
void repeat_xmp(std::string_view bytes) {
    const std::string packet = image::xmp_packet(image::texts_in_xmp(bytes));
    for (const std::string_view ending : {std::string_view("RIFF____WEBPVP8X__________________"),
                                          std::string_view("RIFF____WEBPVP8L__________________")}) {
        std::vector<std::byte> webp(ending.size());
        std::ranges::transform(ending, webp.begin(),
                               [](char c) { return static_cast<std::byte>(c); });
        image::add_xmp_to_webp(webp, packet, 16, 16);
    }
    std::vector<std::byte> jpeg{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}, std::byte{0xd9}};
    image::add_xmp_to_jpeg(jpeg, packet);
}

}  // namespace

// Pictures are told apart by the endings of their names. What no picture begins like is a sidecar.
const Target kRecord("record", [](std::string_view bytes) {
    file(bytes, "picture.jpg.json");
    repeat_xmp(bytes);
    if (bytes.starts_with("\x89PNG")) {
        const std::filesystem::path path = file(bytes, "picture.png");
        attempt([&] { session::read_record(path); });
        expect_same_again(path);
    } else if (bytes.starts_with("\xff\xd8")) {
        session::read_record(file(bytes, "picture.jpg"));
    } else {
        session::shallow_json(std::string(bytes));
    }
});

}  // namespace relevo::fuzz
