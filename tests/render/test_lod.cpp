#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "dem/load.h"
#include "drawn.h"
#include "gl/context.h"
#include "light/fields.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/view.h"
#include "shader/snippet.h"
#include "sun/zone.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_lod {
namespace {

/// Frames of one DEM in plain grey, the sky in a colour that no ground has.
class Flight {
  public:
    /// @param heights  the ground's height as green radiance instead of its light
    Flight(const std::string& path, int width_px, int height_px, bool heights = false)
        : dem_(dem::load(path)),
          ground_(make_ground(dem_)),
          width_px_(width_px),
          height_px_(height_px),
          bright_(shader::parse_snippet(
              "bright", "bright.glsl",
              "vec3 bright_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
              "    return vec3(40.0, 0.0, 40.0);\n"
              "}\n")),
          heights_(shader::parse_snippet(
              "heights", "heights.glsl",
              "void heights_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
              "    radiance = vec3(0.0, s.height_m, 0.0);\n"
              "}\n")) {
        values_.declare(core_params());
        EffectInputs effects;
        effects.stitch.snippets = {&bright_};
        if (heights) effects.stitch.snippets.push_back(&heights_);
        effects.stitch.values = &values_;
        renderer_.emplace(
            context_, effects,
            RendererOptions{.width_px = width_px, .height_px = height_px, .antialias = false});
        const sun::Position position =
            sun::position(sun::parse_time("2026-06-21T15:00Z").utc, dem_.grid.center());
        inputs_.sun = make_sun_light(position, sun::Refraction::standard(dem_.grid.center()),
                                     ground_, dem_.grid);
    }

    void set_pixel_error(double pixel_error, int vertex_budget = 100000000) {
        terrain_.emplace(
            dem_, ground_.frame,
            TerrainOptions{.pixel_error = pixel_error, .vertex_budget = vertex_budget});
    }

    /// From a share of the way along the rows and columns, above the highest ground there or
    /// thereabouts.
    void stand(double column_share, double row_share, double above_ground_m, double heading_deg,
               double pitch_deg) {
        const double column = column_share * (dem_.grid.columns() - 1);
        const double row = row_share * (dem_.grid.rows() - 1);
        geo::Geodetic place = dem_.grid.place(column, row);
        const double here = dem_.height_at(column, row);
        place.height_m = (std::isnan(here) ? 0 : here) + above_ground_m;
        inputs_.camera = scene::heading_camera(ground_.frame.to_local(place),
                                               ground_.frame.axes(place.lat_rad, place.lon_rad),
                                               heading_deg, pitch_deg, radians(40));
    }

    void orbit(const scene::Orbit& orbit) {
        inputs_.camera = scene::orbit_camera(orbit, points_to_show(dem_, ground_, 1), radians(40),
                                             static_cast<double>(width_px_) / height_px_);
    }

    image::ImageF draw() {
        renderer_->render_frame(*terrain_, ground_, inputs_);
        return renderer_->read_radiance();
    }
    image::Image8 picture() {
        renderer_->render_frame(*terrain_, ground_, inputs_);
        return renderer_->read_output();
    }
    /// Row of the highest ground in each column of the last frame; the picture's height for none.
    std::vector<int> silhouette() const {
        const image::ImageF frame = renderer_->read_radiance();
        std::vector<int> rows(static_cast<std::size_t>(frame.width));
        for (int x = 0; x < frame.width; ++x) {
            int y = 0;
            while (y < frame.height && is_sky(frame, x, y))
                ++y;
            rows[static_cast<std::size_t>(x)] = y;
        }
        return rows;
    }
    int triangles() const { return renderer_->triangles(); }

    static bool is_sky(const image::ImageF& frame, int x, int y) { return frame.at(x, y, 0) > 20; }

  private:
    dem::Heightfield dem_;
    Ground ground_;
    int width_px_, height_px_;
    shader::Snippet bright_, heights_;
    shader::ParamStore values_;
    gl::Context context_{{.device = test::gl_device(), .debug = true}};
    std::optional<Renderer> renderer_;
    std::optional<Terrain> terrain_;
    FrameInputs inputs_;
};

std::string bundled() {
    return (test::source_dir() / "data/dem/jacksboro.tif").string();
}

/// Pixels of sky below the first ground of their column: with a level camera each column lies in a
/// vertical plane, where no ray that rises less can miss once one has hit.
int cracks(const image::ImageF& frame) {
    int count = 0;
    for (int x = 0; x < frame.width; ++x) {
        int y = 0;
        while (y < frame.height && Flight::is_sky(frame, x, y))
            ++y;
        for (; y < frame.height; ++y)
            count += Flight::is_sky(frame, x, y);
    }
    return count;
}

TEST(Lod, AFlightOverABrightGroundShowsNoCrack) {
    Flight flight(bundled(), 640, 512);
    int count = 0, frames = 0;
    for (const double pixel_error : {1.0, 4.0, 16.0}) {
        flight.set_pixel_error(pixel_error);
        for (int i = 0; i < 16; ++i) {
            flight.stand(0.3 + 0.025 * i, 0.35 + 0.02 * i, 60 + 25 * i, 37 * i, 0);
            count += cracks(flight.draw());
            ++frames;
        }
    }
    fmt::print("[ lod ] {} pixels of background below the ground's rim in {} frames\n", count,
               frames);
    EXPECT_EQ(count, 0);
}

struct Difference {
    double psnr_db = 0;
    double mean = 0;  ///< of 255
};

Difference difference(const image::Image8& a, const image::Image8& b) {
    Difference result;
    double squares = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double d = static_cast<double>(a.values[i]) - b.values[i];
        squares += d * d;
        result.mean += std::abs(d) / static_cast<double>(a.values.size());
    }
    const double mean = squares / static_cast<double>(a.values.size());
    result.psnr_db = mean > 0 ? 10 * std::log10(255.0 * 255.0 / mean) : 99;
    return result;
}

