// How heights change from pixel to pixel, against the drawn triangles in double precision.

#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "light/fields.h"
#include "render/programs.h"
#include "shader/core_texts.h"

namespace relevo::render::test_height_steps {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr double kSpacing_m = 20;

/// Hills of several sizes on 129 x 129 posts: four tiles.
dem::Heightfield hills(double base_m) {
    return test::field_of(129, 129, {500000, kSpacing_m, 0, 5200000, 0, -kSpacing_m}, "EPSG:32632",
                          [&](int column, int row) {
                              return base_m + 120 * std::sin(column * 0.11) * std::cos(row * 0.13) +
                                     25 * std::sin(column * 0.71 + 0.3 * row) +
                                     9 * std::cos(1.9 * row);
                          });
}

TestEffect probe(const std::string& values) {
    return {"probe",
            "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
            "    radiance = vec3(" +
                values +
                ", 1.0) / frame.exposure;\n"
                "}\n"};
}

/// The triangles of a field where every post is drawn, in the local frame.
class Mesh {
  public:
    explicit Mesh(const Drawn& drawn) : height_m_(drawn.dem().height_m) {
        posts_ = Array2d<glm::dvec3>(height_m_.width(), height_m_.height());
        for (int row = 0; row < posts_.height(); ++row)
            for (int column = 0; column < posts_.width(); ++column)
                posts_.at(column, row) =
                    drawn.ground().frame.to_local(drawn_place(drawn, column, row));
    }

    struct Hit {
        double distance_m = 1e300, height_m = 0;
        glm::dvec2 step_m{0};   ///< of the height on the triangle's plane, right and up [m/px]
        double edge_share = 0;  ///< of the triangle, from the nearest of its sides
    };

    /// The nearest triangle under a point of the picture.
    Hit hit(const Drawn& drawn, double x_px, double y_px) const {
        Hit nearest;
        const glm::dvec3 eye = drawn.frame().camera.eye_m;
        const glm::dvec3 ray = drawn.ray(x_px, y_px);
        for (int row = 0; row + 1 < posts_.height(); ++row) {
            for (int column = 0; column + 1 < posts_.width(); ++column) {
                for (const bool lower : {false, true}) {
                    using Corner = glm::ivec2;
                    const std::array<Corner, 3> corners{
                        lower ? Corner(column + 1, row + 1) : Corner(column, row),
                        Corner(column + 1, row), Corner(column, row + 1)};
                    std::array<glm::dvec3, 3> p;
                    glm::dvec3 h;
                    for (std::size_t i = 0; i < 3; ++i) {
                        p[i] = posts_.at(corners[i].x, corners[i].y) - eye;
                        h[static_cast<int>(i)] = height_m_.at(corners[i].x, corners[i].y);
                    }
                    // The point is p w with weights w of sum 1; ray t = p w.
                    const glm::dmat3 columns(p[0], p[1], p[2]);
                    const double volume = determinant(columns);
                    if (std::abs(volume) < 1e-9) continue;
                    const glm::dmat3 inverse = glm::inverse(columns);
                    const auto weights = [&](const glm::dvec3& along) {
                        const glm::dvec3 w = inverse * along;
                        return w / (w.x + w.y + w.z);
                    };
                    const glm::dvec3 unscaled = inverse * ray;
                    const double t = 1 / (unscaled.x + unscaled.y + unscaled.z);
                    const glm::dvec3 w = unscaled * t;
                    if (t <= 0 || t >= nearest.distance_m || std::min({w.x, w.y, w.z}) < 0)
                        continue;
                    nearest.distance_m = t;
                    nearest.height_m = dot(h, w);
                    nearest.edge_share = std::min({w.x, w.y, w.z});
                    constexpr double kStep_px = 1e-4;
                    const auto at = [&](double dx, double dy) {
                        return dot(h, weights(drawn.ray(x_px + dx, y_px - dy)));
                    };
                    nearest.step_m = {(at(kStep_px, 0) - at(-kStep_px, 0)) / (2 * kStep_px),
                                      (at(0, kStep_px) - at(0, -kStep_px)) / (2 * kStep_px)};
                }
            }
        }
        return nearest;
    }

