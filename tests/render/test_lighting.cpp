#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "dem/load.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/view.h"
#include "sun/zone.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_lighting {
namespace {

constexpr int kWidth = 640, kHeight = 512;

/// A DEM drawn in plain grey, seen from straight above with north up.
class Picture {
  public:
    Picture(const std::string& path, const char* utc, bool vertex_normals = false)
        : dem_(dem::load(path)), ground_(make_ground(dem_)) {
        const geo::Geodetic place = dem_.grid.center();
        const sun::Position position = sun::position(sun::parse_time(utc).utc, place);
        const sun::Refraction air = sun::Refraction::standard(place);
        elevation_deg_ = degrees(position.elevation_rad);
        gl::Context context({.device = test::gl_device(), .debug = true});
        shader::ParamStore values;
        values.declare(core_params());
        if (vertex_normals) values.set("terrain.normal", "vertex");
        EffectInputs no_effects;
        no_effects.stitch.values = &values;
        Renderer renderer(context, no_effects, {.width_px = kWidth, .height_px = kHeight});
        Terrain terrain(dem_, ground_.frame, {.pixel_error = 0});
        inputs_.sun = make_sun_light(position, air, ground_, dem_.grid);
        inputs_.camera = scene::orbit_camera({180, 90, 1}, points_to_show(dem_, ground_, 1),
                                             radians(40), double{kWidth} / kHeight);
        renderer.render_frame(terrain, ground_, inputs_);
        radiance_ = renderer.read_radiance();
        const double lift = air.apparent_rad(position.elevation_rad) - position.elevation_rad;
        to_sun_ = normalize(position.direction + glm::dvec3(0, 0, lift));
    }

    double elevation_deg() const { return elevation_deg_; }

    struct Sample {
        double cosine;    ///< between the ground's normal and the sun, from the DEM alone
        double radiance;  ///< in the picture
    };

    /// Posts drawn at random, with the normal from differences of exact places.
    std::vector<Sample> samples(int count) const {
        std::mt19937 random(7);
        std::vector<Sample> result;
        while (static_cast<int>(result.size()) < count) {
            const int column =
                2 + static_cast<int>(random() % static_cast<unsigned>(dem_.grid.columns() - 4));
            const int row =
                2 + static_cast<int>(random() % static_cast<unsigned>(dem_.grid.rows() - 4));
            const auto at = [&](int c, int r) { return ground_.frame.to_local(dem_.place(c, r)); };
            const glm::dvec3 here = at(column, row);
            const geo::Geodetic place = dem_.grid.place(column, row);
            const glm::dvec3 up = ground_.frame.up(place.lat_rad, place.lon_rad);
            glm::dvec3 normal = cross(at(column + 1, row) - at(column - 1, row),
                                      at(column, row - 1) - at(column, row + 1));
            normal = normalize(dot(normal, up) < 0 ? -normal : normal);
            const glm::dvec2 pixel = project(here);
            const int x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
            if (std::isnan(here.z) || std::isnan(normal.x)) continue;
            if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
            result.push_back({dot(normal, to_sun_), radiance_.at(x, y, 1)});
        }
        return result;
    }

    /// Column and row, from the top, of a point.
    glm::dvec2 project(const glm::dvec3& point) const {
        const scene::Camera& camera = inputs_.camera;
        const glm::dvec3 to = point - camera.eye_m;
        const double depth = dot(to, camera.forward);
        const double scale = kHeight / 2.0 / std::tan(camera.fov_y_rad / 2);
        return {kWidth / 2.0 + scale * dot(to, cross(camera.forward, camera.up)) / depth,
                kHeight / 2.0 - scale * dot(to, camera.up) / depth};
    }

    const image::ImageF& radiance() const { return radiance_; }
    const dem::Heightfield& dem() const { return dem_; }
    const Ground& ground() const { return ground_; }