void expect_as_from_every_post(const std::string& path) {
    Flight flight(path, 1280, 1024);
    for (const scene::Orbit& orbit :
         {scene::Orbit{225, 20, 1.3}, scene::Orbit{100, 8, 2.5}, scene::Orbit{330, 45, 1}}) {
        flight.orbit(orbit);
        flight.set_pixel_error(0);
        const image::Image8 all = flight.picture();
        const int all_triangles = flight.triangles();
        const std::vector<int> all_silhouette = flight.silhouette();
        flight.set_pixel_error(1);
        const Difference d = difference(all, flight.picture());
        const std::vector<int> silhouette = flight.silhouette();
        int moved_px = 0;
        for (std::size_t x = 0; x < silhouette.size(); ++x)
            moved_px = std::max(moved_px, std::abs(silhouette[x] - all_silhouette[x]));
        fmt::print(
            "[ lod ] {} from azimuth {}: {} of {} triangles, PSNR {:.1f} dB, silhouettes within "
            "{} px\n",
            std::filesystem::path(path).filename().string(), *orbit.azimuth_deg, flight.triangles(),
            all_triangles, d.psnr_db, moved_px);
        EXPECT_GE(d.psnr_db, 39);
        EXPECT_LE(moved_px, 2);
    }
}

TEST(Lod, APictureAtOnePixelIsThatOfEveryPostOnTheBundledDem) {
    expect_as_from_every_post(bundled());
}

TEST(Lod, APictureAtOnePixelIsThatOfEveryPostOnTwoMore) {
    SKIP_WITHOUT_TEST_DATA(data);
    expect_as_from_every_post((data / "dem/srtm_bigtujunga30m_utm11.tif").string());
    expect_as_from_every_post((data / "dem/swellendam/srtm_41_19_4326.tif").string());
}

TEST(Lod, NothingPopsOnASlowPath) {
    // What is drawn too high or too low at a pixel, against every post drawn, changes by little
    // from frame to frame, also where tiles change their level between the two.
    Flight flight(bundled(), 320, 256, true);
    constexpr int kFrames = 120;
    std::vector<image::ImageF> off;
    std::vector<int> triangles;
    for (const double pixel_error : {0.0, 6.0}) {
        flight.set_pixel_error(pixel_error);
        for (int i = 0; i < kFrames; ++i) {
            flight.stand(0.15 + 0.0012 * i, 0.5 + 0.0006 * i, 700, 60, -10);
            const image::ImageF frame = flight.draw();
            if (pixel_error == 0) {
                off.push_back(frame);
                continue;
            }
            triangles.push_back(flight.triangles());
            image::ImageF& all = off[static_cast<std::size_t>(i)];
            for (std::size_t k = 0; k < all.values.size(); ++k)
                all.values[k] = frame.values[k] - all.values[k];
        }
    }
    double worst_m = 0, mean_m = 0, off_m = 0;
    int switches = 0;
    for (std::size_t i = 1; i < off.size(); ++i) {
        double change_m = 0;
        for (std::size_t k = 1; k < off[i].values.size(); k += 3) {
            // Beyond a hill's rim there is other ground: what moves by more is no change of a
            // level.
            const double change = std::min(
                40.0, std::abs(static_cast<double>(off[i].values[k]) - off[i - 1].values[k]));
            change_m += change * 3 / static_cast<double>(off[i].values.size());
            off_m += std::min(40.0, std::abs(static_cast<double>(off[i].values[k]))) * 3 /
                     static_cast<double>(off[i].values.size()) / (kFrames - 1);
        }
        worst_m = std::max(worst_m, change_m);
        mean_m += change_m / (kFrames - 1);
        switches += triangles[i] != triangles[i - 1];
    }
    fmt::print(
        "[ lod ] {:.2f} m off the posts; from frame to frame that changes by {:.3f} m, at most "
        "{:.3f} m, over {} frames in {} of which tiles changed their level\n",
        off_m, mean_m, worst_m, kFrames, switches);
    EXPECT_GE(switches, 4);
    EXPECT_LT(worst_m, 1.7 * mean_m);
}

