#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_overlay {
namespace {

/// Pictures of the bundled DEM from straight above, with a raster on it.
class OverlayOption : public testing::Test {
  protected:
    Result capture(const std::string& name, std::vector<std::string> more) {
        more.insert(more.begin(), {"-q", "capture", bundled_dem(), "-o", (dir_ / name).string(),
                                   "--size", "320x256", "--overwrite", "--view", "az=180,el=89.9"});
        return relevo(more);
    }
    image::Image8 taken(const std::string& name, const std::vector<std::string>& more) {
        const Result run = capture(name, more);
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(dir_ / name);
    }
    std::string raster(const std::string& name, std::vector<std::string> verb) {
        const std::string path = (dir_ / name).string();
        verb.insert(verb.begin(), "sun");
        verb.insert(verb.end(), {bundled_dem(), "-o", path, "--overwrite", "-q"});
        const Result run = relevo(verb);
        EXPECT_EQ(run.status, 0) << run.err;
        return path;
    }

    std::filesystem::path dir_ = scratch_dir("cli_overlay");
};

TEST_F(OverlayOption, ColoursAreThoseOfTheRampWhateverLightFallsOnThem) {
    const std::string shadow = raster("shadow.tif", {"shadow", "--sun", "110,20"});
    const std::string colours = (dir_ / "two.txt").string();
    std::ofstream(colours) << "0 20 60 200\n1 250 200 10\n";
    for (const char* time : {"2026-06-21T12:00", "2026-12-21T08:30", "2026-06-21T02:00"}) {
        const image::Image8 picture = taken(
            "colours.png",
            {"--overlay", shadow, "--overlay-colours", colours, "--no-legend", "--time", time});
        int blue = 0, yellow = 0, other = 0;
        for (int y = 100; y < 156; ++y)
            for (int x = 130; x < 190; ++x) {
                const auto is = [&](int r, int g, int b) {
                    return std::abs(picture.at(x, y, 0) - r) <= 1 &&
                           std::abs(picture.at(x, y, 1) - g) <= 1 &&
                           std::abs(picture.at(x, y, 2) - b) <= 1;
                };
                // Between posts colours are mixed.
                (is(20, 60, 200) ? blue : is(250, 200, 10) ? yellow : other)++;
            }
        EXPECT_GT(yellow, 300) << time;
        EXPECT_GT(blue, 15) << time;
    }
}

TEST_F(OverlayOption, LiesWhereItsPostsAre) {
    // The sun's own shadow in the picture and the raster of the same sun: what the raster calls
    // shade is darker in the picture.
    const std::vector<std::string> time{"--time", "2026-12-21T09:30"};
    const std::string shadow = raster("mask.tif", {"shadow", time[0], time[1]});
    const std::string colours = (dir_ / "mask.txt").string();
    std::ofstream(colours) << "0 0 0 0\n1 255 255 255\n";
    const image::Image8 mask = taken("mask.png", {"--overlay", shadow, "--overlay-colours", colours,
                                                  "--no-legend", time[0], time[1]});
    const image::Image8 picture = taken("lit.png", {"--disable", "haze", time[0], time[1]});
    double lit = 0, shaded = 0;
    int lit_count = 0, shaded_count = 0;
    for (int y = 90; y < 166; ++y)
        for (int x = 120; x < 200; ++x) {
            const double light = picture.at(x, y, 1);
            if (mask.at(x, y, 0) == 255) lit += light, ++lit_count;
            if (mask.at(x, y, 0) == 0) shaded += light, ++shaded_count;
        }
    ASSERT_GT(lit_count, 500);
    ASSERT_GT(shaded_count, 100);
    fmt::print("[ accuracy ] brightness where the raster has light {:.1f}, shade {:.1f}\n",
               lit / lit_count, shaded / shaded_count);
    EXPECT_GT(lit / lit_count, 1.5 * shaded / shaded_count);
}

TEST_F(OverlayOption, GivesThePictureItsTimeUnlessOneIsGiven) {
    const std::string mask = raster("mask.tif", {"shadow", "--time", "2026-12-21T09:30-05:00"});
    const auto picture = [&](const std::string& overlay, std::vector<std::string> more) {
        more.insert(more.begin(), {"--overlay", overlay, "--overlay-opacity", "0.5"});
        return taken("timed.png", more);
    };
    const auto chosen = [&](const std::string& overlay, std::vector<std::string> more) {
        more.insert(more.begin(), {"capture", bundled_dem(), "-o", (dir_ / "said.png").string(),
                                   "--size", "32x24", "--overwrite", "--overlay", overlay});
        return relevo(more).err;
    };
    const image::Image8 its = picture(mask, {});
    EXPECT_EQ(its.values, picture(mask, {"--time", "2026-12-21T14:30Z"}).values);
    EXPECT_NE(its.values, picture(mask, {"--time", "2026-12-21T19:30Z"}).values);
    EXPECT_NE(chosen(mask, {}).find("chosen: 21 December 2026 09:30 (the overlay's), seen from "),
              std::string::npos)
        << chosen(mask, {});
    EXPECT_EQ(chosen(mask, {"--time", "2026-12-21T19:30Z"}).find("overlay's"), std::string::npos);
}

TEST_F(OverlayOption, HasALegendUnlessNoneIsWanted) {
    const std::string hours =
        raster("hours.tif", {"hours", "--date", "2026-06-21", "--step", "30"});
    const image::Image8 with = taken("with.png", {"--overlay", hours}),
                        without = taken("without.png", {"--overlay", hours, "--no-legend"}),
                        titled = taken("titled.png", {"--overlay", hours, "--overlay-title", "x"});
    EXPECT_GT(image::compare(with, without).share_over_1, 0.01);
    EXPECT_GT(image::compare(with, titled).share_over_1, 0);
    EXPECT_EQ(std::vector<std::uint8_t>(with.row(200), with.row(201)),
              std::vector<std::uint8_t>(without.row(200), without.row(201)));
}

/// How many pixels two pictures differ in.
int differing(const image::Image8& a, const image::Image8& b) {
    EXPECT_EQ(a.values.size(), b.values.size());
    int count = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            count += std::abs(a.at(x, y, 0) - b.at(x, y, 0)) > 2 ||
                     std::abs(a.at(x, y, 1) - b.at(x, y, 1)) > 2 ||
                     std::abs(a.at(x, y, 2) - b.at(x, y, 2)) > 2;
    return count;
}

TEST_F(OverlayOption, OfTheSunHasNoShadowsOfAnotherSunUnlessAskedFor) {
    const std::string mask = raster("mask.tif", {"shadow", "--time", "2026-06-21T09:30"});
    const std::vector<std::string> scene{"--overlay", mask, "--time", "2026-12-21T16:30"};
    const auto taken_with = [&](const char* name, const std::vector<std::string>& more) {
        std::vector<std::string> all = scene;
        all.insert(all.end(), more.begin(), more.end());
        return taken(name, all);
    };
    const image::Image8 usual = taken_with("usual.png", {});
    EXPECT_EQ(differing(usual, taken_with("off.png", {"--disable", "shadows"})), 0);
    const image::Image8 on = taken_with("on.png", {"--enable", "shadows"});
    EXPECT_GT(differing(usual, on), 1000);
    EXPECT_EQ(differing(on, taken_with("asked.png", {"--overlay-shadows"})), 0);
    std::filesystem::remove(dir_ / "loud.png");
    const Result loud = relevo({"capture", bundled_dem(), "-o", (dir_ / "loud.png").string(),
                                "--size", "64x48", scene[0], scene[1], scene[2], scene[3]});
    EXPECT_NE(loud.err.find("relevo: shadows is off: the overlay shows sunlight of its own time; "
                            "--overlay-shadows switches it on"),
              std::string::npos)
        << loud.err;
    // Of what is no light of the sun they stay.
    const std::vector<std::string> heights{"--overlay", bundled_dem(), "--overlay-opacity",
                                           "0.5",       "--time",      "2026-12-21T16:30"};
    std::vector<std::string> without = heights;
    without.insert(without.end(), {"--disable", "shadows"});
    EXPECT_GT(differing(taken("other.png", heights), taken("other_off.png", without)), 500);
}

// Two opaque layers: the picture shows the upper one.
TEST_F(OverlayOption, LiesOverOrUnderAnEffectAsOrdered) {
    const std::string hours = raster("hours.tif", {"hours", "--date", "2026-06-21"});
    for (const char* light : {"flat", "lit"}) {
        SCOPED_TRACE(light);
        const std::vector<std::string> overlay{"--overlay", hours, "--overlay-light", light,
                                               "--no-legend"};
        const std::vector<std::string> drape{"--enable",   "drape",
                                             "--set",      "drape.file=" + hours,
                                             "--set",      "drape.colours=viridis",
                                             "--set",      std::string("drape.light=") + light,
                                             "--no-legend"};
        const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
            words.insert(words.end(), more.begin(), more.end());
            return words;
        };
        const std::vector<std::string> both = with(overlay, drape);
        const image::Image8 upper_overlay = taken("overlay.png", overlay);
        const image::Image8 upper_drape = taken("drape.png", with(drape, {"--disable", "shadows"}));
        const image::Image8 one = taken("one.png", with(both, {"--order", "drape,overlay"}));
        const image::Image8 other = taken("other.png", with(both, {"--order", "overlay,drape"}));
        EXPECT_GT(differing(one, other), 5000);
        EXPECT_LT(differing(one, upper_overlay), 50);
        EXPECT_LT(differing(other, upper_drape), 50);
        // Without an order a flat overlay lies under effects, a lit one over them.
        const bool is_lit = light == std::string("lit");
        EXPECT_EQ(differing(taken("usual.png", both), is_lit ? one : other), 0);
    }
    EXPECT_EQ(capture("refused.png", {"--order", "drape,overlay,drape"}).err,
              "relevo: error: effects: order: drape is named twice\n");
}

