// What a picture shows for which nothing is asked: where the DEM lies in it, and in which light.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "base/paths.h"
#include "base/units.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "sun/position.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_frame {
namespace {

#define SKIP_WITHOUT_BLOCK                                                  \
    if (!std::filesystem::exists(test::source_dir() / "plugins" / "block")) \
    GTEST_SKIP() << "the plugin block is not there"

scene::Scene scene_of(const std::filesystem::path& dem, std::vector<std::string> effects) {
    scene::Scene scene;
    scene.dems = {dem.string()};
    scene.effects.switches.only = std::move(effects);
    scene.width_px = 320;
    scene.height_px = 256;
    scene.view.orbit.aerial = false;
    return scene;
}

std::filesystem::path bundled(const char* name) {
    return test::source_dir() / "data/dem" / name;
}

/// What of a picture is the DEM.
struct Covered {
    double share = 0, width = 0, height = 0;
};

Covered covered(const Session& session) {
    std::vector<float> depths;
    session.read_depths(depths);
    const int width = session.scene().width_px, height = session.scene().height_px;
    int left = width, right = -1, low = height, high = -1, count = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (std::isinf(depths[static_cast<std::size_t>(y * width + x)])) continue;
            ++count;
            left = std::min(left, x);
            right = std::max(right, x);
            low = std::min(low, y);
            high = std::max(high, y);
        }
    return {static_cast<double>(count) / (width * height),
            static_cast<double>(right + 1 - left) / width,
            static_cast<double>(high + 1 - low) / height};
}

void expect_filled(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const Covered at = covered(session);
    EXPECT_NEAR(std::max(at.width, at.height), 0.95, 0.012) << scene.dems.front();
    std::printf("[ picture  ] %s: %.0f %% of it\n", scene.dems.front().c_str(), 100 * at.share);
}

TEST(Frame, FillsTheWidthOrTheHeightOfPicturesOfAnyShape) {
    SKIP_WITHOUT_BLOCK;
    for (const std::vector<std::string>& effects : {std::vector<std::string>{"block"}, {}})
        for (const auto& [width, height] : {std::pair(320, 256), {200, 400}, {500, 200}}) {
            scene::Scene scene = scene_of(bundled("jacksboro.tif"), effects);
            scene.width_px = width;
            scene.height_px = height;
            expect_filled(scene);
        }
}

TEST(Frame, FillsTheWidthOrTheHeightOfRealDems) {
    SKIP_WITHOUT_BLOCK;
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* name : {"hawaii_rotated20.tif", "SainteHelens.dem", "HI_topo_04.nc",
                             "dem_RGI50-05.08389.tif", "srtm_bigtujunga30m_utm11.tif", "roi.tif"})
        expect_filled(scene_of(data / "dem" / name, {"block"}));
    expect_filled(scene_of(data / "climate/orog_1deg.tif", {"block"}));
}

TEST(Frame, ASquareDemCoversAThirdOfThePicture) {
    SKIP_WITHOUT_BLOCK;
    FilesInUse files;
    Session session(scene_of(bundled("jacksboro.tif"), {"block"}), {.device = test::gl_device()},
                    files);
    session.draw();
    EXPECT_GE(covered(session).share, 1.0 / 3);
}

TEST(Frame, TheBlockIsThereFromOutsideAndNotFromWithin) {
    SKIP_WITHOUT_BLOCK;
    const auto depths_of = [](scene::Scene scene, bool block) {
        if (!block) scene.effects.switches.only->clear();
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        std::vector<float> depths;
        session.read_depths(depths);
        return depths;
    };
    scene::Scene scene = scene_of(bundled("jacksboro.tif"), {"block"});
    scene.view.orbit = {195, 30, 0.7};
    const auto with = depths_of(scene, true);
    // The camera without it stands nearer, as it has less to show: from an eye it stays.
    FilesInUse files;
    Session outside(scene, {.device = test::gl_device()}, files);
    const geo::Geodetic eye = outside.ground().frame.to_geodetic(outside.camera().eye_m);
    scene.view = {.eye = scene::Standpoint{eye}, .heading_deg = 15, .pitch_deg = -30};
    int more = 0, other = 0;
    const auto block = depths_of(scene, true), bare = depths_of(scene, false);
    for (std::size_t i = 0; i < block.size(); ++i) {
        more += std::isinf(bare[i]) && !std::isinf(block[i]);
        other += !std::isinf(bare[i]) && std::abs(block[i] / bare[i] - 1) > 1e-3;
    }
    EXPECT_GT(more, 0.01 * static_cast<double>(block.size()));
    EXPECT_LT(other, 0.005 * static_cast<double>(block.size()));
    // From within all is as without.
    scene.view = {.eye = scene::Standpoint{geo::geodetic_deg(36.3, -84.2, 1500)},
                  .heading_deg = 300};
    EXPECT_EQ(depths_of(scene, true), depths_of(scene, false));
}

