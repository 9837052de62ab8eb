// Distances to lines as shaders get them, against the same lines projected into the picture.

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "light/fields.h"
#include "render/eye_post.h"

namespace relevo::render::test_lines {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr double kSpacing_m = 30;
constexpr int kSide = 513;

/// A slope of one plane: where a line is on the ground is known.
dem::Heightfield slope() {
    return test::field_of(kSide, kSide, {500000, kSpacing_m, 0, 5200000, 0, -kSpacing_m},
                          "EPSG:32632",
                          [](int column, int row) { return 800 + 2.0 * column + 0.5 * row; });
}

TestEffect probe(const std::string& values) {
    return {"probe",
            "//@ include lib/lines.glsl\n"
            "uniform sampler2D probe_way;\n"
            "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
            "    LineHit hit = lines_near(probe_way, s, 8.0, 0.0);\n"
            "    radiance = vec3(" +
                values +
                ", 1.0) / frame.exposure;\n"
                "}\n"};
}

/// Bends on the DEM, written in another CRS, as vertices of which lines are straight.
std::vector<glm::dvec2> bends() {
    std::vector<glm::dvec2> posts;
    for (int i = 0; i < 40; ++i)
        posts.emplace_back(60 + 10.0 * i, 250 + 60 * std::sin(i * 0.4) + 3 * i);
    return posts;
}

std::string written(const dem::Heightfield& field, const std::vector<glm::dvec2>& posts) {
    const std::filesystem::path file = test::scratch_dir("lines") / "line.geojson";
    std::ofstream out(file);
    out << R"({"type": "Feature", "properties": {"speed": 42}, "geometry": {"type": "LineString",)"
        << R"( "coordinates": [)";
    for (std::size_t i = 0; i < posts.size(); ++i) {
        const geo::Geodetic place = field.grid.place(posts[i].x, posts[i].y);
        out << fmt::format("{}[{:.12f}, {:.12f}]", i ? ", " : "", degrees(place.lon_rad),
                           degrees(place.lat_rad));
    }
    out << "]}}";
    return file.string();
}

/// The line in the picture [px], from its upper left corner; NaN behind the eye.
std::vector<glm::dvec2> projected(const Drawn& drawn, const std::vector<glm::dvec2>& posts) {
    const scene::Camera& camera = drawn.frame().camera;
    const double unit = drawn.height_px() / (2 * std::tan(camera.fov_y_rad / 2));
    std::vector<glm::dvec2> result;
    for (std::size_t i = 0; i + 1 < posts.size(); ++i)
        for (int k = 0; k < 200; ++k) {
            const glm::dvec2 post = glm::mix(posts[i], posts[i + 1], k / 200.0);
            geo::Geodetic place = drawn.dem().grid.place(post.x, post.y);
            place.height_m = drawn.frame().exaggeration * (800 + 2.0 * post.x + 0.5 * post.y);
            const glm::dvec3 away = drawn.ground().frame.to_local(place) - camera.eye_m;
            const double depth = dot(away, camera.forward);
            const glm::dvec3 right = cross(camera.forward, camera.up);
            const glm::dvec2 at(dot(away, right) / depth, -dot(away, camera.up) / depth);
            result.push_back(depth < 0.2 ? glm::dvec2(std::nan(""))
                                         : 0.5 * glm::dvec2(drawn.width_px(), drawn.height_px()) +
                                               unit * at);
        }
    return result;
}

double distance_px(const std::vector<glm::dvec2>& line, const glm::dvec2& p) {
    double nearest = 1e30;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const glm::dvec2 a = line[i], way = line[i + 1] - a;
        if (std::isnan(a.x + way.x)) continue;
        const double t = glm::clamp(dot(p - a, way) / std::max(dot(way, way), 1e-30), 0.0, 1.0);
        nearest = std::min(nearest, distance(p, a + t * way));
    }
    return nearest;
}