TEST_F(OverlayOption, ARampIsTheBuiltInOneWhateverFileHasItsName) {
    const std::string sky = raster("sky.tif", {"sky-view", "--directions", "8"});
    const auto in_folder = [&](const char* name, const char* colours) {
        const Result run = test::run(
            "/bin/sh", {"-c",
                        "cd \"$0\" && exec \"$1\" -q capture \"$2\" -o \"$3\" --overlay \"$4\" "
                        "--overlay-colours \"$5\" --size 64x48 --device software --overwrite "
                        "--save-scene scene.json",
                        dir_.string(), (build_dir() / "bin/relevo").string(), bundled_dem(), name,
                        sky, colours});
        EXPECT_EQ(run.status, 0) << run.err;
        return image::read(dir_ / name);
    };
    const image::Image8 before = in_folder("before.png", "viridis");
    std::ofstream(dir_ / "viridis") << "0 255 0 0\n1 255 0 0\n";
    EXPECT_EQ(differing(in_folder("after.png", "viridis"), before), 0);
    const image::Image8 file = in_folder("file.png", "./viridis");
    EXPECT_GT(differing(file, before), 100);
    // And so in the scene that is saved, and in the one that the picture carries.
    for (const auto& [option, path] :
         {std::pair("--scene", "scene.json"), std::pair("--from", "file.png")}) {
        const Result again = relevo({"-q", "capture", option, (dir_ / path).string(), "-o",
                                     (dir_ / "again.png").string(), "--overwrite"});
        ASSERT_EQ(again.status, 0) << again.err;
        EXPECT_EQ(differing(image::read(dir_ / "again.png"), file), 0) << option;
    }
}

