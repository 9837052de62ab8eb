// Shadows that the device computes are those of the processor.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/load.h"
#include "gl/context.h"
#include "light/fields.h"
#include "light/raster/post_loops.h"
#include "render/device_shadows.h"
#include "render/ground.h"
#include "render/ground_light.h"
#include "render/shadow_texels.h"
#include "sun/position.h"
#include "sun/refraction.h"
#include "sun/zone.h"
#include "support/device.h"

namespace relevo::render::test_device_shadows {
namespace {

using light::Clearances;
using light::SunOverDem;
using Part = Clearances::DeviceSweep::Part;

gl::Context& context() {
    static gl::Context context({.device = test::gl_device(), .debug = true});
    context.make_current();
    return context;
}

/// From all sides, from 1 to 70 degrees high, and one that only high ground sees.
std::vector<SunOverDem> suns() {
    std::vector<SunOverDem> suns;
    for (const auto& [azimuth_deg, elevation_deg] :
         {std::pair(37.0, 1.0), std::pair(160.0, 1.5), std::pair(251.0, 2.0), std::pair(333.0, 4.0),
          std::pair(90.0, 8.0), std::pair(200.0, 12.0), std::pair(285.0, 20.0),
          std::pair(15.0, 35.0), std::pair(130.0, 50.0), std::pair(225.0, 70.0),
          std::pair(310.0, -0.6)})
        suns.push_back({radians(azimuth_deg), radians(elevation_deg), sun::semidiameter_rad(1)});
    return suns;
}

struct DiscClearances {
    Array2d<float> upper_m, lower_m;
};

DiscClearances of_processor(const Clearances& clearances, const dem::Grid& grid,
                            const SunOverDem& sun) {
    DiscClearances found{Array2d<float>(grid.columns(), grid.rows()),
                         Array2d<float>(grid.columns(), grid.rows())};
    clearances.each(grid.center(), sun, [&](const light::ClearanceRun& run) {
        std::copy_n(run.upper_m, run.count, &found.upper_m.at(run.column, run.row));
        std::copy_n(run.lower_m, run.count, &found.lower_m.at(run.column, run.row));
    });
    return found;
}

/// A DEM on the device, and textures of its shadows.
class OnDevice {
  public:
    OnDevice(const dem::Heightfield& field, const Clearances& clearances)
        : height_m_(field.height_m),
          clearances_(clearances),
          ground_(clearances.terrain()),
          clearance_(gl::TextureKind::D2, gl::Format::RG16F, size(1), 1, "clearance"),
          fraction_(gl::TextureKind::D2, gl::Format::RG8, size(2), 1, "fraction") {}

    DiscClearances find(const geo::Geodetic& place, const SunOverDem& sun) {
        shadows_.find(clearances_, ground_, place, sun, clearance_, fraction_);
        DiscClearances found{clearance(Part::kUpper), clearance(Part::kLower)};
        const Array2d<float> middle_m = clearance(Part::kMiddle);
        light::straighten(found.upper_m.data(), middle_m.data(), static_cast<int>(middle_m.size()),
                          found.lower_m.data());
        return found;
    }

  private:
    gl::Extent size(int posts) const {
        return {(height_m_.width() + posts - 1) / posts, (height_m_.height() + posts - 1) / posts,
                1};
    }
    Array2d<float> clearance(Part part) const {
        const std::vector<float> shadow_m = ground_.read(part);
        Array2d<float> found(height_m_.width(), height_m_.height());
        light::find_clearances(height_m_.data(), shadow_m.data(), static_cast<int>(found.size()),
                               found.data());
        return found;
    }

    const Array2d<float>& height_m_;
    const Clearances& clearances_;
    DeviceShadows shadows_;
    DeviceShadows::Ground ground_;
    gl::Texture clearance_, fraction_;
};

/// Posts whose figures are more than `most_m` apart, or of which one has none. Pictures know no
/// greater clearances than kMaxClearance_m, and around the Earth there are some of 1e11 m.
int differing(const Array2d<float>& a, const Array2d<float>& b, double most_m, double& worst_m) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float x = a.data()[i], y = b.data()[i];
        if (std::isnan(x) && std::isnan(y)) continue;
        const auto shown_m = [](float clearance_m) {
            return std::clamp(clearance_m, -kMaxClearance_m, kMaxClearance_m);
        };
        const double off_m = std::abs(double{shown_m(x)} - shown_m(y));
        count += !(off_m <= most_m);
        worst_m = std::max(worst_m, off_m);
    }
    return count;
}

