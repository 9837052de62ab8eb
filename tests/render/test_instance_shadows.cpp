// Shadows of instances: where they lie, how dark they are, that they stay where they are.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "drawn.h"
#include "effect/effect.h"
#include "light/fields.h"
#include "render/instance_sites.h"

namespace relevo::render::test_instance_shadows {
namespace {

using test::Drawn;

constexpr double kSpacing_m = 20, kSite_m = 40;  // of posts, of instances
constexpr double kHeight_m = 20, kHalfWidth_m = 4, kThrough = 0.3;
constexpr double kSun_deg = 30;
constexpr int kCell = 32;  // the one that has an instance
constexpr int kSide_px = 512;
constexpr double kEye_m = 150;           // above the plain
constexpr double kMast_m = 10;           // around the foot, where the instance is in the way
constexpr double kTexel_m = 0.27 / 0.5;  // of the finest map, on the plain along the light

/// One cone on a plain. The sky is dark, so that radiance is the sun's.
effect::Effect cone(const std::string& keys) {
    const std::filesystem::path folder = test::scratch_dir("instance_shadows") / "cone";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "cone.obj") << "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 1 0\n"
                                          "f 1 4 2\nf 2 4 3\nf 3 4 1\n";
    std::ofstream(folder / "plugin.json") << fmt::format(
        R"({{"format": 1, "id": "cone", "name": "C", "version": "1", "instances": {{"cone":
            {{"spacing_m": {}, "height_m": 25, {} "levels": [{{"meshes": ["cone.obj"]}}]}}}}}})",
        kSite_m, keys);
    std::ofstream(folder / "cone.glsl") << fmt::format(
        "void cone_place_cone(in InstanceSite at, inout Instance it) {{\n"
        "    bool here = floor(at.ground.post * {:.3f}) == vec2({}.0);\n"
        "    it.height_m = here ? {:.1f} : 0.0;\n"
        "    it.width_m = {:.1f};\n"
        "    it.taper = 1.0;\n"
        "}}\n"
        "void cone_on_ambient(in Surface s, inout vec3 sky) {{ sky = vec3(0.0); }}\n",
        kSpacing_m / kSite_m, kCell, kHeight_m, 2 * kHalfWidth_m);
    return effect::load_effect(folder, test::source_dir() / "data");
}

/// The plain with the sun in the west-southwest.
struct Plain : Drawn {
    explicit Plain(const std::string& keys)
        : Drawn(test::field_of(129, 129, {500000, kSpacing_m, 0, 5200000, 0, -kSpacing_m},
                               "EPSG:32632", [](int, int) { return 100.0; }),
                {}, kSide_px, kSide_px, 0, {cone(keys)}, {}, {}, {.poison = true}) {
        const glm::dvec2 post = test::site_post(kCell, kCell, kSite_m / kSpacing_m);
        geo::Geodetic place = dem().grid.place(post.x, post.y);
        place.height_m = 100;
        foot_m = ground().frame.to_local(place);
        up = ground().frame.up(place.lat_rad, place.lon_rad);
        shine_from(kSun_deg);
    }

    void shine_from(double elevation_deg) {
        const glm::dvec3 east = normalize(cross(glm::dvec3(0, 1, 0), up)), north = cross(up, east);
        away = normalize(0.9 * east + 0.4 * north);
        frame().sun.direction =
            std::sin(radians(elevation_deg)) * up - std::cos(radians(elevation_deg)) * away;
        frame().sun.refraction_rad = {};
        frame().sun.air = {};
    }

    /// Where a pixel shows the plain, from the foot: away from the sun, and across [m].
    glm::dvec2 at(int x, int y) const {
        const glm::dvec3 ray = this->ray(x + 0.5, y + 0.5), eye = frame().camera.eye_m;
        const double t = dot(foot_m - eye, up) / dot(ray, up);
        const glm::dvec3 off = eye + t * ray - foot_m;
        return {dot(off, away), dot(off, cross(up, away))};
    }

    glm::dvec3 foot_m{}, up{}, away{};
};

/// Outline of a cone's shadow on the plain.
bool is_in_shadow(const glm::dvec2& at) {
    const double tip = kHeight_m / std::tan(radians(kSun_deg)), a = kHalfWidth_m;
    const double tangent = a * a / tip, wide = a * std::sqrt(1 - a * a / (tip * tip));
    return at.x >= tangent && std::abs(at.y) <= wide * (tip - at.x) / (tip - tangent);
}

/// Light of the sun at each pixel, relative to that of the plain.
image::ImageF light_of(Plain& drawn, double column, double row) {
    drawn.stand(column, row, 100 + kEye_m, 0, -90);
    image::ImageF light = drawn.radiance();
    const auto odd = std::ranges::count_if(light.values, [](float v) { return !std::isfinite(v); });
    EXPECT_EQ(odd, 0) << "values of the picture are no numbers, of " << light.values.size();
    EXPECT_GT(light.at(0, 0, 0), 0);
    const float plain = light.at(0, 0, 0);
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x)
            light.row(y)[3 * x] /= plain;
    return light;
}

const std::string kKeys = R"("light_through": 0.3,)";

