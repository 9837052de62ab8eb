// Decks from rasters: cover and optical depth by place.
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "light/fields.h"
#include "render/drawn.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_cloud_fields {
namespace {

/// A field of columns as wide as `step_m` around the DEM's centre, each of one value.
render::Field columns_of(const std::vector<float>& values, double step_m) {
    render::Field field;
    const int count = static_cast<int>(values.size());
    field.around.values = Array2d<float>(count, 2);
    for (int column = 0; column < count; ++column)
        for (int row = 0; row < 2; ++row)
            field.around.values.at(column, row) = values[static_cast<std::size_t>(column)];
    field.around.step_m = {step_m, 1e6};
    field.around.first_m = {-0.5 * step_m * (count - 1), -5e5};
    for (const float value : values) {
        field.mean += value / static_cast<float>(count);
        field.most = std::max(field.most, value);
    }
    return field;
}

/// Has a plugin's functions read a field of a deck, as a renderer does.
class WithField {
  public:
    WithField(test::GpuSnippet& gpu, const std::string& name, render::Field field) {
        const std::string resource = "clouds." + name;
        fields_.set({{resource, std::make_shared<const render::Field>(std::move(field))}});
        const auto write = [&](const std::string& what, const glm::vec4& to) {
            gpu.values().write_host(resource + what, {to.x, to.y, to.z, to.w});
        };
        write("_place", fields_.place(resource).place);
        write("_shape", fields_.place(resource).shape);
        gpu.bind("clouds_" + name + "_texels", *fields_.texture(resource + "_texels"));
    }

  private:
    render::Fields fields_;
};

/// Share of a square of 60 km that has cloud, around a place east of the centre; of some seeds.
double covered(test::GpuSnippet& gpu, double east_m) {
    constexpr int kSide = 128, kSeeds = 20;
    double sum = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
        gpu.values().set("clouds.seed", fmt::format("{}", seed));
        for (const glm::vec4& one :
             gpu.run(fmt::format(
                         "vec2 at = vec2({:.1f}, 0.0) + 60000.0 * (vec2(x, y) / {:.1f} - 0.5);\n"
                         "result = vec4(clouds_thickness(0, at));",
                         east_m, double{kSide}),
                     kSide, kSide))
            sum += one.x > 0;
    }
    return sum / (kSide * kSide * kSeeds);
}

TEST(CloudFields, CoverIsWhatTheRasterHasAtEachPlace) {
    test::GpuSnippet gpu("clouds");
    gpu.values().set("clouds.cover_1", "0.9");
    const WithField field(gpu, "covers_1", columns_of({0, 0, 0.3F, 0.3F, 0.7F, 0.7F, 1, 1}, 1e5));
    EXPECT_EQ(covered(gpu, -300'000), 0);
    EXPECT_NEAR(covered(gpu, -100'000), 0.3, 0.02);
    EXPECT_NEAR(covered(gpu, 100'000), 0.7, 0.02);
    EXPECT_GT(covered(gpu, 300'000), 0.999);
    EXPECT_NEAR(covered(gpu, 600'000), 0.5, 0.02);  // beyond: the mean over the DEM
}

TEST(CloudFields, OpticalDepthIsTheRasters) {
    test::GpuSnippet gpu("clouds");
    const WithField field(gpu, "depths_1", columns_of({0, 0, 40, 40}, 1e5));
    for (const char* const kind : {"cumulus", "stratus", "cirrus"}) {
        gpu.values().set("clouds.kind_1", kind);
        double worst = 0;
        const auto found = gpu.run(
            "float share = clouds_thickness(0, vec2(1000.0 * float(x) - 100000.0, 0.0));\n"
            "result = vec4(clouds_tau(clouds_deck(0), clamp(share, 0.0, 1.0), 0.1 * float(y)), "
            "share, 0.0, 0.0);",
            201, 11);
        for (int y = 0; y < 11; ++y)
            for (int x = 0; x < 201; ++x) {
                // Linear from 0 at -50 km to 40 at 50 km, whatever varies in a deck of noise.
                const double expected = 40 * std::clamp((x - 50) / 100.0, 0.0, 1.0);
                worst = std::max(
                    worst, std::abs(found[static_cast<std::size_t>(y * 201 + x)].x - expected));
            }
        fmt::print("[ accuracy ] optical depth of a raster, {}: worst {:.2g} of 40\n", kind, worst);
        EXPECT_LT(worst, 0.01) << kind;
        // Lumps widen clouds by up to 0.35 of a share: none where the raster has nothing.
        EXPECT_LT(found[0].y, -0.35F) << kind;
    }
}

/// Radiance of a white plain below a deck, in multiples of the sun's light on it without one.
glm::dvec2 plain_below(const std::vector<std::pair<std::string, std::string>>& settings,
                       const std::function<void(test::Drawn&)>& prepare) {
    const auto plain = test::field_of(65, 65, {480000, 30, 0, 5400000, 0, -30}, "EPSG:32632",
                                      [](int, int row) { return 500.0 + 1e-3 * (row % 2); });
    const test::TestEffect probe{
        "probe",
        "void probe_on_material(inout Surface s) {\n"
        "    s.normal = s.up;\n"
        "    s.diffuse = s.ambient = vec3(1.0);\n"
        "    s.specular = vec3(0.0);\n"
        "}\n"
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    float sun = frame.sun_light[0].r * frame.sun_apparent.z;\n"
        "    radiance = vec3(radiance.r / sun, 0.0, 1.0) / frame.exposure;\n"
        "}\n"};
    const auto clouds = effect::load_effect(test::source_dir() / "plugins/clouds", {});
    test::Drawn drawn(plain, {probe}, 64, 64, 0, {clouds}, settings);
    prepare(drawn);
    drawn.shine("2026-06-21T11:00Z");
    drawn.stand(0.5, 0.5, 1200, 0, -89);
    return test::Drawn::values(drawn.radiance(), 32, 32);
}

TEST(CloudFields, GroundBelowARasterOfOneDepthIsLitAsBelowThatDeck) {
    const std::vector<std::pair<std::string, std::string>> deck = {
        {"clouds.kind_1", "stratus"}, {"clouds.base_1_m", "3000"}, {"clouds.top_1_m", "3500"}};
    for (const float tau : {0.5F, 8.0F}) {
        auto of_noise = deck;
        of_noise.insert(of_noise.end(), {{"clouds.cover_1", "1"},
                                         {"clouds.variation", "0"},
                                         {"clouds.depth_1", fmt::format("{}", tau)}});
        const double expected = plain_below(of_noise, [](test::Drawn&) {}).x;
        const double found = plain_below(deck, [&](test::Drawn& drawn) {
                                 drawn.set_field("clouds.depths_1", columns_of({tau, tau}, 4e5));
                             }).x;
        EXPECT_NEAR(found, expected, 2e-3 * expected) << tau;
    }
}

TEST(CloudFields, ADeckWithoutCoverLetsAllLightThrough) {
    const auto nothing = [](test::Drawn&) {};
    const double clear = plain_below({{"clouds.cover_1", "0"}}, nothing).x;
    for (const char* const name : {"clouds.covers_1", "clouds.depths_1"})
        EXPECT_NEAR(plain_below({{"clouds.cover_1", "1"}},
                                [&](test::Drawn& drawn) {
                                    drawn.set_field(name, columns_of({0, 0}, 4e5));
                                })
                        .x,
                    clear, 1e-3 * clear)
            << name;
}

}  // namespace
}  // namespace relevo::test_cloud_fields
