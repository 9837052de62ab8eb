// Small pictures for file managers.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test {
namespace {

namespace fs = std::filesystem;

/// A pyramid in the west of a plain, as an SRTM tile under a name without a place.
fs::path write_srtm(const fs::path& path) {
    constexpr int kSide = 1201;
    std::string bytes;
    for (int r = 0; r < kSide; ++r)
        for (int c = 0; c < kSide; ++c) {
            const int from_top = std::max(std::abs(r - 600), std::abs(c - 300));
            const int height = r < 10 ? -32768 : 100 + std::max(0, 250 - from_top) * 10;
            bytes += static_cast<char>(static_cast<unsigned>(height) >> 8 & 0xff);
            bytes += static_cast<char>(height & 0xff);
        }
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

double light_at(const image::Image8& image, int x, int y) {
    const std::uint8_t* p = image.row(y) + 4 * x;
    return (p[0] + p[1] + p[2]) / 3.0;
}

class Thumbnails : public testing::Test {
  protected:
    fs::path dir_ = scratch_dir();
    fs::path output_ = dir_ / "thumbnail.png";

    image::Image8 thumbnail(const std::string& dem, int size = 128) {
        std::ofstream(output_) << "";  // as file managers do
        const auto began = std::chrono::steady_clock::now();
        const Result made = relevo({"-q", "thumbnail", "-s", std::to_string(size), dem, output_});
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        EXPECT_EQ(made.status, 0) << made.err;
        EXPECT_EQ(made.err, "");
        std::printf("[ time     ] %s: %.2f s (limit 0.5)\n",
                    fs::path(dem).filename().string().c_str(), took_s);
        return image::read(output_);
    }
};

TEST_F(Thumbnails, AreShadedFromTheNorthWest) {
    const image::Image8 image = thumbnail(write_srtm(dir_ / "some tile.hgt").string());
    ASSERT_EQ(image.width, 128);
    ASSERT_EQ(image.height, 128);
    ASSERT_EQ(image.channels, 4);
    // The pyramid stands at a quarter of the width and half the height.
    const double west = light_at(image, 32 - 13, 64), east = light_at(image, 32 + 13, 64);
    const double north = light_at(image, 32, 64 - 13), south = light_at(image, 32, 64 + 13);
    EXPECT_GT(west, east + 40);
    EXPECT_GT(north, south + 40);
    EXPECT_EQ(image.row(0)[3], 0);  // a void
    EXPECT_EQ(image.row(127)[3], 255);
}

TEST_F(Thumbnails, TakeAddressesAndAnyNameOfTheOutput) {
    write_srtm(dir_ / "an alp.hgt");
    output_ = dir_ / "gnome.tmp";
    const std::string address = "file://" + (dir_ / "an%20alp.hgt").string();
    EXPECT_EQ(thumbnail(address, 64).width, 64);
}

TEST_F(Thumbnails, NeedNeitherCrsNorPlace) {
    std::ofstream file(dir_ / "grid.asc");
    file << "ncols 40\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 5\nNODATA_value -9999\n";
    for (int r = 0; r < 20; ++r) {
        for (int c = 0; c < 40; ++c)
            file << (c == 0 ? -9999 : 100 + c) << ' ';
        file << '\n';
    }
    file.close();
    const image::Image8 image = thumbnail((dir_ / "grid.asc").string());
    EXPECT_EQ(image.width, 128);
    EXPECT_EQ(image.height, 64);
    EXPECT_EQ(image.row(30)[3], 0);
    EXPECT_GT(image.row(30)[4 * 100 + 3], 0);
}

TEST_F(Thumbnails, OfRealFiles) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* name : {"N42E001.hgt", "n43.dt0", "n00_e006_3arc_v2.dt1", "SainteHelens.dem",
                             "avaGar.asc", "sample.bag"}) {
        const image::Image8 image = thumbnail((data / "dem" / name).string());
        EXPECT_EQ(std::max(image.width, image.height), 128) << name;
    }
}

TEST_F(Thumbnails, SayWhatIsWrong) {
    std::ofstream(dir_ / "empty.hgt") << "";
    std::ofstream(dir_ / "lies.asc") << "ncols 100000000\nnrows 100000000\n";
    for (const char* name : {"empty.hgt", "lies.asc", "missing.dem"}) {
        const Result made = relevo({"thumbnail", (dir_ / name).string(), output_});
        EXPECT_EQ(made.status, 3) << name;
        EXPECT_NE(made.err, "") << name;
        EXPECT_FALSE(fs::exists(output_)) << name;
    }
}

TEST_F(Thumbnails, AreMadeInASandboxWithAnEmptyHome) {
    const std::vector<std::string> sandbox = {"--ro-bind",
                                              "/",
                                              "/",
                                              "--proc",
                                              "/proc",
                                              "--dev",
                                              "/dev",
                                              "--tmpfs",
                                              "/home",
                                              "--tmpfs",
                                              "/root",
                                              "--setenv",
                                              "HOME",
                                              "/home",
                                              "--unshare-all",
                                              "--die-with-parent"};
    std::vector<std::string> tried = sandbox;
    tried.emplace_back("/bin/true");
    if (run("/usr/bin/bwrap", tried).status != 0) GTEST_SKIP() << "not run: needs bubblewrap";
    const std::string dem = write_srtm(dir_ / "tile.hgt").string();
    fs::create_directories(dir_ / "out");
    std::vector<std::string> arguments = sandbox;
    arguments.insert(arguments.end(),
                     {"--bind", (dir_ / "out").string(), (dir_ / "out").string(),
                      (build_dir() / "bin/relevo").string(), "-q", "thumbnail", "-s", "128",
                      "file://" + dem, (dir_ / "out/thumbnail.png").string()});
    const Result made = run("/usr/bin/bwrap", arguments);
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(made.err, "");
    EXPECT_EQ(image::read(dir_ / "out/thumbnail.png").width, 128);
}

}  // namespace
}  // namespace relevo::test