TEST(Frame, TheBlockStandsInItsOwnShade) {
    SKIP_WITHOUT_BLOCK;
    FilesInUse files;
    Session session(scene_of(bundled("jacksboro.tif"), {"block"}), {.device = test::gl_device()},
                    files);
    session.draw();
    const image::Image8 shaded = session.picture();
    std::vector<float> depths;
    session.read_depths(depths);
    test::set(session, "block.shade", "0");
    session.draw();
    const image::Image8 bare = session.picture();
    const int width = shaded.width, height = shaded.height;
    const auto left = [&](int x, int y) {  // of the picture's green
        return static_cast<double>(shaded.row(y)[3 * x + 1]) / bare.row(y)[3 * x + 1];
    };
    // Dark at the block's foot and lighter with every step away from it, and none at the corners.
    const int middle = width / 2;
    int foot = height - 1;
    const auto depth = [&](int x, int y) {
        return depths[static_cast<std::size_t>((height - 1 - y) * width + x)];
    };
    while (std::isinf(depth(middle, foot)))
        --foot;
    ASSERT_LT(foot, height - 8);
    EXPECT_LT(left(middle, foot + 2), 0.85);
    for (int y = foot + 3; y < height; ++y)
        EXPECT_GE(left(middle, y), left(middle, y - 1) - 0.01) << y;
    for (const auto& [x, y] : {std::pair(2, 2),
                               {width - 3, 2},
                               {middle, 2},
                               {2, height - 1},
                               {middle, height - 1},
                               {width - 3, height - 1}})
        EXPECT_EQ(left(x, y), 1) << x << " " << y;
    // The block itself has none of it, but for its edge, whose pixels are partly backdrop.
    int changed = 0;
    for (int y = 1; y < height - 1; ++y)
        for (int x = 1; x < width - 1; ++x) {
            const bool within = !std::isinf(depth(x, y)) && !std::isinf(depth(x - 1, y)) &&
                                !std::isinf(depth(x + 1, y)) && !std::isinf(depth(x, y - 1)) &&
                                !std::isinf(depth(x, y + 1));
            changed += within && left(x, y) != 1;
        }
    EXPECT_EQ(changed, 0);
}

TEST(Frame, TheBackdropIsLighterAboveThanBelow) {
    SKIP_WITHOUT_BLOCK;
    scene::Scene scene = scene_of(bundled("jacksboro.tif"), {"block"});
    // Without the shade the backdrop depends on the height in the picture alone.
    scene.effects.settings = {
        {"block.shade", "0"}, {"block.above", "0.2,0.5,0.8"}, {"block.below", "0.6,0.4,0.1"}};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 picture = session.picture();
    const int bottom = picture.height - 1;
    for (const int x : {1, picture.width - 2}) {
        // Above bluer, below redder.
        EXPECT_GT(picture.at(x, 0, 2), picture.at(x, 0, 0) + 40);
        EXPECT_LT(picture.at(x, bottom, 2), picture.at(x, bottom, 0) - 40);
        for (int y = 1; y <= bottom; ++y)
            EXPECT_LE(picture.at(x, y, 2), picture.at(x, y - 1, 2) + 1) << y;
    }
    // With its own colours it is lighter above.
    test::set(session, "block.above", "0.60,0.62,0.64");
    test::set(session, "block.below", "0.43,0.43,0.42");
    session.draw();
    const image::Image8 own = session.picture();
    EXPECT_GT(own.at(1, 0, 1), own.at(1, bottom, 1) + 15);
}

