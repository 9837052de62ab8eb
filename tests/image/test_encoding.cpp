// What a picture file can hold beside 8-bit colours: more bits, alpha, layers, rows on their way.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "base/output_file.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::image {
namespace {

class Encodings : public testing::Test {
  protected:
    std::filesystem::path write_file(const std::string& name, const Picture& picture,
                                     const Encoding& encoding = {}, const Metadata& metadata = {}) {
        const std::filesystem::path path = dir_ / name;
        OutputFile file(path, true, "image");
        write(file, picture, metadata, encoding);
        file.finish();
        return path;
    }

    std::filesystem::path dir_ = test::scratch_dir("encoding");
};

Image16 ramp(int channels) {
    Image16 image(300, 20, channels);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<std::uint16_t>(i * 40503U);  // all bits change
    return image;
}

TEST_F(Encodings, SixteenBitsComeBackAsTheyWere) {
    for (const char* name : {"a.png", "a.tif"})
        for (const int channels : {3, 4}) {
            const Image16 image = ramp(channels);
            const ImageF back = read_float(write_file(name, {image}, {.bits = 16}));
            ASSERT_EQ(back.channels, channels) << name;
            for (std::size_t i = 0; i < image.values.size(); ++i)
                ASSERT_EQ(std::lround(65535 * back.values[i]), image.values[i]) << name << i;
        }
}

TEST_F(Encodings, StraightAlphaStaysStraight) {
    // A bright colour under little alpha: whoever multiplies it cannot get it back in 8 bits.
    Image8 image(64, 48, 4);
    for (std::size_t i = 0; i < image.values.size(); i += 4) {
        image.values[i] = 200;
        image.values[i + 1] = 100;
        image.values[i + 2] = 50;
        image.values[i + 3] = 16;
    }
    for (const char* name : {"a.png", "a.tif", "a.webp", "a.avif"}) {
        const Image8 back = read(write_file(name, {image}));
        ASSERT_EQ(back.channels, 4) << name;
        EXPECT_LE(compare(back, image).worst, 3) << name;
    }
}

TEST_F(Encodings, QualityDecidesAboutTheSize) {
    Image8 image(128, 128, 3);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<std::uint8_t>(i * 2654435761U >> 13);
    for (const char* name : {"a.jpg", "a.webp", "a.avif"}) {
        const auto size = [&](int quality) {
            return std::filesystem::file_size(write_file(name, {image}, {.quality = quality}));
        };
        EXPECT_LT(2 * size(20), size(95)) << name;
    }
}

TEST_F(Encodings, AvifCarriesItsTexts) {
    const auto path =
        write_file("a.avif", {Image8(16, 16, 3)}, {}, {{"relevo:scene", "{\"a\": 1}"}});
    EXPECT_EQ(read_metadata(path).at("relevo:scene"), "{\"a\": 1}");
}

TEST_F(Encodings, LayersAreLossless) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    ImageF colour(3, 2, 4);
    for (std::size_t i = 0; i < colour.values.size(); ++i)
        colour.values[i] = static_cast<float>(i) / 8;
    const std::vector<Channel> layers{
        {.name = "depth.Z", .values = {0.1F, 12345.678F, kInfinity, 3, 4, 5}},
        {.name = "ids.kind", .is_whole = true, .values = {0, 1, 2, 3, 2, 70000}},
        {.name = "position.X", .values = {-1e5F, 1e-3F, 1, 2, 3, 4}}};
    const auto path = write_file("a.exr", {colour, layers}, {}, {{"relevo:origin", "{}"}});
    EXPECT_EQ(read_float(path).values, colour.values);
    const std::vector<Channel> back = read_layers(path);
    ASSERT_EQ(back.size(), layers.size());
    for (const Channel& layer : layers) {
        const auto found =
            std::ranges::find_if(back, [&](const Channel& c) { return c.name == layer.name; });
        ASSERT_NE(found, back.end()) << layer.name;
        EXPECT_EQ(found->values, layer.values) << layer.name;
        EXPECT_EQ(found->is_whole, layer.is_whole) << layer.name;
    }
    EXPECT_EQ(read_metadata(path).at("relevo:origin"), "{}");
}

TEST_F(Encodings, WhatAFormatCannotHaveIsRefusedWithThoseThatCan) {
    const auto fault = [](const char* name, const Encoding& encoding, const Needs& needs) {
        return test::error_of([&] { check_encoding(name, encoding, needs); });
    };
    EXPECT_EQ(fault("a.jpg", {.bits = 16}, {}),
              "exit 3: image: a.jpg: jpeg has no 16-bit channels; use png, tif, tiff");
    EXPECT_EQ(fault("a.png", {.quality = 80}, {}),
              "exit 3: image: a.png: png has no quality to choose; use jpg, jpeg, webp, avif");
    EXPECT_EQ(fault("a.jpg", {}, {.alpha = true}),
              "exit 3: image: a.jpg: jpeg has no transparent pixels; use png, webp, avif, tif, "
              "tiff, exr");
    EXPECT_EQ(fault("a.png", {}, {.layers = true}),
              "exit 3: image: a.png: png has no layers of data; use exr");
    EXPECT_EQ(fault("-", {.format = "gif"}, {}),
              "exit 3: image: gif: unknown picture format; use png, jpg, webp, avif, tif or exr");
    EXPECT_EQ(test::error_of([] { check_bands("a.webp"); }),
              "exit 3: image: a.webp: webp cannot be written in bands, as pictures of more than 1 "
              "GiB are; use png, or a smaller --size");
}

TEST_F(Encodings, BandsMakeTheSamePicture) {
    const Image16 image = ramp(3);
    OutputFile file(dir_ / "bands.png", false, "image");
    BandWriter writer(file, {.width_px = image.width, .height_px = image.height},
                      {{"Description", "in bands"}}, {.bits = 16});
    for (int first = 0; first < image.height; first += 7) {
        Image16 band(image.width, std::min(7, image.height - first), 3);
        std::copy_n(image.row(first), band.values.size(), band.values.data());
        writer.write({band});
    }
    writer.end();
    file.finish();
    const ImageF back = read_float(dir_ / "bands.png");
    for (std::size_t i = 0; i < image.values.size(); ++i)
        ASSERT_EQ(std::lround(65535 * back.values[i]), image.values[i]);
    EXPECT_EQ(read_metadata(dir_ / "bands.png").at("Description"), "in bands");
}

}  // namespace
}  // namespace relevo::image