TEST_F(OverlayOption, PresetsThatColourTheGroundHaveALegendToo) {
    for (const char* preset : {"relief", "slope", "aspect"}) {
        const image::Image8 with = taken("with.png", {"--preset", preset}),
                            without = taken("without.png", {"--preset", preset, "--no-legend"});
        EXPECT_GT(image::compare(with, without).share_over_1, 0.05) << preset;
    }
    const image::Image8 clay = taken("clay.png", {"--preset", "clay"});
    EXPECT_EQ(taken("plain.png", {"--preset", "clay", "--no-legend"}).values, clay.values);
}

TEST_F(OverlayOption, StampsAreInTheSceneThatAPictureCarries) {
    const image::Image8 first = taken(
        "first.png",
        {"--stamp", "title,scale,north,graticule,date,sun", "--attribution", "Data of an agency"});
    EXPECT_GT(image::compare(first, taken("bare.png", {})).share_over_1, 0.05);
    const Result again = relevo({"-q", "capture", "--from", (dir_ / "first.png").string(), "-o",
                                 (dir_ / "again.png").string()});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(image::read(dir_ / "again.png").values, first.values);
}

TEST(MapSheet, IsWhatAllStampsOfAViewFromAboveMake) {
    const std::filesystem::path dir = scratch_dir("cli_map_sheet");
    const auto taken = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{
            "-q",     "capture", bundled_dem(), "-o",      (dir / name).string(),
            "--view", "top",     "--size",      "400x400", "--overwrite"};
        words.insert(words.end(), more.begin(), more.end());
        const Result run = relevo(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return image::Image8(image::read(dir / name));
    };
    const image::Image8 sheet = taken("sheet.png", {"--stamp", "all"});
    EXPECT_EQ(sheet.values, taken("margin.png", {"--stamp", "all", "--margin"}).values);
    EXPECT_EQ(sheet.at(0, 0, 0), 255);
    EXPECT_NE(taken("some.png", {"--stamp", "title"}).at(0, 0, 0), 255);
}