TEST(InstanceShadows, OfAConeIsItsOutlineOnThePlain) {
    Plain drawn(kKeys);
    const image::ImageF light = light_of(drawn, 0.508, 0.508);
    int inside = 0, outside = 0, wrong = 0;
    double longest_m = 0;
    for (int y = 0; y < kSide_px; ++y) {
        for (int x = 0; x < kSide_px; ++x) {
            const glm::dvec2 at = drawn.at(x, y);
            if (length(at) < kMast_m) continue;
            const double is = light.at(x, y, 0);
            if (is < 0.65) longest_m = std::max(longest_m, at.x);
            // Within two texels of its edge a shadow is soft.
            int shaded = 0;
            for (int i = 0; i < 81; ++i)
                shaded += is_in_shadow(at + 0.5 * kTexel_m * glm::dvec2(i % 9 - 4, i / 9 - 4));
            if (shaded != 0 && shaded != 81) continue;
            ++(shaded ? inside : outside);
            wrong += std::abs(is - (shaded ? kThrough : 1.0)) > 0.005;
        }
    }
    const double tip_m = kHeight_m / std::tan(radians(kSun_deg));
    fmt::print("[ shadow ] {} px inside, {} outside, {} wrong; {:.2f} m long, expected {:.2f}\n",
               inside, outside, wrong, longest_m, tip_m);
    EXPECT_GT(inside, 100);
    EXPECT_GT(outside, 100000);
    EXPECT_EQ(wrong, 0);
    // The tip of a cone is narrower than a texel: half of the light is kept off before it.
    EXPECT_NEAR(longest_m, tip_m, 4 * kTexel_m);
}

/// Middle of the shadow beyond the mast, weighted by the light that it lacks.
glm::dvec2 middle_of(const Plain& drawn, const image::ImageF& light) {
    glm::dvec2 sum(0);
    double weight = 0;
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x) {
            const glm::dvec2 at = drawn.at(x, y);
            if (at.x < 11 || at.x > 40 || std::abs(at.y) > 8) continue;
            const double lacks = 1 - light.at(x, y, 0);
            sum += lacks * at;
            weight += lacks;
        }
    return sum / weight;
}

TEST(InstanceShadows, StayOnTheGroundWhenTheEyeMoves) {
    Plain drawn(kKeys);
    const double pixel_m = kEye_m * 2 * std::tan(radians(Drawn::kFov_deg / 2)) / kSide_px;
    const glm::dvec2 first = middle_of(drawn, light_of(drawn, 0.508, 0.508));
    // 2 m: the maps are kept. 20 m: they are drawn again.
    for (const double moved_m : {2.0, 5.0, 20.0, 33.0}) {
        const double share = 0.508 + moved_m / (128 * kSpacing_m);
        const glm::dvec2 here = middle_of(drawn, light_of(drawn, share, 0.508));
        fmt::print("[ shadow ] eye moved by {:.0f} m: shadow by {:.3f} {:.3f} m\n", moved_m,
                   here.x - first.x, here.y - first.y);
        EXPECT_LT(length(here - first), pixel_m);
    }
}

/// Triangles and points that a frame draws.
GLuint primitives_of(Plain& drawn) {
    GLuint query = 0, count = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_PRIMITIVES_GENERATED, query);
    drawn.radiance();
    glEndQuery(GL_PRIMITIVES_GENERATED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
    glDeleteQueries(1, &query);
    return count;
}

TEST(InstanceShadows, AreDrawnOnceInAFirstFrame) {
    Plain drawn(kKeys);
    drawn.stand(0.508, 0.508, 100 + kEye_m, 0, -90);
    const GLuint first = primitives_of(drawn), kept = primitives_of(drawn);
    drawn.frame().unix_s += 86400;  // instances may change from day to day
    const GLuint again = primitives_of(drawn);
    fmt::print("[ shadow ] {} primitives at first, {} with maps that are kept\n", first, kept);
    EXPECT_GT(first, kept);
    EXPECT_EQ(first, again);
}

TEST(InstanceShadows, AreThoseOfTheFirstRendererInTheNextOnes) {
    // Of a driver that loses a draw the picture is black, or is that of an earlier renderer.
    std::vector<float> expected;
    for (int renderer = 0; renderer < 4; ++renderer) {
        Plain drawn(kKeys);
        drawn.stand(0.508, 0.508, 100 + kEye_m, 0, -90);
        const image::ImageF light = drawn.radiance();
        if (renderer == 0) expected = light.values;
        EXPECT_EQ(light.values, expected) << renderer;
    }
}

TEST(InstanceShadows, AreNoneWhereThePluginSaysSo) {
    Plain drawn(R"("casts_shadow": false,)");
    const image::ImageF light = light_of(drawn, 0.508, 0.508);
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x)
            if (length(drawn.at(x, y)) > kMast_m) {
                ASSERT_NEAR(light.at(x, y, 0), 1, 0.005);
            }
}

TEST(InstanceShadows, MoveWithTheSun) {
    Plain drawn(kKeys);
    light_of(drawn, 0.508, 0.508);
    drawn.shine_from(60);
    const image::ImageF light = light_of(drawn, 0.508, 0.508);
    double longest_m = 0;
    for (int y = 0; y < kSide_px; ++y)
        for (int x = 0; x < kSide_px; ++x)
            if (light.at(x, y, 0) < 0.65) longest_m = std::max(longest_m, drawn.at(x, y).x);
    EXPECT_NEAR(longest_m, kHeight_m / std::tan(radians(60)), 4 * kTexel_m);
}

}  // namespace
}  // namespace relevo::render::test_instance_shadows
