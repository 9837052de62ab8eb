// Which colour a value of a raster on the ground has.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/source.h"
#include "session/overlay.h"
#include "session/seen_ground.h"
#include "session/session.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_overlay {
namespace {

std::string jacksboro() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// The bundled DEM's own heights as an overlay of it: some 220 to 1040 m.
Overlay heights_as(scene::Overlay asked) {
    asked.file = jacksboro();
    return read_overlay(asked, dem::Source::open(jacksboro()).grid());
}

void expect_from_to(const Overlay& overlay, double from, double to) {
    const chart::Ramp& ramp = overlay.legend->ramp;
    ASSERT_GE(ramp.stops.size(), 2u);
    EXPECT_NEAR(ramp.stops.front().value, from, 1e-6 * std::abs(to));
    EXPECT_NEAR(ramp.stops.back().value, to, 1e-6 * std::abs(to));
    for (std::size_t k = 1; k < ramp.stops.size(); ++k)
        EXPECT_GT(ramp.stops[k].value, ramp.stops[k - 1].value);
}

TEST(Overlay, ARangeIsWhereTheColoursBeginAndEnd) {
    const std::string file = (test::scratch_dir() / "colours.txt").string();
    std::ofstream(file) << "0% 10 20 30\n40% 0 0 0\n100% 200 100 50\n";
    for (const auto& [from, to] : {std::pair(0.0, 900.0), {400.0, 900.0}, {-300.0, -100.0}})
        for (const std::string& colours : {std::string(), std::string("inferno"), file}) {
            SCOPED_TRACE(fmt::format("{} to {}, {}", from, to, colours));
            const Overlay overlay = heights_as({.colours = colours, .range = std::pair(from, to)});
            expect_from_to(overlay, from, to);
        }
    // As the heights do where none is given.
    const Overlay own = heights_as({.colours = "inferno"});
    const Overlay usual = heights_as({});
    const double low = own.legend->ramp.stops.front().value,
                 high = own.legend->ramp.stops.back().value;
    EXPECT_GT(low, 200);
    EXPECT_LT(low, 300);
    EXPECT_GT(high, low + 500);
    expect_from_to(usual, low, high);
}

TEST(Overlay, ValuesHaveTheColoursOfTheRange) {
    // Viridis from 400 to 900 m: what is lower is as 400, the middle is its middle colour.
    const Overlay overlay = heights_as({.range = std::pair(400.0, 900.0)});
    const chart::Ramp& ramp = overlay.legend->ramp;
    EXPECT_EQ(ramp.at(250).rgb, 0x440154u);
    EXPECT_EQ(ramp.at(400).rgb, 0x440154u);
    EXPECT_EQ(ramp.at(650).rgb, 0x21918cu);
    EXPECT_EQ(ramp.at(900).rgb, 0xfde725u);
    EXPECT_EQ(ramp.at(1000).rgb, 0xfde725u);
}

TEST(Overlay, UsualRampsAreOfWhatTheBandSaysItIs) {
    Array2d<float> values(2, 1);
    values.at(0, 0) = 0.8f;
    values.at(1, 0) = 0.9f;
    const auto ends = [&](const char* name, const char* unit) {
        const chart::Ramp ramp = usual_ramp(values, name, unit);
        return std::pair(ramp.stops.front().value, ramp.stops.back().value);
    };
    EXPECT_EQ(ends("direct sun", "1"), std::pair(0.0, 1.0));
    EXPECT_EQ(ends("sky-view factor", "1"), std::pair(0.5, 1.0));
    EXPECT_EQ(ends("sun hours", "h"), std::pair(0.0, 1.0));
    values.at(0, 0) = 3;
    values.at(1, 0) = 14;
    EXPECT_EQ(ends("sun hours", "h"), std::pair(0.0, 14.0));
    EXPECT_EQ(ends("slope", "degrees"), std::pair(3.0, 14.0));
}

/// Where the picture shows a red mark of an overlay, from above, off the place of its middle
/// [posts].
double off_the_mark(const glm::ivec2& at, int size, double above_m) {
    scene::Scene scene;
    scene.dems = {jacksboro()};
    scene.time.at = "2026-06-21T16:00Z";
    scene.effects.switches.only = std::vector<std::string>{};
    scene.width_px = 320;
    scene.height_px = 256;
    const dem::Grid grid = dem::Source::open(jacksboro()).grid();
    const glm::dvec2 middle = glm::dvec2(at) + 0.5 * (size - 1);
    geo::Geodetic place = grid.place(middle.x, middle.y);
    place.height_m = above_m;
    scene.view = {.eye = scene::Standpoint{place}, .heading_deg = 0, .pitch_deg = -90};
    scene.view.fov_y_rad = radians(20);
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    const auto raster = std::make_shared<render::OverlayRaster>();
    raster->rgba = Array2d<std::uint32_t>(grid.columns(), grid.rows());
    for (std::uint32_t& texel : raster->rgba)
        texel = render::overlay_texel(0, 0, 0, 1);
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column)
            raster->rgba.at(at.x + column, at.y + row) = render::overlay_texel(1, 0, 0, 1);
    session.show(session.scene(), session.time(), {.overlay = LaidOverlay{raster}});
    session.draw();
    const image::Image8 picture = session.picture();
    std::vector<float> depths_m;
    session.read_depths(depths_m);
    const SeenGround seen(session.camera(), picture.width, picture.height, depths_m);
    glm::dvec2 sum(0);
    double weight = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const double red = picture.at(x, y, 0);
            if (red < 8 || !seen.point(x, y)) continue;
            sum += red * grid.post(session.ground().frame.to_geodetic(*seen.point(x, y)));
            weight += red;
        }
    EXPECT_GT(weight, 255 * 8);
    return length(sum / weight - middle);
}

TEST(Overlay, LiesAtItsOwnPosts) {
    // A mark of a post from near, and larger ones from where a pixel holds posts.
    EXPECT_LT(off_the_mark({200, 150}, 1, 3000), 0.15);
    EXPECT_LT(off_the_mark({301, 77}, 5, 6000), 0.15);
    EXPECT_LT(off_the_mark({120, 200}, 32, 40000), 0.6);
}

}  // namespace
}  // namespace relevo::session::test_overlay