  private:
    static geo::Geodetic drawn_place(const Drawn& drawn, int column, int row) {
        geo::Geodetic place = drawn.dem().place(column, row);
        place.height_m *= drawn.frame().exaggeration;
        return place;
    }

    Array2d<float> height_m_;
    Array2d<glm::dvec3> posts_;
};

struct Compared {
    std::vector<double> errors;  ///< of the step, as a share of the true one and a floor
    double twofold = 0;          ///< share of pixels whose step is off by a factor of 2 or more
};

Compared compare(Drawn& drawn, int count, double floor_m) {
    const Mesh mesh(drawn);
    const image::ImageF image = drawn.radiance();
    std::mt19937 random(11);
    Compared result;
    while (static_cast<int>(result.errors.size()) < count) {
        const int x = static_cast<int>(random() % static_cast<unsigned>(image.width));
        const int y = static_cast<int>(random() % static_cast<unsigned>(image.height));
        if (test::is_sky(image, x, y)) continue;
        const Mesh::Hit hit = mesh.hit(drawn, x + 0.5, y + 0.5);
        // On the edge of two triangles either may be drawn, and beyond the DEM hangs its skirt.
        if (hit.distance_m > 1e200 || hit.edge_share < 1e-3) continue;
        const glm::dvec2 found = Drawn::values(image, x, y);
        const double truth = length(hit.step_m);
        result.errors.push_back(length(found - hit.step_m) / (truth + floor_m));
        result.twofold += (length(found) > 2 * truth || length(found) < truth / 2) / double(count);
    }
    std::sort(result.errors.begin(), result.errors.end());
    return result;
}

TEST(HeightSteps, AreThoseOfTheDrawnTriangles) {
    for (const bool are_steps : {true, false}) {
        Drawn drawn(hills(900),
                    {test::kBrightSky, probe(are_steps ? "s.height_dx_m, s.height_dy_m"
                                                       : "s.ground_dx_m.z, s.ground_dy_m.z")},
                    320, 256);
        double twofold = 0;
        for (const double pitch_deg : {-5.0, -25.0, -80.0}) {
            drawn.stand(0.4, 0.55, 1150, 30, pitch_deg);
            const Compared found = compare(drawn, 150, 1e-4);
            twofold = std::max(twofold, found.twofold);
            const auto share = [&](double of) {
                return found.errors[static_cast<std::size_t>(of * 149)];
            };
            fmt::print(
                "[ accuracy ] {} looking down {} degrees: median {:.2g}, 95 % {:.2g}, worst "
                "{:.2g}; off twofold: {:.0f} % of pixels\n",
                are_steps ? "height_dx_m" : "ground_dx_m.z", -pitch_deg, share(0.5), share(0.95),
                share(1), 100 * found.twofold);
            if (!are_steps) continue;
            EXPECT_LT(share(0.5), 1e-3);
            EXPECT_LT(share(0.95), 5e-3);
            EXPECT_LT(share(1), 0.05);
        }
        // What textures are filtered by is something else: this is why there are two.
        EXPECT_EQ(twofold > 0.02, !are_steps);
    }
}

TEST(HeightSteps, AreExactAtTheEyesFeetOnHighGround) {
    // A pixel is a millimetre there, and a float of 4000 m has steps of a quarter of one.
    Drawn drawn(hills(4000), {test::kBrightSky, probe("s.height_dx_m, s.height_dy_m")}, 320, 256);
    const double ground_m = drawn.dem().height_at(64.3, 60.2);
    drawn.stand(64.3 / 128, 60.2 / 128, ground_m + 1.7, 100, -70);
    const Compared found = compare(drawn, 100, 1e-6);
    EXPECT_LT(found.errors[95], 0.01);
}

TEST(HeightSteps, AreOfTheDemsOwnHeightsUnderExaggeration) {
    Drawn drawn(hills(900), {test::kBrightSky, probe("s.height_dx_m, s.height_dy_m")}, 160, 128);
    for (const double exaggeration : {0.5, 3.0}) {
        drawn.frame().exaggeration = exaggeration;
        drawn.stand(0.4, 0.55, 1200 * exaggeration, 30, -30);
        const Compared found = compare(drawn, 60, 1e-4);
        EXPECT_LT(found.errors[30], 1e-3) << exaggeration;
        EXPECT_LT(found.errors[57], 5e-3) << exaggeration;
    }
}

TEST(HeightSteps, AreZeroOnLevelGround) {
    // A lake below a mountain, seen from above both, from between and from its shore.
    const auto lake = test::field_of(
        129, 129, {500000, kSpacing_m, 0, 5200000, 0, -kSpacing_m}, "EPSG:32632",
        [](int column, int row) { return 500 + 9.0 * std::max(column + row - 140, 0); });
    Drawn drawn(lake,
                {test::kBrightSky,
                 probe("length(vec2(s.height_dx_m, s.height_dy_m)), s.post.x + s.post.y")},
                320, 256);
    for (const double eye_m : {4000.0, 1500.0, 700.0, 502.0}) {
        drawn.stand(0.3, 0.2, eye_m, 150, eye_m > 1000 ? -60 : -5);
        const image::ImageF image = drawn.radiance();
        int level = 0, steep = 0, is_zero = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (test::is_sky(image, x, y)) continue;
                const glm::dvec2 found = Drawn::values(image, x, y);
                level += found.y < 139;
                is_zero += found.y < 139 && found.x == 0;
                steep += found.y > 141 && found.x > 0;
            }
        EXPECT_GT(level, 2000) << eye_m;
        EXPECT_GE(is_zero, 0.9999 * level) << eye_m;  // slivers round by more
        EXPECT_GT(steep, 100) << eye_m;
    }
}

