// Orthographic pictures from above, and rasters on the ground.
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "light/fields.h"

namespace relevo::render::test_maps {
namespace {

using test::Drawn;
using test::TestEffect;

const TestEffect kNormal{"probe",
                         "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 r) {\n"
                         "    r = vec3(s.ground_normal.xy + 1.0, 1.0) / frame.exposure;\n"
                         "}\n"};

/// Ground whose slopes on the next coarser level are others.
dem::Heightfield rough(int side) {
    return test::field_of(side, side, {500000, 30, 0, 5200000, 0, -30}, "EPSG:32632",
                          [](int column, int row) {
                              return 500 + 8 * std::sin(2.1 * column) + 8 * std::cos(2.3 * row);
                          });
}

// A part has pages of its own posts, which fit where those of the whole map do not.
TEST(Maps, APartIsShadedAsFinelyAsTheMap) {
    constexpr int kSide = 2048;  // 85 pages on all levels
    Drawn drawn(rough(kSide), {kNormal}, 256, 192, 4, {}, {}, {}, {.orthographic = true});
    drawn.map({kSide, kSide});
    Terrain small(drawn.dem(), drawn.ground().frame, {.max_array_layers = 40});
    for (const glm::dvec2 corner : {glm::dvec2(0), {700, 900}, {kSide - 256, kSide - 192}}) {
        drawn.frame().part = PicturePart{{kSide, kSide}, corner};
        const image::ImageF all = drawn.radiance();
        drawn.renderer().render_frame(small, drawn.ground(), drawn.frame());
        const image::ImageF part = drawn.renderer().read_radiance();
        double most = 0, relief = 0;
        for (int y = 0; y < all.height; ++y)
            for (int x = 0; x < all.width; ++x) {
                const glm::dvec2 here = Drawn::values(all, x, y);
                most = std::max(most, distance(here, Drawn::values(part, x, y)));
                relief = std::max(relief, distance(here, glm::dvec2(1)));
            }
        EXPECT_GT(relief, 0.25);
        EXPECT_LT(most, 0.002);
    }
}

TEST(Maps, PagesOfAPartAreFewOfThoseOfAllPosts) {
    const dem::Heightfield field = rough(4096);
    const Ground ground = make_ground(field);
    const dem::Pyramid pyramid(field.height_m);
    TileTree tree(pyramid, field.grid, ground.frame);
    const scene::Camera camera =
        scene::map_camera(field.grid, ground.frame, scene::map_area(field.grid, 0, {4096, 4096}));
    LodView view = LodView::of_camera(camera, 4096, 4096, 1, 1);
    const auto pages = [&] {
        std::set<std::uint64_t> keys;
        tree.visit(
            view, tree.root(), 2, [](int, double) { return true; },
            [&](const TileKey& key) { keys.insert(key.packed()); });
        return keys.size();
    };
    const std::size_t all = pages();
    view.posts = glm::dvec4(1000, 1000, 2024, 2024);  // 1024 posts a side
    const std::size_t part = pages();
    fmt::print("[ pages ] of 4096 x 4096 posts {}, of 1024 x 1024 of them {}\n", all, part);
    EXPECT_EQ(all, 256u + 64 + 16 + 4 + 1);
    EXPECT_EQ(part, 25u + 9 + 4 + 1 + 1);
}

// Their pixels are half as many metres wide at 60 degrees as on the equator.
TEST(Maps, AShoreIsAsSharpAtAllLatitudes) {
    constexpr int kColumns = 257, kRows = 300;
    const dem::Heightfield field = test::field_of(kColumns, kRows, {-40, 0.25, 0, 75, 0, -0.25},
                                                  "EPSG:4326", [](int, int) { return 10; });
    dem::Water water;
    water.kind = Array2d<dem::WaterKind>(kColumns, kRows, dem::WaterKind::None);
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x)
            if (x + y / 4 < 160) water.kind.at(x, y) = dem::WaterKind::Lake;
    const TestEffect probe{"probe",
                           "//@ include lib/water.glsl\n"
                           "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 r) {\n"
                           "    r = vec3(water_of(s).x, 0.0, 1.0) / frame.exposure;\n"
                           "}\n"};
    Drawn drawn(field, {probe}, 514, 600, 4, {}, {}, {}, {.orthographic = true});
    drawn.map({514, 600});
    Terrain terrain(drawn.dem(), drawn.ground().frame, {.water = &water});
    drawn.renderer().render_frame(terrain, drawn.ground(), drawn.frame());
    const image::ImageF image = drawn.renderer().read_radiance();
    // Pixels of a row that are partly water, in the north and in the south.
    const auto mixed = [&](int first) {
        double count = 0;
        for (int y = first; y < first + 80; ++y)
            for (int x = 0; x < image.width; ++x) {
                const double share = Drawn::values(image, x, y).x;
                count += share > 0.02 && share < 0.98 ? 1 / 80.0 : 0;
            }
        return count;
    };
    fmt::print("[ shore ] {:.2f} px wide in the north, {:.2f} px on the equator\n", mixed(40),
               mixed(500));
    EXPECT_GT(mixed(500), 0.9);
    EXPECT_NEAR(mixed(40), mixed(500), 0.15);
}

/// The colour of the middle of a picture with a flat red overlay.
glm::ivec3 colour_under(std::vector<TestEffect> effects) {
    Drawn drawn(rough(65), std::move(effects), 32, 32, 4, {}, {}, {},
                {.orthographic = true, .overlay_raster = true});
    drawn.map({32, 32});
    const auto raster = std::make_shared<OverlayRaster>();
    raster->rgba = Array2d<std::uint32_t>(65, 65, overlay_texel(1, 0, 0, 1));
    drawn.terrain().set_overlay(raster);
    drawn.renderer().render_frame(drawn.terrain(), drawn.ground(), drawn.frame());
    const image::Image8 picture = drawn.renderer().read_output();
    return {picture.at(16, 16, 0), picture.at(16, 16, 1), picture.at(16, 16, 2)};
}

// An effect that changes what others drew, as a cover of voids does, is not for the overlay.
TEST(Maps, EffectsThatCoverWhatIsDrawnLeaveTheOverlay) {
    const TestEffect cover{"cover",
                           "void cover_on_display(in Surface s, inout vec4 overlay) {\n"
                           "    overlay.rgb = overlay.a * vec3(0.0, 0.0, 1.0);\n"
                           "}\n"};
    const TestEffect half{"half",
                          "void half_on_display(in Surface s, inout vec4 overlay) {\n"
                          "    overlay = vec4(0.0, 0.4, 0.0, 0.4) + 0.6 * overlay;\n"
                          "}\n"};
    EXPECT_EQ(colour_under({}), glm::ivec3(255, 0, 0));
    EXPECT_EQ(colour_under({cover}), glm::ivec3(255, 0, 0));
    EXPECT_EQ(colour_under({half}), glm::ivec3(153, 102, 0));
    EXPECT_EQ(colour_under({half, cover}), glm::ivec3(153, 0, 102));
}

}  // namespace
}  // namespace relevo::render::test_maps