void expect_same(const dem::Heightfield& field, const char* name) {
    context();
    const dem::Posts posts(field);
    light::ShadowOptions options;
    options.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    const Clearances clearances(posts, options);
    const double relief_m = double{posts.highest_m()} - posts.lowest_m();
    const double most_m = std::max(0.02, 1e-5 * relief_m);
    OnDevice device(field, clearances);
    const geo::Geodetic place = posts.grid().center();
    double worst_m = 0;
    int shaded = 0;
    for (const SunOverDem& sun : suns()) {
        const DiscClearances expected = of_processor(clearances, posts.grid(), sun),
                             found = device.find(place, sun);
        EXPECT_EQ(differing(expected.upper_m, found.upper_m, most_m, worst_m), 0)
            << name << ", upper limb " << degrees(sun.elevation_rad) << " degrees high";
        EXPECT_EQ(differing(expected.lower_m, found.lower_m, most_m, worst_m), 0)
            << name << ", lower limb " << degrees(sun.elevation_rad) << " degrees high";
        shaded += static_cast<int>(std::count_if(found.upper_m.data(),
                                                 found.upper_m.data() + found.upper_m.size(),
                                                 [](float m) { return m < 0; }));
    }
    EXPECT_GT(shaded, static_cast<int>(field.height_m.size() / 50)) << name;
    test::print_accuracy(std::string("clearances of the device, ") + name, {worst_m}, "m", most_m);
    context().check_errors();
}

/// Hills with voids within and at the edges.
dem::Heightfield hills(int columns, int rows, const dem::Affine& affine, const char* crs) {
    return test::field_of(columns, rows, affine, crs, [](int x, int y) {
        if ((x % 37 == 5 && y % 23 < 3) || x + y < 30) return std::nan("");
        return 900 + 350 * std::sin(0.11 * x) * std::cos(0.07 * y) + 60 * std::sin(0.9 * x + y);
    });
}

TEST(DeviceShadows, AreTheProcessorsOverDegrees) {
    expect_same(test::bundled("jacksboro.tif"), "jacksboro");
}

TEST(DeviceShadows, AreTheProcessorsOverAWideArea) {
    expect_same(test::bundled("vancouver-island.tif"), "vancouver-island");
}

TEST(DeviceShadows, AreTheProcessorsBesideVoids) {
    expect_same(hills(211, 160, {500000, 25, 0, 5200000, 0, -25}, "EPSG:32632"), "voids");
    expect_same(hills(97, 211, {500000, -30, 3, 5200000, 2, 25}, "EPSG:32632"), "turned, mirrored");
}

TEST(DeviceShadows, AreTheProcessorsAcrossTheMeridianWhereColumnsBegin) {
    expect_same(hills(720, 121, {-180, 0.5, 0, 30, 0, -0.5}, "EPSG:4326"), "round the Earth");
}

TEST(DeviceShadows, AreTheProcessorsOverRealGround) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const char* const name :
         {"dem_RGI50-05.08389.tif", "hawaii_rotated20.tif", "HI_topo_04.nc", "SainteHelens.dem"})
        expect_same(dem::load((data / "dem" / name).string()), name);
}

/// The textures as shaders read them.
struct Textures {
    std::vector<float> clearances;
    std::vector<std::vector<std::uint8_t>> fractions;

    explicit Textures(const GroundLight& light) {
        const gl::Texture &clearance = *light.texture("light_clearance"),
                          &fraction = *light.texture("light_fraction");
        const auto texels = [](const gl::Extent& size) {
            return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        };
        clearances.resize(4 * texels(clearance.extent()));
        clearance.read_floats(clearances);
        for (int level = 0; level < fraction.levels(); ++level) {
            fractions.emplace_back(2 * texels(fraction.level_extent(level)));
            fraction.read(level, std::as_writable_bytes(std::span(fractions.back())));
        }
    }
};

/// A half's last digit may differ where a device divides otherwise, and one of 255 steps a level.
void expect_same(const Textures& expected, const Textures& found) {
    int clearances = 0, fractions = 0;
    for (std::size_t i = 0; i < expected.clearances.size(); ++i)
        clearances += !(std::abs(expected.clearances[i] - found.clearances[i]) <=
                        std::max(0.02F, std::abs(expected.clearances[i]) / 1024));
    ASSERT_EQ(expected.fractions.size(), found.fractions.size());
    for (std::size_t level = 0; level < expected.fractions.size(); ++level)
        for (std::size_t i = 0; i < expected.fractions[level].size(); ++i)
            fractions += std::abs(expected.fractions[level][i] - found.fractions[level][i]) > 1;
    EXPECT_EQ(clearances, 0);
    EXPECT_EQ(fractions, 0);
}