TEST_F(OverlayOption, StampsThatAreNoneAreRefused) {
    EXPECT_EQ(
        capture("refused.png", {"--stamp", "title,scael"}).err,
        "relevo: error: --stamp: scael: expected all, none, or words of legend, title, scale, "
        "north, graticule, date, sun, exaggeration, attribution\n");
    EXPECT_EQ(capture("refused.png", {"--stamp", "attribution"}).err,
              "relevo: error: --stamp: attribution: its text is missing; add --attribution TEXT\n");
}

TEST_F(OverlayOption, OfASceneIsThatOfItsFile) {
    const std::string sky = raster("sky.tif", {"sky-view", "--directions", "8"});
    const std::string scene = (dir_ / "scene.json").string();
    const image::Image8 first =
        taken("first.png", {"--overlay", sky, "--overlay-opacity", "0.6", "--overlay-range",
                            "0.7,1", "--save-scene", scene});
    const Result again =
        relevo({"-q", "capture", "--scene", scene, "-o", (dir_ / "again.png").string()});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(image::read(dir_ / "again.png").values, first.values);
}

TEST_F(OverlayOption, WhatIsNoneIsRefused) {
    const auto said = [&](const std::vector<std::string>& more) {
        const Result run = capture("refused.png", more);
        EXPECT_NE(run.status, 0);
        EXPECT_FALSE(std::filesystem::exists(dir_ / "refused.png"));
        return run.err;
    };
    EXPECT_EQ(said({"--overlay-opacity", "0.5"}),
              "relevo: error: --overlay: missing; its colours, range, band, opacity, light and "
              "title need it\n");
    EXPECT_EQ(said({"--overlay", bundled_dem(), "--overlay-range", "5,5"}),
              "relevo: error: --overlay-range: 5,5: expected LOW,HIGH with LOW below HIGH, such as "
              "0,14\n");
    EXPECT_EQ(said({"--overlay", bundled_dem(), "--overlay-band", "2"}),
              "relevo: error: " + bundled_dem() + ": band 2: expected 1 to 1\n");
    const std::string elsewhere = (source_dir() / "data" / "dem" / "vancouver-island.tif").string();
    EXPECT_EQ(
        said({"--overlay", elsewhere}),
        "relevo: error: " + elsewhere +
            ": the raster does not cover this DEM; it is at latitude 48.005 to 49.995, longitude "
            "-126.000 to -122.000, the DEM at latitude 36.160 to 36.446, longitude -84.414 "
            "to -84.078\n");
    EXPECT_EQ(said({"--overlay", bundled_dem(), "--preset", "paper"}),
              "relevo: error: render: terrain.normal: vertex shows no overlay; remove the overlay "
              "or pass --set terrain.normal=fragment\n");
}

}  // namespace
}  // namespace relevo::test::test_overlay
