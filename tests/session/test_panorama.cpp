// Whether a panorama shows each direction where it is: its skyline against the horizon that is
// computed from the posts, and its seams.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/posts.h"
#include "light/point/horizon.h"
#include "scene/panorama.h"
#include "session/effect_groups.h"
#include "session/panorama_maker.h"
#include "session/panorama_parts.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_panorama {
namespace {

constexpr double kEye_m = 700;  // above the DEM's zero

/// @param px_per_deg  columns of a degree
scene::Scene scene_of(scene::Panorama kind, double heading_deg, int px_per_deg, int height_px) {
    scene::Scene scene;
    scene.dems = {(test::source_dir() / "data/dem/jacksboro.tif").string()};
    scene.time.at = "2026-06-21T22:00:00Z";
    scene.view.eye = {.place = geo::geodetic_deg(36.33, -84.25, kEye_m)};
    scene.view.heading_deg = heading_deg;
    scene.view.panorama = kind;
    scene.width_px = 360 * px_per_deg;
    scene.height_px = height_px;
    return scene;
}

struct Drawn {
    image::Picture picture;
    scene::PanoramaMap map;
    std::shared_ptr<const LoadedDem> dem;
};

Drawn drawn(const scene::Scene& scene) {
    FilesInUse files;
    Session session(scene,
                    {.device = test::gl_device(), .format = PictureFormat{}, .allow_unmet = true},
                    files);
    image::Picture picture = session.make_picture();
    return {std::move(picture), panorama_map(scene, session.ground().frame, session.camera()),
            session.dem()};
}

/// Elevation of the upper edge of what is opaque in a column of a transparent picture: the ground
/// from there down, with the share of the edge's pixels that it covers.
double skyline_rad(const Drawn& drawn, int column) {
    const auto& image = std::get<image::Image8>(drawn.picture.pixels);
    double sky_px = 0;
    for (int y = 0; y < image.height && image.at(column, y, 3) < 255; ++y)
        sky_px += 1 - image.at(column, y, 3) / 255.0;
    return drawn.map.elevation_rad(sky_px);
}

struct Off {
    double worst_deg = 0, sum = 0;
    int directions = 0;

    void add(double off_deg) {
        worst_deg = std::max(worst_deg, std::abs(off_deg));
        sum += off_deg * off_deg;
        ++directions;
    }
    std::string text(const std::string& what) const {
        return fmt::format("{} {}: rms {:.4f}, worst {:.4f} degrees", directions, what, rms_deg(),
                           worst_deg);
    }
    double rms_deg() const { return std::sqrt(sum / std::max(directions, 1)); }
};

/// The skyline of a panorama, and the horizon of the posts in the same columns.
struct Skylines {
    std::vector<double> drawn_deg;
    std::vector<light::HorizonPoint> computed;

    Skylines(const Drawn& drawn, const geo::Geodetic& eye, double refraction) {
        const light::TerrainHorizon horizon(
            drawn.dem->field, eye,
            {.eye_height_m = eye.height_m, .eye_above_ground = false, .refraction = refraction});
        for (int column = 0; column < drawn.map.picture_px().x; ++column) {
            drawn_deg.push_back(degrees(skyline_rad(drawn, column)));
            computed.push_back(horizon.at(drawn.map.azimuth_rad(column + 0.5)));
        }
    }

    /// Where ground of the DEM is the horizon.
    Off everywhere() const {
        Off off;
        for (std::size_t i = 0; i < computed.size(); ++i)
            if (std::isfinite(computed[i].distance_m))
                off.add(drawn_deg[i] - degrees(computed[i].elevation_rad));
        return off;
    }

    /// Of summits: ground that nothing within `reach` columns is as high as.
    Off summits(std::size_t reach) const {
        Off off;
        for (std::size_t i = reach; i + reach < computed.size(); ++i) {
            const auto higher = [&](const light::HorizonPoint& point) {
                return point.elevation_rad > computed[i].elevation_rad;
            };
            const auto here = computed.begin() + static_cast<std::ptrdiff_t>(i);
            const auto side = static_cast<std::ptrdiff_t>(reach);
            if (!std::isfinite(here->distance_m) || std::any_of(here - side, here + side, higher))
                continue;
            off.add(drawn_deg[i] - degrees(here->elevation_rad));
        }
        return off;
    }
};

TEST(Panorama, SkylineIsTheHorizonOfThePosts) {
    for (const auto kind : {scene::Panorama::Cylindrical, scene::Panorama::Equirectangular}) {
        constexpr int kPxPerDeg = 20;
        scene::Scene scene = scene_of(kind, 70, kPxPerDeg, 400);
        scene.transparent = true;
        scene.pixel_error = 0;  // all posts
        const Drawn picture = drawn(scene);
        for (const double refraction : {0.0, 0.13}) {  // the picture has none
            const Skylines lines(picture, scene.view.eye->place, refraction);
            const Off off = lines.everywhere(), summits = lines.summits(2 * kPxPerDeg);
            fmt::print("{}, refraction {}: {}; {}\n",
                       kind == scene::Panorama::Cylindrical ? "cylindrical" : "equirectangular",
                       refraction, off.text("directions"), summits.text("summits"));
            EXPECT_GT(off.directions, 4000);
            EXPECT_LT(off.rms_deg(), 0.02);
            // Of slopes near the eye, which the picture draws as triangles.
            EXPECT_LT(off.worst_deg, 0.15);
            EXPECT_GE(summits.directions, 20);
            EXPECT_LT(summits.worst_deg, 0.03);
        }
    }
}

/// Columns and rows of the pixels in which two pictures differ.
struct Changed {
    glm::ivec2 low{1 << 30}, high{-1};

