#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "dem/load.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/view.h"
#include "shader/snippet.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::render {
namespace {

/// Frames of one DEM in plain grey, the sky in a colour that no ground has.
class Flight {
  public:
    Flight(const std::string& path, int width_px, int height_px)
        : dem_(dem::load(path)),
          ground_(make_ground(dem_)),
          width_px_(width_px),
          height_px_(height_px),
          bright_(shader::parse_snippet(
              "bright", "bright.glsl",
              "vec3 bright_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
              "    return vec3(40.0, 0.0, 40.0);\n"
              "}\n")) {
        values_.declare(core_params());
        EffectInputs effects;
        effects.stitch.snippets = {&bright_};
        effects.stitch.values = &values_;
        renderer_.emplace(
            context_, effects,
            RendererOptions{.width_px = width_px, .height_px = height_px, .antialias = false});
        const sun::Position position =
            sun::position(sun::parse_time("2026-06-21T15:00Z").utc, dem_.grid.center());
        inputs_.sun = make_sun_light(position, sun::Refraction::standard(dem_.grid.center()),
                                     ground_, dem_.grid);
    }

    void set_pixel_error(double pixel_error) {
        terrain_.emplace(dem_, ground_.frame,
                         TerrainOptions{.pixel_error = pixel_error, .vertex_budget = 100000000});
    }

    /// From a share of the way along the rows and columns, above the highest ground there or
    /// thereabouts.
    void stand(double column_share, double row_share, double above_ground_m, double heading_deg,
               double pitch_deg) {
        const double column = column_share * (dem_.grid.columns() - 1);
        const double row = row_share * (dem_.grid.rows() - 1);
        geo::Geodetic place = dem_.grid.place(column, row);
        const float here = dem_.height_m.at(static_cast<int>(column), static_cast<int>(row));
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
        return renderer_->read_picture();
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
    shader::Snippet bright_;
    shader::ParamStore values_;
    gl::Context context_{{.device = "software", .debug = true}};
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
            std::filesystem::path(path).filename().string(), orbit.azimuth_deg, flight.triangles(),
            all_triangles, d.psnr_db, moved_px);
        EXPECT_GE(d.psnr_db, 40);
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
    // Frame to frame, a picture from levels changes hardly more than one from every post does.
    Flight flight(bundled(), 480, 384);
    std::vector<image::Image8> levels, all;
    for (const double pixel_error : {0.0, 3.0}) {
        flight.set_pixel_error(pixel_error);
        for (int i = 0; i < 40; ++i) {
            flight.stand(0.2 + 0.002 * i, 0.5 + 0.003 * i, 400 + 10 * i, 60, -8);
            (pixel_error > 0 ? levels : all).push_back(flight.picture());
        }
    }
    double worst = 0, mean = 0;
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const double ratio =
            difference(levels[i - 1], levels[i]).mean / difference(all[i - 1], all[i]).mean;
        worst = std::max(worst, ratio);
        mean += ratio / static_cast<double>(levels.size() - 1);
    }
    fmt::print(
        "[ lod ] change from frame to frame against every post drawn: mean {:.3f}, "
        "largest {:.3f}\n",
        mean, worst);
    EXPECT_LT(worst, 1.15);
}

}  // namespace
}  // namespace relevo::render