struct View {
    double column, row;  ///< shares
    double above_m, heading_deg, pitch_deg;
    double worst_px;  ///< where a pixel reaches from 100 m to the horizon, planes are not exact
};

struct Errors {
    int count = 0;
    double worst_px = 0, mean_px = 0;
};

/// Errors of the distances up to 3 px in a view.
Errors compare(Drawn& drawn, const std::vector<glm::dvec2>& posts) {
    const image::ImageF image = drawn.radiance();
    const std::vector<glm::dvec2> line = projected(drawn, posts);
    Errors errors;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (test::is_sky(image, x, y)) continue;
            const double found = Drawn::values(image, x, y).x;
            const double truth = distance_px(line, {x + 0.5, y + 0.5});
            if (truth > 3 && found > 3) continue;
            ++errors.count;
            errors.worst_px = std::max(errors.worst_px, std::abs(found - truth));
            errors.mean_px += std::abs(found - truth);
        }
    errors.mean_px /= std::max(errors.count, 1);
    return errors;
}

double ground_m(double column_share, double row_share) {
    return 800 + (2.0 * column_share + 0.5 * row_share) * (kSide - 1);
}

TEST(Lines, HaveTheirDistanceInPixelsFromTwoMetresTo50Kilometres) {
    const dem::Heightfield field = slope();
    const std::vector<glm::dvec2> posts = bends();
    Drawn drawn(field, {test::kBrightSky, probe("min(hit.pixels, 100.0), 0.0")}, 200, 160, 0, {},
                {}, {{"probe.way", "probe.file", written(field, posts), ""}});
    const double column = 240.0 / (kSide - 1),
                 row = (250 + 60 * std::sin(18 * 0.4) + 54) / (kSide - 1);
    for (const double exaggeration : {1.0, 2.5}) {
        drawn.frame().exaggeration = exaggeration;
        for (const View& view : {View{column, row, 2, 20, -60, 0.05},
                                 {column, row + 0.002, 2, 0, -15, 1.5},
                                 {column, row + 0.004, 60, 0, -45, 0.05},
                                 {column, row + 0.1, 900, 10, -20, 0.05},
                                 {column, row + 0.1, 9000, 0, -80, 0.05},
                                 {0.5, 0.5, 50000, 0, -90, 0.05}}) {
            drawn.stand(view.column, view.row,
                        exaggeration * ground_m(view.column, view.row) + view.above_m,
                        view.heading_deg, view.pitch_deg);
            const Errors errors = compare(drawn, posts);
            fmt::print(
                "[ accuracy ] {} m above, exaggeration {}: {} pixels, mean {:.3f}, worst "
                "{:.3f} px\n",
                view.above_m, exaggeration, errors.count, errors.mean_px, errors.worst_px);
            EXPECT_GT(errors.count, 100);
            EXPECT_LT(errors.mean_px, 0.02);
            EXPECT_LT(errors.worst_px, view.worst_px);
        }
    }
}

