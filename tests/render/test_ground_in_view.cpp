#include <random>

#include <fmt/format.h>

#include "dem/load.h"
#include "drawn.h"
#include "render/ground_in_view.h"

namespace relevo::render::test_ground_in_view {
namespace {

/// Paints ground in a colour that no sky has.
const test::TestEffect kPaint{"paint",
                              "void paint_on_atmosphere(in Surface s, in vec3 view, inout vec3 "
                              "radiance) { radiance = vec3(0.0, 1.0, 0.0); }\n"
                              "vec3 paint_on_background_radiance(in vec3 direction, in bool "
                              "with_disc) { return vec3(1.0, 0.0, 0.0); }\n"};

struct Counts {
    int with_ground = 0, missed = 0, sky = 0, mistaken = 0, mistaken_by_boxes = 0;

    friend Counts operator+(Counts a, const Counts& b) {
        a.with_ground += b.with_ground;
        a.missed += b.missed;
        a.sky += b.sky;
        a.mistaken += b.mistaken;
        a.mistaken_by_boxes += b.mistaken_by_boxes;
        return a;
    }
};

/// Compares sees_ground() with pictures of 60 random views from a height above the ground.
Counts count(double agl_m, double pixel_error, double displaced_m = 0) {
    test::TestEffect paint = kPaint;
    if (displaced_m > 0) {
        paint.glsl += fmt::format(
            "void paint_on_displace(in VertexFrame v, inout vec3 position_m) "
            "{{ position_m += {:.1f} * v.up; }}\n",
            displaced_m);
        paint.displaces = effect::DisplaceSpec{};
        paint.displaces->up.metres = displaced_m;
    }
    test::Drawn drawn(dem::load((test::source_dir() / "data/dem/jacksboro.tif").string()), {paint},
                      320, 240, pixel_error);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.2, 0.8), heading(0, 360), pitch(10, 80);
    Counts counts;
    for (int i = 0; i < 60; ++i) {
        const Array2d<float>& heights = drawn.dem().height_m;
        const int column = static_cast<int>(share(random) * heights.width());
        const int row = static_cast<int>(share(random) * heights.height());
        const double x = column / (heights.width() - 1.0), y = row / (heights.height() - 1.0);
        const double ground_m = heights.at(column, row);
        drawn.stand(x, y, ground_m + displaced_m + agl_m, heading(random), pitch(random));
        const image::ImageF radiance = drawn.radiance();
        bool is_seen = false;
        for (int v = 0; v < radiance.height; ++v)
            for (int u = 0; u < radiance.width; ++u)
                is_seen = is_seen || radiance.at(u, v, 1) > 0;
        const LodView view =
            LodView::of_camera(drawn.frame().camera, drawn.width_px(), drawn.height_px(),
                               pixel_error, drawn.frame().exaggeration);
        const TileSelection tiles = drawn.terrain().select(view);
        const bool found = drawn.terrain().sees_ground(tiles, view);
        counts.with_ground += is_seen;
        counts.missed += is_seen && !found;
        counts.sky += !is_seen;
        counts.mistaken += !is_seen && found;
        counts.mistaken_by_boxes += !is_seen && tiles.triangles() > 0;
    }
    return counts;
}

TEST(GroundInView, IsFoundWhereverItIsDrawnAndSeldomElsewhere) {
    Counts all;
    for (const double agl_m : {2.0, 30.0, 300.0})
        for (const double pixel_error : {0.0, 4.0})
            all = all + count(agl_m, pixel_error);
    all = all + count(2, 0, 40);
    fmt::print(
        "of {} views of ground {} were missed; of {} of the sky {} were taken for ground, by "
        "boxes {}\n",
        all.with_ground, all.missed, all.sky, all.mistaken, all.mistaken_by_boxes);
    EXPECT_GT(all.with_ground, 50);
    EXPECT_GT(all.mistaken_by_boxes, 100);
    EXPECT_EQ(all.missed, 0);
    EXPECT_LE(all.mistaken, all.sky / 10);
}

}  // namespace
}  // namespace relevo::render::test_ground_in_view