SunLight sun_at(const char* utc, const Ground& ground, const dem::Grid& grid) {
    const geo::Geodetic place = grid.center();
    return make_sun_light(sun::position(sun::parse_time(utc).utc, place),
                          sun::Refraction::standard(place), ground, grid);
}

TEST(DeviceShadows, HaveTheTexturesOfTheProcessorAsTheSunMoves) {
    context();
    const dem::Heightfield field = hills(211, 163, {500000, 25, 0, 5200000, 0, -25}, "EPSG:32632");
    const Ground ground = make_ground(field);
    GroundLight device(field, ground.frame, {}, ShadowsOn::Device),
        processor(field, ground.frame, {}, ShadowsOn::Processor);
    // Low, moved twice, night, the same again; then coarser posts and higher ground.
    for (const auto& [utc, on_device] :
         {std::pair("2026-06-21T04:20Z", true), std::pair("2026-06-21T09:00Z", true),
          std::pair("2026-06-21T16:00Z", true), std::pair("2026-06-21T23:30Z", false),
          std::pair("2026-06-21T09:00Z", true)})
        for (const double exaggeration : {1.0, 2.5}) {
            SCOPED_TRACE(utc);
            const SunLight sun = sun_at(utc, ground, field.grid);
            device.update_shadows(sun, exaggeration);
            processor.update_shadows(sun, exaggeration);
            EXPECT_EQ(device.is_computed_on_device(), on_device);
            EXPECT_FALSE(processor.is_computed_on_device());
            expect_same(Textures(processor), Textures(device));
        }
    const SunLight sun = sun_at("2026-06-21T07:00Z", ground, field.grid);
    device.update_shadows(sun, 1, 5);
    processor.update_shadows(sun, 1, 5);
    EXPECT_TRUE(device.is_computed_on_device());
    expect_same(Textures(processor), Textures(device));
    context().check_errors();
}

TEST(DeviceShadows, OfASunWithoutADiscAreTheProcessors) {
    context();
    const dem::Heightfield field = hills(99, 77, {500000, 25, 0, 5200000, 0, -25}, "EPSG:32632");
    const Ground ground = make_ground(field);
    GroundLight device(field, ground.frame, {}, ShadowsOn::Device),
        processor(field, ground.frame, {}, ShadowsOn::Processor);
    SunLight sun = sun_at("2026-06-21T05:00Z", ground, field.grid);
    sun.semidiameter_rad = 0;
    device.update_shadows(sun, 1);
    processor.update_shadows(sun, 1);
    EXPECT_TRUE(device.is_computed_on_device());
    expect_same(Textures(processor), Textures(device));
}

TEST(DeviceShadows, AreTheProcessorsWhereTheDeviceFails) {
    context();
    const dem::Heightfield field = hills(64, 64, {500000, 25, 0, 5200000, 0, -25}, "EPSG:32632");
    const Ground ground = make_ground(field);
    GroundLight device(field, ground.frame, {}, ShadowsOn::Device),
        processor(field, ground.frame, {}, ShadowsOn::Processor);
    ::setenv("RELEVO_SHARE", test::scratch_dir("no-shaders").c_str(), 1);
    testing::internal::CaptureStderr();
    for (const char* const utc : {"2026-06-21T09:00Z", "2026-06-21T10:00Z"}) {
        const SunLight sun = sun_at(utc, ground, field.grid);
        device.update_shadows(sun, 1);
        processor.update_shadows(sun, 1);
        EXPECT_FALSE(device.is_computed_on_device());
        expect_same(Textures(processor), Textures(device));
    }
    ::unsetenv("RELEVO_SHARE");
    const std::string log = testing::internal::GetCapturedStderr();
    const std::string line = "shadows: computed on the processor: ";
    const auto at = log.find(line);
    EXPECT_NE(at, std::string::npos) << log;
    EXPECT_EQ(log.find(line, at + 1), std::string::npos) << log;
}

TEST(DeviceShadows, AreLeftToTheProcessorOnASoftwareDevice) {
    context();
    const dem::Heightfield field = hills(64, 64, {500000, 25, 0, 5200000, 0, -25}, "EPSG:32632");
    const Ground ground = make_ground(field);
    GroundLight light(field, ground.frame);
    light.update_shadows(sun_at("2026-06-21T09:00Z", ground, field.grid), 1);
    EXPECT_FALSE(light.is_computed_on_device());
}

}  // namespace
}  // namespace relevo::render::test_device_shadows