TEST(HeightSteps, DrawContoursOfOneWidth) {
    // A cone's contours are circles: the area of a drawn one over its length is its width.
    constexpr double kTop_m = 1500, kSlope = 0.1, kInterval_m = 50, kWidth_px = 2;
    constexpr int kSide = 257;
    const auto cone = test::field_of(
        kSide, kSide, {500000, kSpacing_m, 0, 5200000, 0, -kSpacing_m}, "EPSG:32632",
        [&](int column, int row) {
            return kTop_m - kSlope * kSpacing_m * std::hypot(column - 128.0, row - 128.0);
        });
    const std::string line =
        "float contour_line(in Surface s, in vec2 steps) {\n"
        "    float level = floor(s.height_m / 50.0 + 0.5) * 50.0;\n"
        "    float away_px = abs(s.height_m - level) / max(length(steps), 1e-6);\n"
        "    return clamp(0.5 * 2.0 + 0.5 - away_px, 0.0, 1.0);\n"
        "}\n"
        "void contour_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    radiance = vec3(contour_line(s, vec2(STEPS)), floor(s.height_m / 50.0 + 0.5), 1.0) / "
        "frame.exposure;\n"
        "}\n";
    for (const bool are_steps : {true, false}) {
        std::string glsl = line;
        glsl.replace(
            glsl.find("STEPS"), 5,
            are_steps ? "s.height_dx_m, s.height_dy_m" : "s.ground_dx_m.z, s.ground_dy_m.z");
        Drawn drawn(cone, {test::kBrightSky, {"contour", glsl}}, 640, 512);
        drawn.stand(0.5, 1.6, 2400, 0, -11);
        const image::ImageF image = drawn.radiance();
        std::array<double, 128> area_px{};
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                if (test::is_sky(image, x, y)) continue;
                const glm::dvec2 found = Drawn::values(image, x, y);
                area_px[static_cast<std::size_t>(std::lround(found.y))] += found.x;
            }
        }
        double least = 1e9, most = 0;
        for (double level_m = kTop_m - 2 * kInterval_m; level_m > 1270; level_m -= kInterval_m) {
            // Around the circle, as the picture shows it.
            double length_px = 0;
            glm::dvec2 before(0);
            bool whole = true;
            for (int i = 0; i <= 720; ++i) {
                const double angle = radians(i / 2.0);
                const double radius = (kTop_m - level_m) / (kSlope * kSpacing_m);
                geo::Geodetic place = drawn.dem().grid.place(128 + radius * std::cos(angle),
                                                             128 + radius * std::sin(angle));
                place.height_m = level_m;
                const scene::Camera& camera = drawn.frame().camera;
                const glm::dvec3 to = drawn.ground().frame.to_local(place) - camera.eye_m;
                const double scale = image.height / 2.0 / std::tan(camera.fov_y_rad / 2);
                const double depth = dot(to, camera.forward);
                const glm::dvec2 at(
                    image.width / 2.0 + scale * dot(to, cross(camera.forward, camera.up)) / depth,
                    image.height / 2.0 - scale * dot(to, camera.up) / depth);
                whole = whole && at.x > 2 && at.y > 2 && at.x < image.width - 2 &&
                        at.y < image.height - 2;
                if (i > 0) length_px += length(at - before);
                before = at;
            }
            if (!whole) continue;
            const double width_px =
                area_px[static_cast<std::size_t>(std::lround(level_m / kInterval_m))] / length_px;
            least = std::min(least, width_px);
            most = std::max(most, width_px);
        }
        fmt::print("[ contours ] {}: lines of {} px are {:.2f} to {:.2f} px wide\n",
                   are_steps ? "height_dx_m" : "ground_dx_m.z", kWidth_px, least, most);
        if (are_steps) {
            EXPECT_GT(least, 0.95 * kWidth_px);
            EXPECT_LT(most, 1.05 * kWidth_px);
        }
    }
}

