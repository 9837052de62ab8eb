#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <sys/stat.h>

#include "image/ktx.h"
#include "support/support.h"

namespace relevo::image {
namespace {

/// Every byte of every level differs from its neighbours.
TextureData counted(PixelFormat format, int width, int height, int depth, int layers) {
    TextureData texture(format, width, height, depth, layers,
                        full_chain_levels(width, height, depth));
    for (int l = 0; l < texture.levels(); ++l) {
        unsigned value = 17u * static_cast<unsigned>(l);
        for (std::byte& b : texture.writable_level(l))
            b = static_cast<std::byte>(value++ * 37u);
    }
    return texture;
}

std::vector<char> bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const std::vector<char>& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

template <typename T>
T number_at(const std::vector<char>& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

TEST(Ktx, ReadsBackWhatWasWritten) {
    const auto dir = test::scratch_dir("ktx_round_trip");
    struct Case {
        PixelFormat format;
        int width, height, depth, layers;
    };
    for (const Case& c :
         {Case{PixelFormat::R8, 16, 16, 16, 1}, Case{PixelFormat::RG8, 5, 3, 1, 1},
          Case{PixelFormat::RGBA8, 8, 2, 1, 4}, Case{PixelFormat::Srgb8A8, 64, 64, 1, 1},
          Case{PixelFormat::R16, 7, 9, 3, 1}, Case{PixelFormat::RGBA16F, 5, 4, 3, 1},
          Case{PixelFormat::R8, 1, 1, 1, 1}}) {
        TextureData texture = counted(c.format, c.width, c.height, c.depth, c.layers);
        texture.metadata = {{"KTXorientation", "ru"}, {"relevo.tile_m", "4"}, {"empty", ""}};
        const auto path = dir / "texture.ktx2";
        write_ktx(path, texture);
        const TextureData read = read_ktx(path);
        EXPECT_EQ(read.format(), c.format);
        EXPECT_EQ(read.width(), c.width);
        EXPECT_EQ(read.height(), c.height);
        EXPECT_EQ(read.depth(), c.depth);
        EXPECT_EQ(read.layers(), c.layers);
        ASSERT_EQ(read.levels(), texture.levels());
        for (int l = 0; l < read.levels(); ++l)
            EXPECT_TRUE(std::ranges::equal(read.level(l), texture.level(l))) << "level " << l;
        texture.metadata["KTXwriter"] = "relevo";
        EXPECT_EQ(read.metadata, texture.metadata);
    }
}

// The numbers are those of the specification's sections 3 and 5, written out by hand, so that a
// mistake made in writer and reader alike shows.
TEST(Ktx, WritesWhatTheSpecificationSays) {
    const auto path = test::scratch_dir("ktx_layout") / "texture.ktx2";
    TextureData texture = counted(PixelFormat::Srgb8A8, 4, 2, 1, 1);
    texture.metadata = {{"KTXorientation", "ru"}};
    write_ktx(path, texture);
    const std::vector<char> bytes = bytes_of(path);
    EXPECT_EQ(std::string(bytes.data(), 12), "\xABKTX 20\xBB\r\n\x1A\n");
    // clang-format off
    const std::uint32_t expected_header[] = {
        43, 1,             // VK_FORMAT_R8G8B8A8_SRGB, type size
        4, 2, 0, 0, 1,     // width, height, depth, layers, faces
        3, 0,              // levels, supercompression
        152, 92, 244, 48,  // descriptor, key/value data: offset and size
    };
    const std::uint32_t expected_descriptor[] = {
        92, 0, 2 | 88 << 16,  // sizes, version
        0x00020101,           // RGBSDA, BT.709, sRGB, straight alpha
        0, 4, 0,              // 1 x 1 block of 4 bytes
        0x00070000, 0, 0, 255,
        0x01070008, 0, 0, 255,
        0x02070010, 0, 0, 255,
        0x1F070018, 0, 0, 255,  // alpha is linear
    };
    // clang-format on
    for (std::size_t i = 0; i < std::size(expected_header); ++i)
        EXPECT_EQ(number_at<std::uint32_t>(bytes, 12 + 4 * i), expected_header[i]) << i;
    for (std::size_t i = 0; i < std::size(expected_descriptor); ++i)
        EXPECT_EQ(number_at<std::uint32_t>(bytes, 152 + 4 * i), expected_descriptor[i]) << i;
    EXPECT_EQ(number_at<std::uint32_t>(bytes, 244), 18u);
    EXPECT_EQ(std::string(&bytes[248], 18), std::string("KTXorientation\0ru\0", 18));
    // Levels 4 x 2, 2 x 1 and 1 x 1, the smallest first in the file.
    EXPECT_EQ(number_at<std::uint64_t>(bytes, 80 + 2 * 24), 292u);
    EXPECT_EQ(number_at<std::uint64_t>(bytes, 80 + 1 * 24), 296u);
    EXPECT_EQ(number_at<std::uint64_t>(bytes, 80 + 0 * 24), 304u);
    EXPECT_EQ(bytes.size(), 336u);
}

struct BrokenFile {
    const char* name;
    std::size_t offset;  ///< of the bytes that are replaced
    std::vector<std::uint8_t> bytes;
    const char* message;
};

void PrintTo(const BrokenFile& file, std::ostream* out) {
    *out << file.name;
}

// A 4 x 4 RGBA8 texture with three levels: index at 80, descriptor at 152, pairs at 244, levels at
// 268 (1 x 1), 272 (2 x 2) and 288 (4 x 4); 352 bytes.
class BrokenKtx : public testing::TestWithParam<BrokenFile> {};

TEST_P(BrokenKtx, IsRejectedWithItsReason) {
    const auto path = test::scratch_dir(fmt::format("ktx_{}", GetParam().name)) / "texture.ktx2";
    write_ktx(path, counted(PixelFormat::RGBA8, 4, 4, 1, 1));
    std::vector<char> bytes = bytes_of(path);
    ASSERT_EQ(bytes.size(), 352u);
    ASSERT_EQ(number_at<std::uint32_t>(bytes, 12 + 4 * 11), 244u);
    for (std::size_t i = 0; i < GetParam().bytes.size(); ++i)
        bytes[GetParam().offset + i] = static_cast<char>(GetParam().bytes[i]);
    write_bytes(path, bytes);
    EXPECT_EQ(test::error_of([&] { read_ktx(path); }),
              fmt::format("exit 3: texture: {}: {}", path.string(), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Ktx, BrokenKtx,
    testing::Values(
        BrokenFile{"identifier", 0, {'P', 'N', 'G'}, "not a KTX 2 file"},
        BrokenFile{"version_1",
                   5,
                   {'1', '1'},
                   "is KTX version 1, expected version 2; convert it with ktx2ktx2"},
        BrokenFile{"format",
                   12,
                   {108},
                   "texel format 108, expected one of 9 (VK_FORMAT_R8_UNORM), 16 "
                   "(VK_FORMAT_R8G8_UNORM), 37 (VK_FORMAT_R8G8B8A8_UNORM), 43 "
                   "(VK_FORMAT_R8G8B8A8_SRGB), 70 (VK_FORMAT_R16_UNORM), 97 "
                   "(VK_FORMAT_R16G16B16A16_SFLOAT), 100 (VK_FORMAT_R32_SFLOAT), 109 "
                   "(VK_FORMAT_R32G32B32A32_SFLOAT)"},
        BrokenFile{
            "type_size", 16, {2}, "type size of VK_FORMAT_R8G8B8A8_UNORM, expected 1 but got 2"},
        BrokenFile{"width", 20, {0}, "size 0 x 4 x 0, expected 1 to 32768 a side"},
        BrokenFile{"height", 24, {1, 128}, "size 4 x 32769 x 0, expected 1 to 32768 a side"},
        BrokenFile{
            "depth", 28, {0, 0, 0, 128}, "size 4 x 4 x 2147483648, expected 1 to 32768 a side"},
        BrokenFile{"layers", 32, {1, 8}, "2049 layers, expected at most 2048"},
        BrokenFile{"array_of_volumes",
                   28,
                   {2, 0, 0, 0, 2},
                   "an array of volumes, expected one or the other"},
        BrokenFile{"cube", 36, {6}, "6 faces, expected 1"},
        BrokenFile{"no_levels", 40, {0}, "0 mip levels, expected 1 to 3"},
        BrokenFile{"many_levels", 40, {4}, "4 mip levels, expected 1 to 3"},
        BrokenFile{"supercompression", 44, {2}, "supercompression scheme 2, expected none (0)"},
        BrokenFile{"descriptor_outside",
                   50,
                   {1},
                   "data format descriptor at 65688 to 65780 is outside the file of 352 bytes"},
        BrokenFile{"descriptor_size",
                   52,
                   {88},
                   "its data format descriptor does not describe VK_FORMAT_R8G8B8A8_UNORM"},
        BrokenFile{"descriptor_model",
                   164,
                   {2},
                   "its data format descriptor does not describe VK_FORMAT_R8G8B8A8_UNORM"},
        BrokenFile{"descriptor_srgb",
                   166,
                   {2},
                   "its data format descriptor does not describe VK_FORMAT_R8G8B8A8_UNORM"},
        BrokenFile{"descriptor_bgra",
                   183,
                   {2},
                   "its data format descriptor does not describe VK_FORMAT_R8G8B8A8_UNORM"},
        BrokenFile{"pairs_outside",
                   61,
                   {255},
                   "key/value data at 244 to 65548 is outside the file of 352 bytes"},
        BrokenFile{"pair_too_long", 244, {21}, "key/value pair of 21 bytes, expected at most 20"},
        BrokenFile{"pair_without_key", 248, {0}, "key/value pair without a key that ends in NUL"},
        BrokenFile{"pair_without_nul",
                   257,
                   {'=', 'r', 'e', 'l', 'e', 'v', 'o', '!'},
                   "key/value pair without a key that ends in NUL"},
        BrokenFile{"pair_twice",
                   244,
                   {2, 0, 0, 0, 'k', 0, 0, 0, 2, 0, 0, 0, 'k', 0, 0, 0, 4, 0, 0, 0, 'x', 0, 0, 0},
                   "two values for the key k"},
        BrokenFile{"pairs_cut", 60, {26}, "key/value data ends inside a length"},
        BrokenFile{"level_size", 88, {60}, "level 0, expected 64 bytes but got 60"},
        BrokenFile{"level_uncompressed_size", 96, {65}, "level 0, expected 64 bytes but got 65"},
        BrokenFile{"level_outside",
                   81,
                   {1, 0, 0, 0, 0, 0, 1},
                   "level 0 at 72057594037928224 to 72057594037928288 is outside the file of 352 "
                   "bytes"},
        BrokenFile{
            "level_at_the_end", 80, {36}, "level 0 at 292 to 356 is outside the file of 352 bytes"},
        BrokenFile{"level_offset_overflow",
                   80,
                   {255, 255, 255, 255, 255, 255, 255, 255},
                   "level 0 at 18446744073709551615 to 63 is outside the file of 352 bytes"},
        BrokenFile{"level_unaligned", 128, {14}, "level 2 at 270, expected a multiple of 4"},
        BrokenFile{"level_over_header", 104, {148, 0}, "level 1 at 148 lies over the header"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(Ktx, AFileCutAnywhereIsRejected) {
    const auto dir = test::scratch_dir("ktx_cut");
    write_ktx(dir / "whole.ktx2", counted(PixelFormat::R8, 8, 8, 8, 1));
    const std::vector<char> whole = bytes_of(dir / "whole.ktx2");
    const auto path = dir / "cut.ktx2";
    for (std::size_t size = 0; size < whole.size(); ++size) {
        write_bytes(path, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_NE(test::error_of([&] { read_ktx(path); }), "no error") << size << " bytes";
    }
    write_bytes(path, {});
    EXPECT_EQ(test::error_of([&] { read_ktx(path); }),
              fmt::format("exit 3: texture: {}: file too short, expected at least 80 bytes "
                          "but got 0",
                          path.string()));
    write_bytes(path, {whole.begin(), whole.begin() + 100});
    EXPECT_EQ(test::error_of([&] { read_ktx(path); }),
              fmt::format("exit 3: texture: {}: file too short for the index of its 4 "
                          "levels, expected at least 176 bytes but got 100",
                          path.string()));
}

// Whatever a single wrong byte says, the answer is a texture inside the file or an Error: the
// address sanitizer of the asan preset watches.
TEST(Ktx, AnyOneWrongByteIsHandled) {
    const auto path = test::scratch_dir("ktx_fuzz") / "texture.ktx2";
    write_ktx(path, counted(PixelFormat::RG8, 4, 4, 1, 2));
    const std::vector<char> whole = bytes_of(path);
    int accepted = 0;
    for (std::size_t i = 0; i < 288; ++i)
        for (const int flip : {0x01, 0x80, 0xFF}) {
            std::vector<char> bytes = whole;
            bytes[i] = static_cast<char>(bytes[i] ^ flip);
            write_bytes(path, bytes);
            test::error_of([&] {
                const TextureData texture = read_ktx(path);
                unsigned sum = 0;
                for (int l = 0; l < texture.levels(); ++l)
                    for (const std::byte b : texture.level(l))
                        sum += std::to_integer<unsigned>(b);
                EXPECT_GT(sum, 0u);
                ++accepted;
            });
        }
    EXPECT_GT(accepted, 0);  // a wrong letter of the writer's name is no error
}

TEST(Ktx, WhatIsNoFileSaysSo) {
    const auto dir = test::scratch_dir("ktx_none");
    const auto missing = dir / "missing.ktx2";
    EXPECT_EQ(test::error_of([&] { read_ktx(missing); }),
              fmt::format("exit 3: texture: {}: cannot be read, No such file or directory",
                          missing.string()));
    EXPECT_EQ(
        test::error_of([&] { read_ktx(dir); }),
        fmt::format("exit 3: texture: {}: cannot be read, it is not a regular file", dir.string()));
    const auto pipe = dir / "pipe.ktx2";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(test::error_of([&] { read_ktx(pipe); }),
              fmt::format("exit 3: texture: {}: cannot be read, it is not a regular file",
                          pipe.string()));
    const auto nowhere = dir / "missing" / "texture.ktx2";
    EXPECT_EQ(test::error_of([&] { write_ktx(nowhere, counted(PixelFormat::R8, 2, 2, 1, 1)); }),
              fmt::format("exit 3: texture: {}: the folder {} does not exist; create it first",
                          nowhere.string(), nowhere.parent_path().string()));
}

TEST(Ktx, AFailedWriteLeavesTheOldFile) {
    const auto dir = test::scratch_dir("ktx_replace");
    const auto path = dir / "texture.ktx2";
    std::filesystem::create_directories(path / "in_the_way");
    EXPECT_EQ(test::error_of([&] { write_ktx(path, counted(PixelFormat::R8, 2, 2, 1, 1)); }),
              fmt::format("exit 3: texture: {}: is a folder", path.string()));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir), {}), 1);
}

TEST(Ktx, AnOpenTextureOutlivesItsFilesReplacement) {
    const auto path = test::scratch_dir("ktx_replaced") / "texture.ktx2";
    const TextureData first = counted(PixelFormat::R8, 64, 64, 1, 1);
    write_ktx(path, first);
    const TextureData open = read_ktx(path);
    write_ktx(path, counted(PixelFormat::R8, 2, 2, 1, 1));
    EXPECT_TRUE(std::ranges::equal(open.level(0), first.level(0)));
    EXPECT_EQ(read_ktx(path).width(), 2);
}

TEST(Ktx, OpeningTakesNoLongerForALargeTexture) {
    const auto path = test::scratch_dir("ktx_large") / "texture.ktx2";
    write_ktx(path, TextureData(PixelFormat::RGBA8, 2048, 2048, 1, 1, 12));
    std::vector<double> times_ms;
    for (int i = 0; i < 21; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const TextureData texture = read_ktx(path);
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - start;
        ASSERT_EQ(texture.level(0).size(), std::size_t{16} << 20);
        times_ms.push_back(taken.count());
    }
    test::print_accuracy("opening 21 MB", times_ms, "ms", 2);
    std::sort(times_ms.begin(), times_ms.end());
    EXPECT_LT(times_ms[times_ms.size() / 2], 2.0);  // copying 21 MB takes longer than that
}

}  // namespace
}  // namespace relevo::image
