#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/error.h"
#include "film/decoded_film.h"
#include "film/encoder.h"
#include "film/film.h"
#include "film/palette.h"
#include "support/support.h"

namespace relevo::film {
namespace {

namespace fs = std::filesystem;
using image::Image8;
using test::decode_film;
using test::DecodedFilm;

/// Patches of strong colours over a slope of greys, which move to the right by two pixels a frame.
Image8 frame(int number, int width = 320, int height = 180) {
    constexpr std::array<std::array<int, 3>, 6> kColours{{{200, 30, 30},
                                                          {30, 180, 40},
                                                          {40, 60, 210},
                                                          {220, 200, 40},
                                                          {40, 190, 200},
                                                          {235, 235, 235}}};
    Image8 image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int patch = (x - 2 * number + 1000 * width) / 40 % 6;
            const bool coloured = y < height / 2;
            for (int c = 0; c < 3; ++c)
                image.row(y)[x * 3 + c] = static_cast<std::uint8_t>(
                    coloured
                        ? kColours[static_cast<std::size_t>(patch)][static_cast<std::size_t>(c)]
                        : 255 * x / (width - 1));
        }
    return image;
}

class Films : public testing::Test {
  protected:
    fs::path make(const std::string& name, int frames, const Settings& settings = {},
                  int width = 320, int height = 180, const std::string& comment = {}) const {
        const fs::path path = dir_ / name;
        Film film(OutputFile(path, false, "test"), width, height, settings, comment);
        for (int i = 0; i < frames; ++i)
            film.add(frame(i, width, height));
        EXPECT_FALSE(fs::exists(path)) << "a name before the film is whole";
        film.finish();
        return path;
    }
    std::string error(const std::string& name, int width, int height,
                      const Settings& settings = {}) const {
        try {
            check(name, width, height, settings);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::BadInput);
            return error.what();
        }
        return "";
    }

    fs::path dir_ = test::scratch_dir("film");
};

/// Means over a patch, which the halved resolution of colours does not touch.
std::array<double, 3> mean_of(const Image8& image, int x0, int y0, int side) {
    std::array<double, 3> mean{};
    for (int y = y0; y < y0 + side; ++y)
        for (int x = x0; x < x0 + side; ++x)
            for (int c = 0; c < 3; ++c)
                mean[static_cast<std::size_t>(c)] += image.at(x, y, c) / double(side * side);
    return mean;
}

void expect_same_colours(const Image8& made, const Image8& given, double tolerance) {
    for (int patch = 0; patch < 8; ++patch)
        for (const int y : {30, 130}) {
            const auto got = mean_of(made, 40 * patch + 12, y, 16);
            const auto want = mean_of(given, 40 * patch + 12, y, 16);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(got[c], want[c], tolerance) << "patch " << patch << " channel " << c;
        }
}

TEST_F(Films, Mp4HasEveryFrameAtItsTimeInItsColours) {
    const DecodedFilm film = decode_film(make("a.mp4", 100, {}, 320, 180, "made by a test"));
    EXPECT_EQ(film.codec, "h264");
    EXPECT_EQ(film.pixels, "yuv420p");
    EXPECT_EQ(film.matrix, "bt709");
    EXPECT_EQ(film.range, "tv");
    EXPECT_TRUE(film.index_first);
    EXPECT_EQ(film.comment, "made by a test");
    ASSERT_EQ(film.times_s.size(), 100u);
    for (std::size_t i = 0; i < 100; ++i)
        EXPECT_NEAR(film.times_s[i], static_cast<double>(i) / 30, 1e-9);
    EXPECT_NEAR(film.duration_s, 100.0 / 30, 1e-9);
    for (const int i : {0, 50, 99}) {
        const Image8& made = film.frames[static_cast<std::size_t>(i)];
        expect_same_colours(made, frame(i), 2.5);
        // Edges of strong colours lose most to the halved resolution of colours.
        EXPECT_GT(image::compare(made, frame(i)).psnr_db, 28) << i;
    }
}