TEST(Lod, TheSkirtHangsDownByTwoPixels) {
    // A tile seen from beside, level with its flat ground: all that is drawn of it is its skirt.
    const dem::Heightfield flat = test::field_of(33, 33, {500000, 10, 0, 100, 0, -10}, "EPSG:32631",
                                                 [](int, int) { return 0; });
    test::Drawn drawn(flat, {test::kBrightSky}, 320, 256);
    geo::Geodetic eye = flat.grid.place(16, 80);
    const Ground& ground = drawn.ground();
    drawn.frame().camera = scene::heading_camera(
        ground.frame.to_local(eye), ground.frame.axes(eye.lat_rad, eye.lon_rad), 0, 0, radians(40));
    const image::ImageF picture = drawn.radiance();
    for (int x = 140; x < 180; ++x) {
        int rows = 0;
        for (int y = 0; y < picture.height; ++y)
            rows += !test::is_sky(picture, x, y);
        EXPECT_GE(rows, 2) << x;
        EXPECT_LE(rows, 3) << x;
    }
}

TEST(Lod, AVertexBudgetThatCannotBeMetCostsDetailByALimit) {
    Flight flight(bundled(), 64, 48);
    flight.stand(0.5, 0.5, 60, 30, 0);
    const auto triangles = [&](double pixel_error, int vertex_budget) {
        flight.set_pixel_error(pixel_error, vertex_budget);
        flight.draw();
        return flight.triangles();
    };
    constexpr int kEnough = 100000000;
    const int wanted = triangles(4, kEnough), least = triangles(4, 1);
    fmt::print("[ lod ] {} triangles as wanted, {} with a budget of a vertex\n", wanted, least);
    EXPECT_LT(least, wanted);
    EXPECT_LE(least, triangles(12, kEnough));
    EXPECT_GE(least, triangles(15, kEnough));
}

TEST(TileTree, BoxesHoldTheRoundEarth) {
    // Ten degrees: the ground bulges between the corners.
    const dem::Heightfield wide =
        test::field_of(201, 201, {5, 0.05, 0, 50, 0, -0.05}, "EPSG:4326",
                       [](int column, int row) { return 100.0 * ((column + row) % 3); });
    const dem::Pyramid pyramid(wide.height_m);
    const geo::LocalFrame frame(wide.grid.center());
    TileTree tree(pyramid, wide.grid, frame);
    const Box box = tree.box(tree.root(), 1);
    double outside_m = 0;
    for (int row = 0; row < 201; row += 5)
        for (int column = 0; column < 201; column += 5) {
            geo::Geodetic place = wide.grid.place(column, row);
            place.height_m = 200;
            outside_m = std::max(outside_m, box.distance(frame.to_local(place)));
        }
    fmt::print("[ lod ] posts of 10 degrees stand {:.2f} m out of their box\n", outside_m);
    EXPECT_LT(outside_m, 0.5);
}

TEST(TileTree, GivesTilesBackThatAFlightHasPassed) {
    const int tiles = static_cast<int>(TileTree::kMostKept) + 10;
    const dem::Heightfield strip =
        test::field_of(64 * tiles + 1, 2, {500000, 0.01, 0, 5200000, 0, -0.01}, "EPSG:32632",
                       [](int, int) { return 0; });
    const dem::Pyramid pyramid(strip.height_m);
    const geo::LocalFrame frame(strip.grid.center());
    TileTree tree(pyramid, strip.grid, frame);
    const glm::dvec3 first = tree.net({0, {0, 0}}).centre_m;
    tree.begin_frame();
    EXPECT_EQ(tree.cached(), 1u);  // few are kept
    for (int x = 1; x < tiles; ++x)
        tree.box({0, {x, 0}}, 1);
    tree.begin_frame();
    EXPECT_EQ(tree.cached(), static_cast<std::size_t>(tiles - 1));  // those of the last frame
    tree.box({0, {5, 0}}, 1);
    tree.begin_frame();
    EXPECT_EQ(tree.cached(), 1u);
    EXPECT_EQ(tree.net({0, {0, 0}}).centre_m, first);
}

TEST(TileTree, ExaggeratedGroundIsDrawnFineFromFartherAway) {
    const dem::Heightfield rough =
        test::field_of(301, 301, {500000, 30, 0, 5200000, 0, -30}, "EPSG:32632",
                       [](int column, int row) { return 20.0 * ((7 * column + 3 * row) % 5); });
    const dem::Pyramid pyramid(rough.height_m);
    const geo::LocalFrame frame(rough.grid.center());
    TileTree tree(pyramid, rough.grid, frame);
    LodView view;
    view.eye_m = glm::dvec3(0, 0, 5000);
    view.tolerance = 1e-3;
    const double as_it_is_m = tree.ranges(view).levels[0].range_m;
    view.exaggeration = 5;
    EXPECT_NEAR(tree.ranges(view).levels[0].range_m, 5 * as_it_is_m, 0.01 * as_it_is_m);
}

}  // namespace
}  // namespace relevo::render::test_lod
