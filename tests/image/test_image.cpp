#include <cmath>
#include <cstdint>
#include <fstream>

#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/stat.h>

#include "base/text.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::image {
namespace {

Image8 gradient(int width, int height, int channels) {
    Image8 image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width * channels; ++x)
            image.row(y)[x] = static_cast<std::uint8_t>((7 * x + 13 * y) % 256);
    return image;
}

class ImageFiles : public testing::Test {
  protected:
    std::filesystem::path dir_ = test::scratch_dir("image");
};

TEST_F(ImageFiles, APngComesBackAsItWas) {
    for (const int channels : {1, 2, 3, 4}) {
        const Image8 image = gradient(37, 21, channels);
        const auto path = dir_ / ("gradient" + std::to_string(channels) + ".png");
        write(path, image, {{"Description", "a gradient, 45 \xc2\xb0"}});
        const Image8 back = read(path);
        EXPECT_EQ(back.values, image.values) << channels;
        EXPECT_EQ(read_metadata(path).at("Description"), "a gradient, 45 \xc2\xb0");
    }
}

TEST_F(ImageFiles, ALargePngComesBackToo) {
    // Beyond 64 MiB rows are deflated one by one.
    for (const int height : {4095, 4097}) {
        const Image8 image = gradient(4096, height, 4);
        const auto path = dir_ / fmt::format("large{}.png", height);
        write(path, image, {{"Description", "a gradient"}});
        EXPECT_TRUE(read(path).values == image.values) << height;
        EXPECT_EQ(read_metadata(path).at("Description"), "a gradient");
        std::filesystem::remove(path);
    }
}

TEST_F(ImageFiles, OtherFormatsComeThroughTheModule) {
    const Image8 image = gradient(64, 48, 3);
    write(dir_ / "a.tif", image);
    EXPECT_EQ(read(dir_ / "a.tif").values, image.values);
    Image8 flat(64, 48, 3);
    std::fill(flat.values.begin(), flat.values.end(), std::uint8_t{128});
    for (const char* name : {"a.jpg", "a.webp", "a.avif"}) {
        write(dir_ / name, flat);
        EXPECT_LE(compare(read(dir_ / name), flat).worst, 2) << name;
    }
    ImageF light(2, 1, 3);
    light.values = {0.0f, 0.5f, 1.0f, 1024.0f, 1e-3f, 4.0f};
    write(dir_ / "a.exr", light);
    const ImageF back = read_float(dir_ / "a.exr");
    for (std::size_t i = 0; i < light.values.size(); ++i)
        EXPECT_NEAR(back.values[i], light.values[i], light.values[i] * 1e-3);
}

TEST_F(ImageFiles, AnExistingFileIsReplacedOnlyWhenAsked) {
    const auto path = dir_ / "once.png";
    write(path, gradient(4, 4, 3));
    EXPECT_EQ(test::error_of([&] { write(path, gradient(5, 5, 3)); }),
              "exit 3: image: " + path.string() + ": exists; pass --overwrite to replace it");
    EXPECT_EQ(read(path).width, 4);
    write(path, gradient(5, 5, 3), {}, true);
    EXPECT_EQ(read(path).width, 5);
}

TEST_F(ImageFiles, NothingIsLeftBehindByAFailure) {
    // A float picture does not fit a PNG: the write fails, no file and no part of one stays.
    EXPECT_EQ(test::error_of([&] { write(dir_ / "light.png", ImageF(2, 2, 3)); }),
              "exit 1: image: " + (dir_ / "light.png").string() + ": png holds 8-bit sRGB");
    EXPECT_TRUE(std::filesystem::is_empty(dir_));
}

TEST_F(ImageFiles, OfAFullDiskAreErrorsInEveryFormat) {
    for (const char* name : {"a.png", "a.jpg", "a.webp", "a.avif", "a.tif"}) {
        std::filesystem::create_symlink("/dev/full", dir_ / name);
        EXPECT_EQ(test::error_of([&] { write(dir_ / name, gradient(64, 48, 3)); }),
                  "exit 1: image: " + (dir_ / name).string() +
                      ": cannot be written, No space left on device");
    }
    std::filesystem::create_symlink("/dev/full", dir_ / "a.exr");
    EXPECT_EQ(test::error_of([&] { write(dir_ / "a.exr", ImageF(64, 48, 3)); }),
              "exit 1: image: " + (dir_ / "a.exr").string() +
                  ": cannot be written, No space left on device");
}