std::vector<ProgramText> stitched(const std::vector<shader::Snippet>& snippets) {
    shader::StitchInput input;
    input.max_texture_units = 32;
    for (const shader::Snippet& snippet : snippets)
        input.snippets.push_back(&snippet);
    return stitch_frames(shader::FolderTexts(test::source_dir() / "shaders"), input, {}).programs;
}

TEST(HeightSteps, AreNotThereWhereNothingReadsThem) {
    const auto stored = [](const std::string& expression) {
        const TestEffect effect = probe(expression);
        bool any = false;
        for (const ProgramText& program :
             stitched({shader::parse_snippet(effect.id, "probe.glsl", effect.glsl)}))
            for (const shader::TextureUnit& unit : program.stitched.textures)
                any = any || unit.resource == kHeightStepsTexture;
        return any;
    };
    EXPECT_FALSE(stored("s.height_m, s.ground_dx_m.x"));
    EXPECT_TRUE(stored("s.height_dx_m, 0.0"));
    EXPECT_TRUE(stored("0.0, s . height_dy_m"));
    EXPECT_FALSE(stored("0.0 /* s.height_dx_m */, 0.0"));
}

TEST(HeightSteps, NeedRoomBesideTheVaryings) {
    std::string glsl, filled, sum = "0.0";
    for (int i = 0; i < 7; ++i) {
        glsl += fmt::format("out vec4 much_v{};\n", i);
        filled += fmt::format("    much_v{} = vec4(v.height_m);\n", i);
        sum += fmt::format(" + much_v{}.x", i);
    }
    glsl += "void much_on_vertex(in VertexFrame v) {\n" + filled + "}\n";
    glsl +=
        "void much_on_albedo(inout Surface s) { s.diffuse = vec3(" + sum + " + s.height_dx_m); }\n";
    EXPECT_EQ(test::error_of([&] { stitched({shader::parse_snippet("much", "much.glsl", glsl)}); }),
              "exit 3: render: height_dx_m and height_dy_m: expected varyings of up to 24 floats "
              "in addition but got 7 textures of four; switch an effect off");
}

}  // namespace
}  // namespace relevo::render::test_height_steps