TEST_F(Films, WebmHasEveryFrameAtItsTimeInItsColoursAndOddSizes) {
    for (const int odd : {0, 1}) {
        const int width = 320 + odd, height = 180 + odd;
        const DecodedFilm film =
            decode_film(make(odd ? "odd.webm" : "a.webm", 60, {}, width, height, "by a test"));
        EXPECT_EQ(film.codec, "vp9");
        EXPECT_EQ(film.matrix, "bt709");
        EXPECT_EQ(film.range, "tv");
        EXPECT_EQ(film.comment, "by a test");
        EXPECT_EQ(film.width_px, width);
        EXPECT_EQ(film.height_px, height);
        ASSERT_EQ(film.times_s.size(), 60u);
        for (std::size_t i = 0; i < 60; ++i)
            EXPECT_NEAR(film.times_s[i], static_cast<double>(i) / 30, 0.00051);  // WebM has ms
        expect_same_colours(film.frames[30], frame(30, width, height), 3);
    }
}

TEST_F(Films, GifHasEveryFrame) {
    const DecodedFilm film = decode_film(make("a.gif", 45));
    EXPECT_EQ(film.codec, "gif");
    ASSERT_EQ(film.times_s.size(), 45u);
    for (std::size_t i = 0; i < 45; ++i)
        EXPECT_NEAR(film.times_s[i], static_cast<double>(i) / 30, 0.0051);  // GIF has 1/100 s
    expect_same_colours(film.frames[44], frame(44), 4);
    EXPECT_GT(image::compare(film.frames[44], frame(44)).psnr_db, 34);
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

unsigned little_endian(const std::string& bytes, std::size_t at, int count) {
    unsigned value = 0;
    for (int i = count - 1; i >= 0; --i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
}

/// Durations of the frames of an animated WebP [ms], by its chunks.
std::vector<unsigned> webp_durations_ms(const std::string& bytes) {
    std::vector<unsigned> result;
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
        const unsigned length = little_endian(bytes, at + 4, 4);
        if (bytes.compare(at, 4, "ANMF") == 0) result.push_back(little_endian(bytes, at + 20, 3));
        at += 8 + length + length % 2;
    }
    return result;
}

TEST_F(Films, WebpHasEveryFrameAndLoops) {
    for (const bool loop : {true, false}) {
        const std::string bytes = bytes_of(make(loop ? "a.webp" : "b.webp", 30, {.loop = loop}));
        const std::vector<unsigned> durations_ms = webp_durations_ms(bytes);
        ASSERT_EQ(durations_ms.size(), 30u);
        unsigned sum_ms = 0;
        for (const unsigned duration_ms : durations_ms)
            sum_ms += duration_ms;
        EXPECT_NEAR(sum_ms, 1000, 1);
        const std::size_t anim = bytes.find("ANIM");
        ASSERT_NE(anim, std::string::npos);
        EXPECT_EQ(little_endian(bytes, anim + 12, 2), loop ? 0u : 1u);
    }
}

TEST_F(Films, GifSaysWhetherItLoops) {
    EXPECT_NE(bytes_of(make("a.gif", 3)).find("NETSCAPE2.0"), std::string::npos);
    EXPECT_EQ(bytes_of(make("b.gif", 3, {.loop = false})).find("NETSCAPE2.0"), std::string::npos);
}

TEST_F(Films, RatesAreExact) {
    EXPECT_EQ(rate_of(30), (Rate{30, 1}));
    EXPECT_EQ(rate_of(12.5), (Rate{25, 2}));
    EXPECT_EQ(rate_of(23.976), (Rate{24000, 1001}));
    EXPECT_EQ(rate_of(29.97), (Rate{30000, 1001}));
    EXPECT_EQ(rate_of(59.94), (Rate{60000, 1001}));
    const DecodedFilm film = decode_film(make("ntsc.mp4", 40, {.fps = 29.97}));
    ASSERT_EQ(film.times_s.size(), 40u);
    EXPECT_NEAR(film.times_s[39], 39 * 1001.0 / 30000, 1e-9);
}

TEST_F(Films, SameBytesAgain) {
    for (const char* const ending : {".mp4", ".webm", ".webp", ".gif"})
        EXPECT_TRUE(bytes_of(make(std::string("a") + ending, 12)) ==
                    bytes_of(make(std::string("b") + ending, 12)))
            << ending;
}

/// Grey ripples of many sizes.
Image8 ripples(int number) {
    Image8 image(320, 180, 3);
    for (int y = 0; y < 180; ++y)
        for (int x = 0; x < 320; ++x) {
            const double value = 128 + 40 * std::sin(0.011 * x * y + number) +
                                 30 * std::sin(0.7 * x + 0.3 * y) + 20 * std::sin(1.9 * y);
            for (int c = 0; c < 3; ++c)
                image.row(y)[x * 3 + c] = static_cast<std::uint8_t>(value);
        }
    return image;
}

TEST_F(Films, QualityCounts) {
    const auto psnr_db = [&](const std::string& name, int quality) {
        {
            Film film(OutputFile(dir_ / name, false, "test"), 320, 180, {.quality = quality});
            for (int i = 0; i < 10; ++i)
                film.add(ripples(i));
            film.finish();
        }
        return image::compare(decode_film(dir_ / name).frames[9], ripples(9)).psnr_db;
    };
    for (const std::string ending : {".mp4", ".webm"}) {
        EXPECT_GT(psnr_db("good" + ending, 95), psnr_db("poor" + ending, 5) + 3);
        EXPECT_GT(fs::file_size(dir_ / ("good" + ending)),
                  1.5 * static_cast<double>(fs::file_size(dir_ / ("poor" + ending))));
    }
}

TEST_F(Films, RefusesBeforeAnyWork) {
    EXPECT_EQ(error("a.avi", 64, 48),
              "film: a.avi: unknown film format; use mp4 (H.264), webm (VP9), webp or gif");
    EXPECT_EQ(error("a.mp4", 641, 480),
              "film: a.mp4: H.264 needs an even width and height but the size is 641x480; use "
              "--size 642x480, or a webm");
    EXPECT_EQ(error("a.gif", 64, 48, {.fps = 60}),
              "film: a.gif: GIF has at most 50 frames a second but fps is 60");
    EXPECT_THAT(error("a.mp4", 64, 48, {.loop = true}),
                testing::HasSubstr("says nothing of loops"));
    EXPECT_THAT(error("a.gif", 64, 48, {.quality = 50}), testing::HasSubstr("has no quality"));
    EXPECT_THAT(error("a.mp4", 16000, 48), testing::HasSubstr("at most 8192 pixels"));
    EXPECT_EQ(error("a.webm", 641, 481), "");
}

TEST(Encoders, AreNamed) {
    EXPECT_THAT(installed_text(), testing::MatchesRegex("libavcodec .*, mp4 libx264, webm "
                                                        "libvpx-vp9, webp libwebp_anim, gif gif"));
}

/// While it lives, files grow to so many bytes, as on a disk that is full.
class SmallDisk {
  public:
    explicit SmallDisk(rlim_t bytes) {
        old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit small{bytes, old_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk() {
        setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, old_handler_);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

  private:
    rlimit old_{};
    void (*old_handler_)(int) = nullptr;
};

TEST_F(Films, FullDiskIsAnErrorAndLeavesNothing) {
    for (const std::string ending : {".mp4", ".webm", ".gif", ".webp"}) {
        const SmallDisk disk(20000);
        const fs::path path = dir_ / ("full" + ending);
        std::string message;
        try {
            Film film(OutputFile(path, false, "test"), 320, 180, {});
            for (int i = 0; i < 300; ++i)
                film.add(frame(7 * i));
            film.finish();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::Failed);
            message = error.what();
        }
        EXPECT_THAT(message, testing::HasSubstr("cannot be written, File too large")) << ending;
    }
    EXPECT_TRUE(fs::is_empty(dir_));
}

TEST_F(Films, FilmThatEndsBeforeItIsWholeLeavesNothing) {
    {
        Film film(OutputFile(dir_ / "a.mp4", false, "test"), 320, 180, {});
        for (int i = 0; i < 20; ++i)
            film.add(frame(i));
    }
    EXPECT_TRUE(fs::is_empty(dir_));
}

TEST_F(Films, FramesOfAnotherSizeAreRefused) {
    Film film(OutputFile(dir_ / "a.mp4", false, "test"), 320, 180, {});
    EXPECT_THROW(film.add(frame(0, 64, 48)), Error);
    EXPECT_THROW(film.finish(), Error) << "no frame";
}

TEST(Palettes, FewColoursAreExact) {
    const Image8 image = frame(0);
    Image8 patches(320, 60, 3);
    for (int y = 0; y < 60; ++y)
        std::copy(image.row(y), image.row(y) + 960, patches.row(y));
    const Palette palette = median_cut(patches);
    for (const std::uint32_t colour : {0xc81e1eU, 0x1eb428U, 0x283cd2U, 0xdcc828U})
        EXPECT_THAT(palette, testing::Contains(colour));
}

}  // namespace
}  // namespace relevo::film