/// Green of a block's walls seen from a side, by their height: of the lower third and the upper
/// one.
std::pair<double, double> wall_light(double azimuth_deg) {
    scene::Scene scene = scene_of(bundled("jacksboro.tif"), {"block"});
    scene.time.at = "2026-12-21T17:40Z";  // noon: in the south, 30 degrees high
    scene.view.orbit = {azimuth_deg, 12, 1};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 picture = session.picture();
    std::vector<float> depths;
    session.read_depths(depths);
    const SeenGround seen(session.camera(), picture.width, picture.height, depths);
    const render::Ground& ground = session.ground();
    const double foot_m = ground.base_m(1), top_m = ground.lowest_m;
    double sum[3] = {}, count[3] = {};
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto point = seen.point(x, y);
            if (!point) continue;
            const double share =
                (ground.frame.to_geodetic(*point).height_m - foot_m) / (top_m - foot_m);
            if (share < 0.05 || share > 0.95) continue;
            const int third = static_cast<int>(3 * share);
            sum[third] += picture.at(x, y, 1);
            ++count[third];
        }
    EXPECT_GT(std::min(count[0], count[2]), 200);
    return {sum[0] / count[0], sum[2] / count[2]};
}

TEST(Frame, WallsAreLitFromTheSunsSideAndDarkerAtTheirFoot) {
    SKIP_WITHOUT_BLOCK;
    const auto [south_foot, south_top] = wall_light(180);
    const auto [north_foot, north_top] = wall_light(0);
    EXPECT_GT(south_top, 1.1 * north_top);
    EXPECT_LT(south_foot, 0.97 * south_top);
    EXPECT_LT(north_foot, 0.97 * north_top);
}

TEST(Frame, WallsAreOfWaterBetweenASeaAndItsFloor) {
    SKIP_WITHOUT_BLOCK;
    test::Raster raster;
    raster.columns = raster.rows = 100;
    raster.geotransform = {{500000, 100, 0, 5200000, 0, -100}};
    raster.value = [](int column, int, int) { return 12.0 * column - 900 - 30 * (column % 7); };
    scene::Scene scene = scene_of(
        test::write_raster(test::scratch_dir("shelf") / "shelf.tif", raster), {"block", "sea"});
    scene.effects.settings = {{"block.side", "1,0,0"}, {"block.water", "0,0,1"}};
    scene.view.orbit = {180, 15, 1};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    const image::Image8 picture = session.picture();
    std::vector<float> depths;
    session.read_depths(depths);
    const SeenGround seen(session.camera(), picture.width, picture.height, depths);
    int counts[2] = {}, wrong = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto point = seen.point(x, y);
            if (!point) continue;
            const geo::Geodetic at = session.ground().frame.to_geodetic(*point);
            const glm::dvec2 post = session.dem()->field.grid.post(at);
            if (post.y < 98.7) continue;  // not in the wall to the south
            const double ground_m =
                session.dem()->field.height_at(std::clamp(post.x, 0.0, 99.0), 99);
            const double near_m = 1.5 / seen.px_per_m(seen.depth_m(x, y));
            if (at.height_m > std::max(ground_m, 0.0) - near_m) continue;
            if (std::abs(at.height_m - ground_m) < near_m) continue;
            const bool water = picture.at(x, y, 2) > picture.at(x, y, 0);
            ++counts[water];
            wrong += water != (at.height_m > ground_m);
        }
    EXPECT_GT(counts[0], 2000) << "ground, of " << wrong << " wrong";
    EXPECT_GT(counts[1], 500) << "water";
    EXPECT_LE(wrong, 20);
}

TEST(Frame, WallsMeetTheGroundSoThatNothingShowsBetween) {
    SKIP_WITHOUT_BLOCK;
    SKIP_WITHOUT_TEST_DATA(data);
    // Voids, a skewed border and a polygon: no background between ground and walls. Along each
    // column of the picture the DEM is one piece where nothing of it stands behind a void.
    for (const char* name : {"SainteHelens.dem", "hawaii_rotated20.tif"}) {
        scene::Scene scene = scene_of(data / "dem" / name, {"block"});
        scene.width_px = 640;
        scene.height_px = 512;
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        std::vector<float> depths;
        session.read_depths(depths);
        int gaps = 0;
        for (int x = 0; x < 640; ++x) {
            int pieces = 0;
            bool before = false;
            for (int y = 0; y < 512; ++y) {
                const bool here = !std::isinf(depths[static_cast<std::size_t>(y * 640 + x)]);
                pieces += here && !before;
                before = here;
            }
            gaps += std::max(0, pieces - 1);
        }
        EXPECT_LE(gaps, 3) << name;
    }
}