    Changed(const image::Image8& a, const image::Image8& b) {
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x)
                if (std::abs(a.at(x, y, 0) - b.at(x, y, 0)) > 40) {
                    low = min(low, glm::ivec2(x, y));
                    high = max(high, glm::ivec2(x, y));
                }
    }
};

// Of a large DEM the ground below the eye has the levels of a panorama, not of one direction.
TEST(Panorama, TheEyeStandsOnItsGround) {
    SKIP_WITHOUT_TEST_DATA(data);
    scene::Scene scene = scene_of(scene::Panorama::Equirectangular, 180, 2, 360);
    scene.dems = {(data / "dem/tyrol_aw3d30_n47e011_1s_cog.tif").string()};
    scene.view.eye = {.place = geo::geodetic_deg(47.3122, 11.3833, 4), .above_ground = true};
    scene.transparent = true;
    const Drawn panorama = drawn(scene);
    const auto& image = std::get<image::Image8>(panorama.picture.pixels);
    for (int column = 0; column < image.width; column += 20) {
        EXPECT_EQ(image.at(column, 0, 3), 0) << "ground overhead";
        EXPECT_EQ(image.at(column, image.height - 1, 3), 255) << "no ground below";
    }
}

TEST(Panorama, NamesStandOverTheirPlaces) {
    const std::filesystem::path file = test::scratch_dir() / "places.csv";
    std::ofstream(file) << "name,lat,lon,height\nCloud,36.40,-84.10,1500\n";
    for (const auto kind : {scene::Panorama::Cylindrical, scene::Panorama::Equirectangular}) {
        scene::Scene scene = scene_of(kind, 250, 8, 400);
        const Drawn without = drawn(scene);
        scene.effects.switches.enable = {"labels"};
        scene.effects.settings = {{"labels.file", file.string()}};
        const Drawn with = drawn(scene);
        const Changed changed(std::get<image::Image8>(without.picture.pixels),
                              std::get<image::Image8>(with.picture.pixels));
        // Azimuth and elevation on a sphere are near enough for a name.
        const geo::Geodetic& eye = scene.view.eye->place;
        const double north_m = radians(36.40) - eye.lat_rad,
                     east_m = (radians(-84.10) - eye.lon_rad) * std::cos(radians(36.365));
        const double azimuth = std::atan2(east_m, north_m);
        const double away_m = 6.37e6 * std::hypot(east_m, north_m);
        const double rise = (1500 - kEye_m) / away_m - away_m / (2 * 6.37e6);
        const auto at = with.map.project({std::sin(azimuth), std::cos(azimuth), rise});
        ASSERT_TRUE(at);
        EXPECT_NEAR(0.5 * (changed.low.x + changed.high.x), at->x, 4);
        EXPECT_NEAR(changed.high.y, at->y, 6);
        EXPECT_LT(changed.high.x - changed.low.x, 80);
    }
}

/// Mean of a channel of a block of pixels, in columns that go on around.
double mean(const image::Image8& image, int left, int top, int side, int channel) {
    double sum = 0;
    for (int y = top; y < top + side; ++y)
        for (int x = left; x < left + side; ++x)
            sum += image.at(x % image.width, y, channel);
    return sum / (side * side);
}

/// Prints and tests by how much blocks of two panoramas differ, of which the second is turned.
void expect_alike(const image::Image8& one, const image::Image8& other, int turned_px) {
    constexpr int kSide = 24;
    double sum = 0, worst = 0;
    int blocks = 0, over_4 = 0;
    for (int y = 0; y + kSide <= one.height; y += kSide)
        for (int x = 0; x < one.width; x += kSide)
            for (int c = 0; c < 3; ++c) {
                const double off =
                    std::abs(mean(one, x + turned_px, y, kSide, c) - mean(other, x, y, kSide, c));
                sum += off;
                worst = std::max(worst, off);
                over_4 += off > 4 ? 1 : 0;
                ++blocks;
            }
    fmt::print("blocks of {} px differ by {:.3f}/255, {:.3f} % by more than 4, worst {:.1f}\n",
               kSide, sum / blocks, 100.0 * over_4 / blocks, worst);
    EXPECT_LT(sum / blocks, 0.5);
    EXPECT_LT(over_4, 0.005 * blocks);
}

class PanoramaParts : public testing::TestWithParam<EffectGroup> {};

/// Pixels are those of a panorama whose parts begin half a part farther on. Of the defaults alone
/// it reaches up and down to where a band has fewer parts than at the horizon.
TEST_P(PanoramaParts, DoNotShow) {
    constexpr int kPxPerDeg = 4;
    const int rows = GetParam().empty() ? 480 : 240;
    std::vector<scene::Scene> scenes;
    for (const auto kind : {scene::Panorama::Cylindrical, scene::Panorama::Equirectangular})
        for (const double turned_deg : {0.0, kPart_deg / 2}) {
            scene::Scene& scene =
                scenes.emplace_back(scene_of(kind, 70 + turned_deg, kPxPerDeg,
                                             kind == scene::Panorama::Cylindrical ? 240 : rows));
            scene.stamps.legend = false;
            scene.effects.switches.enable = GetParam();
        }
    const std::vector<image::Image8> pictures = pictures_of(scenes);
    for (std::size_t i = 0; i < pictures.size(); i += 2)
        expect_alike(pictures[i], pictures[i + 1], kPxPerDeg * static_cast<int>(kPart_deg) / 2);
}

INSTANTIATE_TEST_SUITE_P(Effects, PanoramaParts, testing::ValuesIn(kEffectGroups), name_of);

}  // namespace
}  // namespace relevo::session::test_panorama
