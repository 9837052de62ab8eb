// What --exaggerate changes: the light and the shape, and not what the ground is taken for.

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "light/fields.h"

namespace relevo::render::test_exaggeration {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr double kSpacing_m = 25;
constexpr int kSide = 257;

/// A washboard along the columns, at the equator of its zone where the grid runs along the axes.
double height_m(double east_m) {
    return 700 + 150 * std::sin(east_m / 400);
}
double slope(double east_m) {
    return 150.0 / 400 * std::cos(east_m / 400);
}

dem::Heightfield washboard() {
    return test::field_of(kSide, kSide, {500000, kSpacing_m, 0, 3200, 0, -kSpacing_m}, "EPSG:32631",
                          [](int column, int) { return height_m(column * 25.0); });
}

/// Values of a probe over the washboard from above, where it is drawn k times as high.
struct Sampled {
    double exaggeration;
    image::ImageF image;
};
std::vector<Sampled> sampled(const std::string& values, bool vertex_normals = false) {
    const TestEffect probe{
        "probe",
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    radiance = vec3(" +
            values + ", 1.0) / frame.exposure;\n}\n"};
    Drawn drawn(washboard(), {test::kBrightSky, probe}, 128, 96, 0, {},
                {{"terrain.normal", vertex_normals ? "vertex" : "fragment"}});
    std::vector<Sampled> result;
    for (const double exaggeration : {0.5, 1.0, 3.0}) {
        drawn.frame().exaggeration = exaggeration;
        drawn.stand(0.5, 0.5, 700 * exaggeration + 3000, 0, -90);
        result.push_back({exaggeration, drawn.radiance()});
    }
    return result;
}

/// @param expected  of the ground's easting from the DEM's first column [m], and the exaggeration
template <typename Expected>
void expect_by_place(const std::string& value, double tolerance, const Expected& expected,
                     bool vertex_normals = false) {
    for (const Sampled& s : sampled("s.ground_m.x / 1024.0, " + value, vertex_normals)) {
        std::vector<double> errors;
        for (int y = 0; y < s.image.height; y += 5) {
            for (int x = 0; x < s.image.width; ++x) {
                ASSERT_FALSE(test::is_sky(s.image, x, y));
                const glm::dvec2 found = Drawn::values(s.image, x, y);
                const double east_m = 1024 * found.x * 0.9996 + kSpacing_m * (kSide - 1) / 2;
                errors.push_back(std::abs(found.y - expected(east_m, s.exaggeration)));
            }
        }
        std::sort(errors.begin(), errors.end());
        EXPECT_LT(errors[errors.size() * 99 / 100], tolerance) << value << " at " << s.exaggeration;
    }
}

TEST(Exaggeration, DoesNotMoveHeightAndSlopeClasses) {
    expect_by_place("s.height_m / 1024.0", 2e-3,
                    [](double east_m, double) { return height_m(east_m) / 1024; });
    expect_by_place("s.ground_m.z / 1024.0", 2e-3,
                    [](double east_m, double) { return height_m(east_m) / 1024; });
    for (const bool vertex_normals : {false, true})
        expect_by_place(
            "dot(s.ground_normal, s.up)", 8e-3,
            [](double east_m, double) { return 1 / std::hypot(1, slope(east_m)); }, vertex_normals);
}

TEST(Exaggeration, TurnsTheNormalsThatLightSees) {
    for (const bool vertex_normals : {false, true})
        for (const char* normal : {"s.geometric_normal.x", "s.normal.x"})
            expect_by_place(
                // The paper's normals are of the way to the next post: half a post aside.
                normal, vertex_normals ? 0.045 : 0.01,
                [](double east_m, double exaggeration) {
                    const double drawn = exaggeration * slope(east_m);
                    return -drawn / std::hypot(1, drawn);
                },
                vertex_normals);
}

TEST(Exaggeration, MovesNoTextureAlongTheGround) {
    // 90 km from the middle the vertical leans by 0.8 degrees: 27 km more of height are 380 m.
    const auto far = test::field_of(401, 101, {410000, 500, 0, 5200000, 0, -500}, "EPSG:32632",
                                    [](int, int) { return 3000.0; });
    std::vector<double> east_km;
    for (const double exaggeration : {1.0, 10.0}) {
        Drawn drawn(
            far,
            {test::kBrightSky,
             {"probe",
              "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
              "    radiance = vec3((s.ground_m.x - 90000.0) / 1024.0, 0.0, 1.0) / "
              "frame.exposure;\n}\n"}},
            8, 8);
        drawn.frame().exaggeration = exaggeration;
        drawn.stand(0.95, 0.5, 3000 * exaggeration + 1000, 0, -90);
        east_km.push_back(1.024 * Drawn::values(drawn.radiance(), 4, 4).x);
    }
    EXPECT_NEAR(east_km[0], east_km[1], 0.02);
}

TEST(Exaggeration, StepsOfTheGroundAreThoseOfItsCoordinates) {
    // Looking down at a slope, the height's own step and that of the ground's coordinates agree.
    for (const Sampled& s : sampled("s.ground_dx_m.z, s.height_dx_m")) {
        std::vector<double> errors;
        for (int y = 0; y < s.image.height; y += 7)
            for (int x = 30; x < 98; ++x) {
                const glm::dvec2 found = Drawn::values(s.image, x, y);
                errors.push_back(std::abs(found.x - found.y));
            }
        std::sort(errors.begin(), errors.end());
        // A pixel is 22 m wide, its slope rises by up to 8 m.
        EXPECT_LT(errors[errors.size() * 9 / 10], 0.8) << s.exaggeration;
    }
}

/// What three cameras see of hills of so many times their height, drawn so many times as high:
/// along the ground and from above, with more posts than a tile has.
struct Views {
    std::vector<image::ImageF> images;  // red: the distance, in 1024 m
    std::vector<int> triangles;
};
Views views_of(double height_factor, double exaggeration) {
    const dem::Heightfield hills =
        test::field_of(385, 385, {500000, 25, 0, 5000, 0, -25}, "EPSG:32631", [&](int x, int y) {
            return height_factor * (700 + 60 * std::sin(x / 9.0) * std::sin(y / 13.0 + 0.01 * x));
        });
    const TestEffect probe{
        "probe",
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    radiance = vec3(s.distance_m / 1024.0, 0.0, 1.0) / frame.exposure;\n}\n"};
    Drawn drawn(hills, {test::kBrightSky, probe}, 160, 128, 4);
    drawn.frame().exaggeration = exaggeration;
    Views views;
    for (const auto& [share, above_m, pitch_deg] :
         {std::array{0.1, 500.0, 0.0}, {0.5, 1500.0, -40.0}, {0.3, 900.0, -10.0}}) {
        drawn.stand(share, 0.4, height_factor * exaggeration * 700 + above_m, 70, pitch_deg);
        views.images.push_back(drawn.radiance());
        views.triangles.push_back(drawn.renderer().triangles());
    }
    return views;
}

TEST(Exaggeration, GroundIsDrawnAsGroundAsHighIs) {
    const Views found = views_of(1, 5), expected = views_of(5, 1);
    for (std::size_t i = 0; i < found.images.size(); ++i) {
        // What is coarser by how far it is off is as coarse, and no more is culled.
        EXPECT_NEAR(found.triangles[i], expected.triangles[i], 0.1 * expected.triangles[i]);
        int ground = 0, other = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 160; ++x) {
                const bool sky = test::is_sky(expected.images[i], x, y);
                ground += !sky;
                if (sky != test::is_sky(found.images[i], x, y))
                    ++other;
                else if (!sky)
                    other += std::abs(Drawn::values(found.images[i], x, y).x /
                                          Drawn::values(expected.images[i], x, y).x -
                                      1) > 0.01;
            }
        EXPECT_GT(ground, 5000) << i;
        EXPECT_LT(other, 0.02 * ground) << i;
    }
}

}  // namespace
}  // namespace relevo::render::test_exaggeration
