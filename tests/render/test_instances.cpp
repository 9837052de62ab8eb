// Instances of plugins: where they stand, that none is lost between levels, and how many are drawn.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "effect/effect.h"
#include "light/fields.h"
#include "render/instance_blocks.h"
#include "render/instance_sites.h"

namespace relevo::render::test_instances {
namespace {

using test::Drawn;

constexpr double kSpacing_m = 20;  // of posts
constexpr double kSite_m = 40;     // of instances

/// A slope that rises to the east, in four tiles.
dem::Heightfield slope() {
    return test::field_of(129, 129, {500000, kSpacing_m, 0, 5200000, 0, -kSpacing_m}, "EPSG:32632",
                          [](int column, int) { return 100 + 4.0 * column; });
}

/// Boxes of 12 x 12 m and 2 m height, red; the ground is grey.
effect::Effect boxes(const std::string& levels, const std::string& place) {
    const std::filesystem::path folder = test::scratch_dir("instances") / "boxes";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "box.obj")
        << "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\n"
           "f 8 7 6 5\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    std::ofstream(folder / "plugin.json") << fmt::format(
        R"({{"format": 1, "id": "boxes", "name": "B", "version": "1", "instances": {{"box":
            {{"spacing_m": {}, "height_m": 60, "levels": [{}]}}}}}})",
        kSite_m, levels);
    std::ofstream(folder / "boxes.glsl")
        << "void boxes_place_box(in InstanceSite at, inout Instance it) {\n"
           "    it.height_m = 2.0;\n"
           "    it.width_m = 12.0;\n"
           "    it.turn = 0.0;\n"
           "    it.colour = vec3(1.0, 0.0, 0.0);\n"
        << place
        << "}\n"
           "void boxes_on_lit(in Surface s, inout vec3 radiance) {\n"
           "    radiance = vec3(s.diffuse.rg, 1.0) / frame.exposure;\n"
           "}\n";
    return effect::load_effect(folder, test::source_dir() / "data");
}

const std::string kBox = R"({"meshes": ["box.obj"]})";

struct Found {
    int sites = 0, red_px = 0, hit = 0;
};

/// Projects each site and asks whether the pixel shows a box.
Found find(Drawn& drawn) {
    const image::ImageF image = drawn.radiance();
    const auto is_red = [&](int x, int y) {
        const glm::dvec2 value = Drawn::values(image, x, y);
        return value.x > 0.9 && value.y < 0.05;
    };
    Found found;
    for (int y = 0; y < drawn.height_px(); ++y)
        for (int x = 0; x < drawn.width_px(); ++x)
            found.red_px += is_red(x, y);
    const scene::Camera& camera = drawn.frame().camera;
    const double tan_y = std::tan(camera.fov_y_rad / 2), scale = drawn.height_px() / (2 * tan_y);
    for (int row = 0; row < 64; ++row) {
        for (int column = 0; column < 64; ++column) {
            const glm::dvec2 post = test::site_post(column, row, kSite_m / kSpacing_m);
            geo::Geodetic place = drawn.dem().grid.place(post.x, post.y);
            place.height_m = 100 + 4.0 * post.x + 2;
            const glm::dvec3 to = drawn.ground().frame.to_local(place) - camera.eye_m;
            const double depth = dot(to, camera.forward);
            if (depth <= 1) continue;
            const glm::dvec2 at(
                drawn.width_px() / 2.0 + scale * dot(to, cross(camera.forward, camera.up)) / depth,
                drawn.height_px() / 2.0 - scale * dot(to, camera.up) / depth);
            if (at.x < 8 || at.y < 8 || at.x > drawn.width_px() - 8 || at.y > drawn.height_px() - 8)
                continue;
            ++found.sites;
            found.hit += is_red(static_cast<int>(at.x), static_cast<int>(at.y));
        }
    }
    return found;
}

TEST(Instances, EachStandsWhereItsCellSaysWhateverTheEye) {
    Drawn drawn(slope(), {}, 512, 512, 0, {boxes(kBox, "")});
    for (const double column : {0.45, 0.55}) {
        drawn.stand(column, 0.5, 900, 30, -85);
        const Found found = find(drawn);
        fmt::print("[ instances ] {} of {} sites have a box, {} px\n", found.hit, found.sites,
                   found.red_px);
        EXPECT_GT(found.sites, 40);
        EXPECT_EQ(found.hit, found.sites);
    }
}

TEST(Instances, NoneIsLostOrDoubledWhereLevelsMeet) {
    Drawn one(slope(), {}, 512, 512, 0, {boxes(kBox, "")});
    one.stand(0.5, 0.5, 900, 30, -85);
    const Found before = find(one);
    // 60 m, the height of the highest, are 78 px high at about the distance of the ground.
    Drawn two(slope(), {}, 512, 512, 0,
              {boxes(kBox + R"(, {"meshes": ["box.obj"], "below_px": 78})", "")});
    two.stand(0.5, 0.5, 900, 30, -85);
    const Found after = find(two);
    EXPECT_EQ(after.hit, before.sites);
    EXPECT_EQ(after.red_px, before.red_px);
}

TEST(Instances, DensityIsTheShareOfSitesThatHaveOne) {
    Drawn drawn(slope(), {}, 512, 512, 0, {boxes(kBox, "    it.density = 0.3;\n")});
    drawn.stand(0.5, 0.5, 900, 30, -85);
    const Found found = find(drawn);
    const double share = double{1} * found.hit / found.sites;
    fmt::print("[ instances ] density 0.3: {} of {}\n", found.hit, found.sites);
    EXPECT_NEAR(share, 0.3, 3 * std::sqrt(0.3 * 0.7 / found.sites));
}

TEST(Instances, WithoutHeightThereIsNone) {
    Drawn drawn(slope(), {}, 256, 256, 0, {boxes(kBox, "    it.height_m = 0.0;\n")});
    drawn.stand(0.5, 0.5, 900, 30, -85);
    EXPECT_EQ(find(drawn).red_px, 0);
}

TEST(Instances, SitesThatAreTooCloseAreBoundedByTheRange) {
    // 50,000 x 50,000 sites on the field: 2.6e9.
    const shader::InstanceSet set{.name = "a", .resource = "b.a", .spacing_m = 0.05, .height_m = 9};
    Drawn drawn(slope(), {}, 256, 256, 0);
    drawn.stand(0.5, 0.5, 360, 30, -85);
    drawn.radiance();
    const LodView view = LodView::of_camera(drawn.frame().camera, 256, 256, 1, 1);
    const TileSelection tiles = drawn.terrain().select(view);
    const InstanceView sites(set, drawn.terrain(), view, 0.002);
    EXPECT_EQ(sites.range_m, kMostCells * 0.05);
    double count = 0;
    for (const InstanceBlock& block : instance_blocks(set, drawn.terrain(), tiles, sites))
        count += double{1} * block.count.x * block.count.y;
    fmt::print("[ instances ] {} of 2.6e9 sites are drawn\n", count);
    EXPECT_LT(count, 20 * kMostCells * kMostCells);
}

}  // namespace
}  // namespace relevo::render::test_instances