/// A plain on 300 posts a side that has voids where a function says so.
template <typename IsVoid>
scene::Scene plain_without(const char* name, const IsVoid& is_void) {
    test::Raster raster;
    raster.columns = raster.rows = 300;
    raster.nodata = -9999;
    raster.value = [&](int column, int row, int) {
        return is_void(column, row) ? -9999.0 : 500 + 0.01 * column + 0.02 * row;
    };
    return scene_of(test::write_raster(test::scratch_dir(name) / "dem.tif", raster), {"block"});
}

double share_of(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    session.draw();
    return covered(session).share;
}

TEST(Frame, NothingIsSeenThroughAVoidButTheBackdrop) {
    SKIP_WITHOUT_BLOCK;
    const auto share = [](scene::Scene scene, bool with_walls) {
        scene.holes = dem::Holes::Cut;
        scene.view.orbit.azimuth_deg = 160;
        scene.view.orbit.aerial = false;
        scene.view.orbit.elevation_deg = 12;
        if (!with_walls) scene.effects.switches.only = std::vector<std::string>();
        return share_of(scene);
    };
    const auto distance = [](int x, int y) { return std::hypot(x - 150, y - 150); };
    const scene::Scene whole = plain_without("whole.tif", [](int, int) { return false; });
    const scene::Scene ring =
        plain_without("ring.tif", [&](int x, int y) { return distance(x, y) < 100; });
    const scene::Scene disc =
        plain_without("disc.tif", [&](int x, int y) { return distance(x, y) > 145; });
    const double wholes = share(whole, true), rings = share(ring, true), discs = share(disc, true);
    std::printf("[ picture  ] whole %.3f and %.3f, ring %.3f and %.3f, disc %.3f and %.3f\n",
                wholes, share(whole, false), rings, share(ring, false), discs, share(disc, false));
    // Of the ground of the ring a third is missing, and no wall is in its place.
    EXPECT_NEAR(wholes - rings, share(whole, false) - share(ring, false), 0.01);
    EXPECT_GT(wholes - rings, 0.03);
    EXPECT_GT(discs, 1.15 * share(disc, false)) << "walls below a round outline";
}

TEST(Frame, IsolatedPostsAreFiguresButNotDrawn) {
    const auto is_void = [](int x, int y) { return y > 200 && (x != 150 || y != 250); };
    const scene::Scene scene = plain_without("post.tif", is_void);
    const auto source =
        std::make_shared<const dem::Source>(dem::Source::open(scene.dems, scene.dem));
    const auto dem = load_dem(source, scene);
    EXPECT_TRUE(std::isnan(dem->to_draw().height_m.at(150, 250)));
    EXPECT_NEAR(dem->field.height_m.at(150, 250), 506.5, 0.01);
    const dem::Heightfield read = dem::load(scene.dems, scene.dem);
    EXPECT_EQ(std::memcmp(read.height_m.data(), dem->field.height_m.data(),
                          read.height_m.size() * sizeof(float)),
              0);
}