TEST_F(ImageFiles, OutputsAreCheckedBeforeTheWork) {
    const Image8 image = gradient(4, 4, 3);
    EXPECT_EQ(test::error_of([&] { write(dir_ / "none" / "a.png", image); }),
              "exit 3: image: " + (dir_ / "none" / "a.png").string() + ": the folder " +
                  (dir_ / "none").string() + " does not exist; create it first");
    const std::string gif = "exit 3: image: " + (dir_ / "a.gif").string() +
                            ": unknown picture format; use png, jpg, webp, avif, tif or exr";
    EXPECT_EQ(test::error_of([&] { check_format(dir_ / "a.gif", 4, 4); }), gif);
    EXPECT_EQ(test::error_of([&] { load_format(dir_ / "a.gif"); }), gif);
    EXPECT_EQ(test::error_of([&] { write(dir_ / "a.gif", image); }), gif);
    for (const auto& [name, largest_px] :
         {std::pair{"a.jpg", 65500}, {"a.webp", 16383}, {"a.png", 100000}, {"a.tif", 100000}}) {
        EXPECT_EQ(test::error_of([&, n = name, px = largest_px] { check_format(n, px, 2); }),
                  "no error");
        if (largest_px == 100000) continue;
        EXPECT_EQ(test::error_of([&, n = name, px = largest_px] { check_format(n, 2, px + 1); }),
                  fmt::format("exit 3: image: {}: {} has sides of at most {} px, but this picture "
                              "is 2x{}; name another format",
                              name, name[2] == 'j' ? "jpeg" : "webp", largest_px, largest_px + 1));
    }
    // A library that cannot go on may end the process: it is never asked.
    EXPECT_EQ(test::error_of([&] { write(dir_ / "a.jpg", Image8(65501, 1, 3)); }).substr(0, 8),
              "exit 3: ");
    std::filesystem::create_directory(dir_ / "folder.png");
    EXPECT_EQ(test::error_of([&] { write(dir_ / "folder.png", image, {}, true); }),
              "exit 3: image: " + (dir_ / "folder.png").string() + ": is a folder");
}

TEST_F(ImageFiles, BrokenFilesAreErrorsNotCrashes) {
    EXPECT_EQ(test::error_of([&] { read(dir_ / "none.png"); }),
              "exit 3: image: " + (dir_ / "none.png").string() +
                  ": cannot be read, No such file or directory");
    std::ofstream(dir_ / "text.png") << "not a picture";
    EXPECT_EQ(test::error_of([&] { read(dir_ / "text.png"); }),
              "exit 3: image: " + (dir_ / "text.png").string() + ": Not a PNG file");
    write(dir_ / "whole.png", gradient(64, 64, 3));
    std::filesystem::resize_file(dir_ / "whole.png", 200);
    EXPECT_EQ(test::error_of([&] { read(dir_ / "whole.png"); }).substr(0, 8), "exit 3: ");
}

/// A PNG of grey pixels that claims a size and holds next to nothing.
std::string hollow_png(std::uint32_t width, std::uint32_t height, std::size_t filling) {
    const auto number = [](std::uint32_t value) {
        std::string bytes;
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes += static_cast<char>(value >> shift & 0xff);
        return bytes;
    };
    const auto chunk = [&](const std::string& name, const std::string& data) {
        const std::string body = name + data;
        std::uint32_t crc = 0xffffffff;  // ISO 3309, as the PNG specification's annex D has it
        for (const char c : body) {
            crc ^= static_cast<unsigned char>(c);
            for (int bit = 0; bit < 8; ++bit)
                crc = crc & 1 ? 0xedb88320 ^ crc >> 1 : crc >> 1;
        }
        return number(static_cast<std::uint32_t>(data.size())) + body + number(~crc);
    };
    const std::string header =
        number(width) + number(height) + std::string("\x08\x00\x00\x00\x00", 5);
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", std::string(filling, 'x')) +
           chunk("IEND", "");
}

