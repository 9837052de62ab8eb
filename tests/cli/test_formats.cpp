// What capture and run write: formats, bits, layers, transparency, samples, tiles.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_formats {
namespace {

using testing::HasSubstr;

class Formats : public testing::Test {
  protected:
    std::filesystem::path take(const std::string& name, std::vector<std::string> more = {}) {
        const std::filesystem::path path = dir_ / name;
        more.insert(more.begin(), {"-q", "capture", bundled_dem(), "-o", path.string(), "--size",
                                   "161x127", "--overwrite"});
        const Result run = relevo(more);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return path;
    }

    std::filesystem::path dir_ = scratch_dir("cli_formats");
};

TEST_F(Formats, SixteenBitsAreFinerThanEightAndOtherwiseTheSame) {
    const image::Image8 coarse = image::read(take("a.png"));
    const image::ImageF fine = image::read_float(take("b.png", {"--bits", "16"}));
    std::set<long> low_bytes;
    double worst = 0;
    for (std::size_t i = 0; i < coarse.values.size(); ++i) {
        const double value = 255 * double{fine.values[i]};
        low_bytes.insert(std::lround(65535 * double{fine.values[i]}) % 257);
        worst = std::max(worst, std::abs(value - coarse.values[i]));
    }
    EXPECT_GT(low_bytes.size(), 250U);  // of 8 bits times 257 it would be one
    EXPECT_LT(worst, 2);                // the dither, and edges blended before rounding
}

TEST_F(Formats, SamplesSmoothAndLeaveTheRest) {
    const image::Image8 one = image::read(take("a.png")),
                        more = image::read(take("b.png", {"--samples", "16"}));
    EXPECT_GT(image::compare(one, more).psnr_db, 25);
    EXPECT_GT(image::compare(one, more).worst, 5);
    const image::Image8 others = image::read(take("c.png", {"--samples", "5"}));
    EXPECT_GT(image::compare(more, others).psnr_db, image::compare(one, others).psnr_db);
}

TEST_F(Formats, TransparentPicturesHaveAlphaWhereThereIsNoGround) {
    for (const char* name : {"a.png", "a.webp", "a.tif", "a.avif"}) {
        const image::Image8 picture = image::read(take(name, {"--transparent"}));
        ASSERT_EQ(picture.channels, 4) << name;
        EXPECT_EQ(picture.at(0, 0, 3), 0) << name;
        EXPECT_EQ(picture.at(80, 63, 3), 255) << name;
        int partly = 0;
        for (std::size_t i = 3; i < picture.values.size(); i += 4)
            partly += picture.values[i] > 20 && picture.values[i] < 235;
        EXPECT_GT(partly, 50) << name;
    }
    const image::ImageF light = image::read_float(take("a.exr", {"--transparent"}));
    ASSERT_EQ(light.channels, 4);
    EXPECT_EQ(light.at(0, 0, 0), 0);
    EXPECT_EQ(light.at(0, 0, 3), 0);
    EXPECT_EQ(light.at(80, 63, 3), 1);
    expect_failure({"capture", bundled_dem(), "-o", (dir_ / "no.jpg").string(), "--transparent"}, 3,
                   fmt::format("image: {}: jpeg has no transparent pixels; use png, webp, "
                               "avif, tif, tiff, exr",
                               (dir_ / "no.jpg").string()));
}

TEST_F(Formats, LayersAreConsistent) {
    constexpr int kNothing = 0;
    const auto path = take("a.exr", {"--layers", "all", "--view", "whole"});
    std::map<std::string, image::Channel> layers;
    for (image::Channel& layer : image::read_layers(path))
        layers[layer.name] = std::move(layer);
    ASSERT_EQ(layers.size(), 12U);
    EXPECT_THAT(image::read_metadata(path).at("relevo:origin"), HasSubstr("\"lat_deg\":36.30"));
    std::set<int> kinds;
    int lit = 0;
    for (std::size_t i = 0; i < 161 * 127; ++i) {
        const int kind = static_cast<int>(layers["ids.kind"].values[i]);
        kinds.insert(kind);
        EXPECT_EQ(std::isfinite(layers["depth.Z"].values[i]), kind != 0);
        EXPECT_EQ(std::isnan(layers["position.X"].values[i]), kind == 0);
        const auto n = [&](const char* axis) {
            return layers[std::string("normal.") + axis].values[i];
        };
        const double length = std::hypot(n("X"), n("Y"), n("Z"));
        EXPECT_NEAR(length, kind == 1 || kind == 2 ? 1 : 0, 0.01);
        const float green = layers["albedo.G"].values[i];
        const bool is_colour = green > 0 && green < 1;
        EXPECT_EQ(is_colour || kind == 2, kind == 1 || kind == 2) << green;
        lit += layers["shadow.Y"].values[i] > 0.5;
        // The DEM is 25 km wide and its highest post 1000 m high.
        if (kind == kNothing) continue;
        EXPECT_LT(std::abs(layers["position.Z"].values[i]), 3000);
    }
    EXPECT_TRUE(kinds.contains(0) && kinds.contains(1) && kinds.contains(3));
    EXPECT_GT(lit, 1000);
}

TEST_F(Formats, AlbedoDoesNotDependOnTheSun) {
    const auto layers_at = [&](const std::string& time) {
        std::map<std::string, std::vector<float>> layers;
        for (image::Channel& layer : image::read_layers(
                 take(time.substr(11, 2) + ".exr", {"--layers", "albedo,shadow", "--time", time,
                                                    "--view", "el=60", "--enable", "shadows"})))
            layers[layer.name] = std::move(layer.values);
        return layers;
    };
    auto noon = layers_at("2026-09-21T17:30Z"), evening = layers_at("2026-09-21T22:30Z");
    EXPECT_FALSE(noon["shadow.Y"] == evening["shadow.Y"]);
    for (const char* name : {"albedo.R", "albedo.G", "albedo.B"})
        EXPECT_TRUE(noon[name] == evening[name]) << name;
    EXPECT_FALSE(noon["albedo.R"] == noon["albedo.G"]);
}

TEST_F(Formats, GoToStandardOutputAlone) {
    const Result run =
        relevo({"capture", bundled_dem(), "-o", "-", "--format", "png", "--size", "161x127"});
    EXPECT_EQ(run.status, 0) << run.err;
    std::ofstream(dir_ / "piped.png", std::ios::binary) << run.out;
    EXPECT_EQ(image::compare(image::read(dir_ / "piped.png"), image::read(take("a.png"))).worst, 0);
    const Result missing = relevo({"capture", bundled_dem(), "-o", "-"});
    EXPECT_EQ(missing.status, 2);
    EXPECT_THAT(missing.err, HasSubstr("-o -: the format is missing; add --format png"));
}

TEST_F(Formats, BadWishesAreOneError) {
    const std::string png = (dir_ / "a.png").string();
    const auto fault = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"capture", bundled_dem(), "-o"});
        const Result run = relevo(more);
        EXPECT_NE(run.status, 0);
        EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
        return run.err;
    };
    EXPECT_THAT(fault({png, "--layers", "depth"}), HasSubstr("png has no layers of data; use exr"));
    EXPECT_THAT(fault({(dir_ / "a.exr").string(), "--layers", "dept"}),
                HasSubstr("--layers: dept: expected all or a list of depth, normal"));
    EXPECT_THAT(fault({png, "--size", "100000x100000"}), HasSubstr("each 1 to 65536"));
    EXPECT_THAT(fault({png, "--bits", "12"}), HasSubstr("--bits"));
    EXPECT_THAT(fault({png, "--quality", "50"}), HasSubstr("png has no quality to choose"));
    EXPECT_THAT(fault({png, "--format", "png"}), HasSubstr("--format: only of -o -"));
    EXPECT_THAT(fault({(dir_ / "a.tif").string(), "--size", "30000x20000"}),
                HasSubstr("tiff cannot be written in bands"));
    EXPECT_THAT(fault({png, "--size", "40000x20000", "--eye", "36.33,-84.25", "--panorama",
                       "equirectangular"}),
                HasSubstr("--panorama: takes more than 1 GiB; use a smaller --size"));
    EXPECT_THAT(fault({png, "--size", "40000x20000", "--stereo", "anaglyph"}),
                HasSubstr("--stereo: takes more than 1 GiB; use a smaller --size"));
    EXPECT_THAT(fault({"-", "--format", "png", "--sidecar"}), HasSubstr("need a file; name one"));
    EXPECT_THAT(fault({png, "--samples", "0"}), HasSubstr("--samples"));
    EXPECT_FALSE(std::filesystem::exists(png));
}

}  // namespace
}  // namespace relevo::test::test_formats