TEST(Frame, FillAroundTheGroundIsNotDrawnUnlessItIsAskedFor) {
    test::Raster raster;
    raster.columns = raster.rows = 60;
    raster.nodata = -9999;  // so that 0 is not taken for it
    raster.value = [](int column, int row, int) {
        const bool is_fill = std::min({column, row, 59 - column, 59 - row}) < 5;
        return is_fill ? 0.0 : 400 + 100 * std::sin(0.2 * column);
    };
    scene::Scene scene;
    scene.dems = {test::write_raster(test::scratch_dir("frame_fill") / "turned.tif", raster)};
    const auto load = [&] {
        return load_dem(
            std::make_shared<const dem::Source>(dem::Source::open(scene.dems, scene.dem)), scene);
    };
    const auto without = load();
    EXPECT_EQ(without->field.height_m.at(0, 0), 0);  // figures have what the file has
    EXPECT_TRUE(std::isnan(without->to_draw().height_m.at(4, 30)));
    EXPECT_NEAR(without->to_draw().height_m.at(5, 30), 400 + 100 * std::sin(1), 1e-3);
    EXPECT_GT(ground_of(*without).lowest_m, 299);
    scene.dem.no_nodata = true;
    const auto with = load();
    EXPECT_EQ(with->to_draw().height_m.at(4, 30), 0);
    EXPECT_EQ(ground_of(*with).lowest_m, 0);
}

TEST(Frame, TheSunOfTheDefaultHourRakesTheGround) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* name : {"hawaii_rotated20.tif", "SainteHelens.dem", "dem_RGI50-05.08389.tif",
                             "srtm_bigtujunga30m_utm11.tif", "swellendam/srtm_41_19_4326.tif"}) {
        FilesInUse files;
        Session session(scene_of(data / "dem" / name, {}), {.device = test::gl_device()}, files);
        const sun::Position sun = sun::position(session.time(), session.ground().frame.origin());
        EXPECT_GE(degrees(sun.elevation_rad), 20) << name;
        EXPECT_LE(degrees(sun.elevation_rad), 35) << name;
        const double aside = std::remainder(
            degrees(sun.azimuth_rad) - session.scene().view.orbit.azimuth_deg.value(), 360);
        EXPECT_GE(std::abs(aside), 50) << name;
        EXPECT_LE(std::abs(aside), 100) << name;
        EXPECT_EQ(session.time_reason().find("time: 2026-"), 0u);
        EXPECT_EQ(session.view_reason().find("view: from azimuth "), 0u);
    }
}

TEST(Frame, WhatIsGivenIsLeft) {
    scene::Scene scene = scene_of(bundled("jacksboro.tif"), {});
    scene.time.at = "2026-03-01T12:00Z";
    scene.view.orbit = {77, 20, 1};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    EXPECT_EQ(session.time_reason(), "");
    EXPECT_EQ(session.view_reason(), "");
    EXPECT_EQ(sun::to_iso(session.time()), "2026-03-01T12:00:00Z");
    // The view of a DEM is the same at all times and in all sizes.
    scene.view.orbit = {};
    FilesInUse others;
    Session first(scene, {.device = test::gl_device()}, others);
    scene.time.at = "2026-12-01T20:00Z";
    scene.height_px = 700;
    Session second(scene, {.device = test::gl_device()}, others);
    EXPECT_EQ(first.scene().view.orbit.azimuth_deg, second.scene().view.orbit.azimuth_deg);
    EXPECT_EQ(first.scene().view.orbit.elevation_deg, second.scene().view.orbit.elevation_deg);
}

TEST(Frame, NoDefaultPictureIsClipped) {
    // With all that is on by default.
    std::vector<std::filesystem::path> dems{bundled("jacksboro.tif"),
                                            bundled("vancouver-island.tif")};
    if (const auto data = test::test_data_dir())
        for (const char* name :
             {"mt_rainier_90m.tif", "N42E001.hgt", "SainteHelens.dem", "colorado_tut_relief.nc",
              "holyroodpark.tif", "dem_RGI50-05.08389.tif", "missoula_valley.img",
              "monterey_bay_topobathy.tif", "hawaii_rotated20.tif", "rmnp/rmnp-dem.tif"})
            dems.push_back(*data / "dem" / name);
    for (const std::filesystem::path& dem : dems) {
        scene::Scene scene = scene_of(dem, {});
        scene.effects = {};
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        const image::Image8 picture = session.picture();
        int light = 0, dark = 0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                const auto [least, most] =
                    std::minmax({picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)});
                light += least >= 254;
                dark += most <= 2;
            }
        const double pixels = double{1} * picture.width * picture.height;
        EXPECT_LE(light / pixels, 0.01) << dem;
        EXPECT_LE(dark / pixels, 0.01) << dem;
    }
}

}  // namespace
}  // namespace relevo::session::test_frame