TEST_F(ImageFiles, APngThatClaimsMoreThanItHoldsTakesNoMemory) {
    const std::string path = (dir_ / "hollow.png").string();
    const auto error_of = [&](std::uint32_t width, std::uint32_t height, std::size_t filling) {
        std::ofstream(path, std::ios::binary) << hollow_png(width, height, filling);
        return test::error_of([&] { read(path); });
    };
    EXPECT_EQ(error_of(1000000, 1000000, 10),
              "exit 3: image: " + path +
                  ": a file of 67 bytes cannot hold 1000000 x 1000000 pixels; it is damaged");
    EXPECT_EQ(error_of(30000, 30000, 1000),
              "exit 3: image: " + path +
                  ": a file of 1057 bytes cannot hold 30000 x 30000 pixels; it is damaged");
    EXPECT_EQ(
        error_of(40000, 10, 1000),
        "exit 3: image: " + path +
            ": expected 1 to 32768 pixels a side and at most 1024 MiB of them but got 40000 x "
            "10");
    EXPECT_EQ(error_of(32768, 32769, 1100000).substr(0, 8), "exit 3: ");
}

/// A chunk of a PNG with its checksum.
std::string png_chunk(const std::string& name, const std::string& content) {
    const auto word = [](std::uint32_t value) {
        std::string bytes;
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes += static_cast<char>(value >> shift & 0xff);
        return bytes;
    };
    const std::string body = name + content;
    const std::uint32_t sum = libdeflate_crc32(0, body.data(), body.size());
    return word(static_cast<std::uint32_t>(content.size())) + body + word(sum);
}

TEST_F(ImageFiles, TextsOfAPngTakeBoundedMemory) {
    // 7 MB of a text in 7 kB, 40 times.
    const std::string text(7'000'000, 'x');
    std::string packed(100'000, '\0');
    libdeflate_compressor* const compressor = libdeflate_alloc_compressor(6);
    packed.resize(libdeflate_zlib_compress(compressor, text.data(), text.size(), packed.data(),
                                           packed.size()));
    libdeflate_free_compressor(compressor);
    const auto path = dir_ / "texts.png";
    write(path, gradient(2, 2, 3));
    const std::string plain = read_text(path, "test");
    const auto with = [&](const std::string& chunks) {
        std::string bytes = plain;
        std::ofstream(path, std::ios::binary) << bytes.insert(33, chunks);  // behind the header
    };
    std::string chunks;
    for (int i = 0; i < 40; ++i) {
        chunks += png_chunk("zTXt", fmt::format("text{}", i) + std::string(2, '\0') + packed);
        if (i == 4) {
            with(chunks);
            EXPECT_EQ(read_metadata(path).at("text4"), text);
        }
    }
    with(chunks);
    EXPECT_EQ(
        test::error_of([&] { read_metadata(path); }),
        "exit 3: image: " + path.string() + ": needs more than 256 MiB in addition to its pixels");
}

TEST_F(ImageFiles, ThatAreNoRegularFilesAreNotWaitedFor) {
    for (const char* name : {"pipe.png", "pipe.jpg"}) {
        const std::string path = (dir_ / name).string();
        ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
        EXPECT_EQ(test::error_of([&] { read(path); }),
                  "exit 3: image: " + path + ": cannot be read, it is not a regular file");
    }
}

TEST_F(ImageFiles, HighlyCompressedOnesAreRead) {
    const Image8 flat(3000, 2000, 4);
    write(dir_ / "flat.png", flat);
    EXPECT_EQ(compare(read(dir_ / "flat.png"), flat).worst, 0);
}

TEST(Image, RowsOfADeviceAreTurnedAndLoseTheirAlpha) {
    const Image8 picture = from_device(1, 2, {1, 2, 3, 4, 5, 6, 7, 8});
    EXPECT_EQ(picture.channels, 3);
    EXPECT_EQ(picture.values, (std::vector<std::uint8_t>{5, 6, 7, 1, 2, 3}));
}

TEST(ImageCompare, MeasuresWhatDiffers) {
    const Image8 a = gradient(10, 10, 3);
    Image8 b = a;
    EXPECT_TRUE(std::isinf(compare(a, b).psnr_db));
    b.values[5] = static_cast<std::uint8_t>(b.values[5] + 1);
    b.values[50] = static_cast<std::uint8_t>(b.values[50] + 10);
    const Difference difference = compare(a, b);
    EXPECT_EQ(difference.worst, 10);
    EXPECT_DOUBLE_EQ(difference.share_over_1, 1.0 / 300);
    EXPECT_NEAR(difference.psnr_db, 10 * std::log10(255.0 * 255.0 * 300 / 101), 1e-9);
    EXPECT_EQ(test::error_of([&] { compare(a, gradient(9, 10, 3)); }),
              "exit 3: image: sizes differ, 10x10 with 3 channels and 9x10 with 3");
}

}  // namespace
}  // namespace relevo::image