// Pixels of a map of a continent are half as many metres wide at 60 degrees as on the equator.
TEST(Lines, HaveTheirDistanceInPixelsOnMapsOfContinents) {
    const dem::Heightfield field =
        test::field_of(261, 281, {-40, 0.3125, 0, 75, 0, -0.3125}, "EPSG:4326",
                       [](int column, int row) { return 800 + 2.0 * column + 0.5 * row; });
    std::vector<glm::dvec2> posts;
    for (int i = 0; i <= 120; ++i)
        posts.emplace_back(10 + 2.0 * i, 140 + 130 * std::cos(i * 0.2));
    Drawn drawn(field, {test::kBrightSky, probe("min(hit.pixels, 100.0), 0.0")}, 260, 280, 0, {},
                {}, {{"probe.way", "probe.file", written(field, posts), ""}},
                {.orthographic = true});
    drawn.map({260, 280});
    const image::ImageF image = drawn.radiance();
    std::vector<glm::dvec2> line;
    for (const glm::dvec2& post : posts)
        line.push_back(drawn.frame().camera.map->pixel(post));
    int count = 0;
    double worst_px = 0, sum_px = 0;
    for (int y = 4; y < image.height - 4; ++y)
        for (int x = 4; x < image.width - 4; ++x) {
            const double found = Drawn::values(image, x, y).x;
            const double truth = distance_px(line, {x + 0.5, y + 0.5});
            if (truth > 3 && found > 3) continue;
            ++count;
            sum_px += std::abs(found - truth);
            worst_px = std::max(worst_px, std::abs(found - truth));
        }
    fmt::print("[ accuracy ] a map: {} pixels, mean {:.3f}, worst {:.3f} px\n", count,
               sum_px / count, worst_px);
    EXPECT_GT(count, 1000);
    EXPECT_LT(sum_px / count, 0.03);
    EXPECT_LT(worst_px, 0.5);
}

TEST(Lines, HaveTheirAttributeAndTheDistanceOnTheGround) {
    const dem::Heightfield field = slope();
    const std::vector<glm::dvec2> posts = bends();
    const LineSource source{"probe.way", "probe.file", written(field, posts), "speed"};
    const auto image_of = [&](const TestEffect& effect, double above_m, double pitch_deg) {
        Drawn drawn(field, {test::kBrightSky, effect}, 80, 64, 0, {}, {}, {source});
        drawn.stand(0.5, 0.6, ground_m(0.5, 0.6) + above_m, 0, pitch_deg);
        return drawn.radiance();
    };
    int seen = 0;
    const image::ImageF image = image_of(probe("hit.value, float(hit.line)"), 1500, -30);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec2 found = Drawn::values(image, x, y);
            if (found.y < 0 || test::is_sky(image, x, y)) continue;
            ++seen;
            EXPECT_NEAR(found.x, 42, 0.1);
        }
    EXPECT_GT(seen, 100);

    // On the ground, by the place of each pixel, for lines that are near in metres too.
    TestEffect metres = probe("hit.metres, s.post.x / 512.0");
    metres.glsl.replace(metres.glsl.find("8.0, 0.0"), 8, "8.0, 500.0");
    TestEffect along = probe("hit.along_m / 1000.0, s.post.y / 512.0");
    const image::ImageF a = image_of(metres, 3000, -80), b = image_of(along, 3000, -80);
    const glm::dmat2 metric = metres_per_post(field.grid, {256, 300});
    double worst_m = 0;
    int count = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const glm::dvec2 post(512 * Drawn::values(a, x, y).y, 512 * Drawn::values(b, x, y).y);
            double truth_m = 1e30, along_m = 0, sum_m = 0;
            for (std::size_t i = 0; i + 1 < posts.size(); ++i) {
                const glm::dvec2 from = metric * (posts[i] - post);
                const glm::dvec2 way = metric * (posts[i + 1] - posts[i]);
                const double t = glm::clamp(-dot(from, way) / dot(way, way), 0.0, 1.0);
                if (length(from + t * way) < truth_m) {
                    truth_m = length(from + t * way);
                    along_m = sum_m + t * length(way);
                }
                sum_m += length(way);
            }
            if (truth_m > 400) continue;
            ++count;
            // Posts come as halves, to a quarter of one.
            worst_m = std::max(worst_m, std::abs(Drawn::values(a, x, y).x - truth_m));
            if (truth_m > 60) continue;
            EXPECT_NEAR(1000 * Drawn::values(b, x, y).x, along_m, 15 + 1e-3 * along_m);
        }
    fmt::print("[ accuracy ] on the ground: {} places, worst {:.2f} m\n", count, worst_m);
    EXPECT_GT(count, 500);
    EXPECT_LT(worst_m, 15);
}

}  // namespace
}  // namespace relevo::render::test_lines