  private:
    dem::Heightfield dem_;
    Ground ground_;
    FrameInputs inputs_;
    image::ImageF radiance_;
    glm::dvec3 to_sun_{};
    double elevation_deg_ = 0;
};

double correlation(const std::vector<Picture::Sample>& samples) {
    double mean_c = 0, mean_r = 0;
    for (const auto& s : samples) {
        mean_c += std::max(s.cosine, 0.0) / static_cast<double>(samples.size());
        mean_r += s.radiance / static_cast<double>(samples.size());
    }
    double cc = 0, rr = 0, cr = 0;
    for (const auto& s : samples) {
        const double c = std::max(s.cosine, 0.0) - mean_c, r = s.radiance - mean_r;
        cc += c * c;
        rr += r * r;
        cr += c * r;
    }
    return cr / std::sqrt(cc * rr);
}

void expect_lit_from_the_sun(const std::string& path, const char* utc, double least) {
    const Picture picture(path, utc);
    const auto samples = picture.samples(4000);
    // The brighter half against the darker half of the slopes, by what the DEM says of them.
    std::vector<double> cosines;
    for (const auto& sample : samples)
        cosines.push_back(sample.cosine);
    std::nth_element(cosines.begin(), cosines.begin() + 2000, cosines.end());
    double facing = 0, averted = 0;
    for (const auto& sample : samples)
        (sample.cosine > cosines[2000] ? facing : averted) += sample.radiance / 2000;
    const double r = correlation(samples);
    fmt::print(
        "[ lighting ] {} at {}, sun {:.1f} degrees high: facing slopes {:.3f}, averted {:.3f}, "
        "correlation with the DEM's own normals {:.3f}\n",
        std::filesystem::path(path).filename().string(), utc, picture.elevation_deg(), facing,
        averted, r);
    EXPECT_GT(facing, 1.02 * averted);
    EXPECT_GT(r, least);
}

TEST(Lighting, SlopesThatFaceTheSunAreBrighterOnTheBundledDem) {
    const std::string path = (test::source_dir() / "data/dem/jacksboro.tif").string();
    for (const char* utc : {"2026-06-21T12:00Z", "2026-06-21T17:30Z", "2026-12-21T21:00Z"})
        expect_lit_from_the_sun(path, utc, 0.93);
}

TEST(Lighting, SlopesThatFaceTheSunAreBrighterInBothHemispheres) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* utc : {"2026-06-21T15:00Z", "2026-09-23T20:00Z", "2026-12-21T23:30Z"})
        expect_lit_from_the_sun((data / "dem/srtm_bigtujunga30m_utm11.tif").string(), utc, 0.85);
    for (const char* utc : {"2026-12-21T06:00Z", "2026-06-21T10:30Z", "2026-03-20T15:00Z"})
        expect_lit_from_the_sun((data / "dem/swellendam/srtm_41_19_4326.tif").string(), utc, 0.85);
}

TEST(Lighting, VertexNormalsAreTheSameLight) {
    const std::string path = (test::source_dir() / "data/dem/jacksboro.tif").string();
    const Picture picture(path, "2026-06-21T12:00Z", true);
    EXPECT_GT(correlation(picture.samples(2000)), 0.85);
}

TEST(Picture, NorthIsUpAndEastIsRight) {
    // The DEM's highest post lies where the map has it, and the picture's background is around the
    // DEM.
    const Picture picture((test::source_dir() / "data/dem/jacksboro.tif").string(),
                          "2026-06-21T17:30Z");
    const dem::Grid& grid = picture.dem().grid;
    const auto pixel_of = [&](int column, int row) {
        return picture.project(picture.ground().frame.to_local(picture.dem().place(column, row)));
    };
    const glm::dvec2 north_west = pixel_of(0, 0);
    const glm::dvec2 south_east = pixel_of(grid.columns() - 1, grid.rows() - 1);
    EXPECT_LT(north_west.x, south_east.x);
    EXPECT_LT(north_west.y, south_east.y);
    // True to scale: as wide against its height as on the ground.
    const glm::dvec2 extent = grid.extent_m();
    EXPECT_NEAR((south_east.x - north_west.x) / (south_east.y - north_west.y), extent.x / extent.y,
                0.02);
    // Terrain inside, sky outside.
    const image::ImageF& radiance = picture.radiance();
    const float sky = radiance.at(2, 2, 2);
    const auto is_sky = [&](glm::dvec2 p) {
        return std::abs(radiance.at(static_cast<int>(p.x), static_cast<int>(p.y), 2) - sky) < 1e-3f;
    };
    EXPECT_TRUE(is_sky(north_west - glm::dvec2(6, 0)));
    EXPECT_FALSE(is_sky(north_west + glm::dvec2(6, 6)));
    EXPECT_TRUE(is_sky(south_east + glm::dvec2(6, 0)));
    EXPECT_FALSE(is_sky(south_east - glm::dvec2(6, 6)));
}

}  // namespace
}  // namespace relevo::render::test_lighting
