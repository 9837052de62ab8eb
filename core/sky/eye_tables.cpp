#include "sky/eye_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "base/parallel_for.h"
#include "base/units.h"
#include "sky/night.h"
#include "sky/path.h"

namespace relevo::sky {
namespace {

/// Steps along rays. From high up, rays pass the Earth's shadow far away, where steps are long.
int view_steps(double height_m) {
    return 24 + static_cast<int>(48 * std::clamp(height_m / 40e3, 0.0, 1.0));
}

std::vector<Sun> suns_around(int azimuths, double sun_sine) {
    std::vector<Sun> suns;
    for (int i = 0; i < azimuths; ++i)
        suns.push_back({sun_sine, EyeLayout::azimuth_cos(i / (azimuths - 1.0))});
    return suns;
}

/// One row of the sky.
void write_row(const Atmosphere& air, const EyeLayout& layout, int row, std::span<const Sun> suns,
               std::vector<glm::vec4>& to) {
    const bool above = row < EyeLayout::kAbove;
    const double v = above ? row / (EyeLayout::kAbove - 1.0)
                           : (row - EyeLayout::kAbove) / (EyeLayout::kBelow - 1.0);
    // A hair off the horizon, on the side that is meant.
    const double sine = above ? std::max(layout.sine_above(v), layout.horizon + 1e-9)
                              : std::min(layout.sine_below(v), layout.horizon - 1e-9);
    const Path path = path_of(layout.height_m, sine);
    std::vector<BroughtColour> brought(suns.size(), BroughtColour{.through = filled(1)});
    integrate(air.coefficients(), {.sun = true, .diffuse = &air.diffuse()},
              {layout.height_m, sine, suns}, step_ends(path, view_steps(layout.height_m)),
              path.ground, brought);
    const glm::vec3 through(colour(brought.front().through));
    const glm::vec3 night(night_radiance(layout.height_m, sine, double{through.g}));
    const glm::vec3 ground = path.ground ? glm::vec3(night_irradiance()) * through : glm::vec3(0);
    constexpr int kRows = EyeLayout::kAbove + EyeLayout::kBelow;
    const auto pi = static_cast<float>(kPi);
    for (int i = 0; i < EyeLayout::kAzimuths; ++i) {
        const auto at = static_cast<std::size_t>(row * EyeLayout::kAzimuths + i);
        constexpr auto kLayer = static_cast<std::size_t>(kRows * EyeLayout::kAzimuths);
        const BroughtColour& one = brought[static_cast<std::size_t>(i)];
        to[at] = pi * one.air + glm::vec4(night, 0);
        to[kLayer + at] = pi * one.aerosol;
        to[2 * kLayer + at] = pi * one.ground + glm::vec4(ground, 0);
    }
}

/// Air between, in all directions of one elevation.
class Between {
  public:
    Between(const Atmosphere& air, const EyeLayout& layout, const glm::vec3& extinction,
            std::span<const Sun> suns)
        : air_(air), layout_(layout), extinction_(extinction), suns_(suns) {}

    void write(int row, std::vector<glm::vec4>& to) const {
        const double sine = layout_.sine_between(row / (EyeLayout::kBetweenElevations - 1.0));
        // The ground does not end the rays: DEMs have ground below the sea, too.
        const double begin = path_of(layout_.height_m, sine).begin_m;
        const Sources once{.sun = true}, further{.sun = false, .diffuse = &air_.diffuse()};
        std::vector<BroughtColour> sunlight(suns_.size(), BroughtColour{.through = filled(1)});
        std::vector<BroughtColour> diffuse = sunlight;
        double before = 0;
        for (int slice = 0; slice < EyeLayout::kDistances; ++slice) {
            const double distance =
                std::max(layout_.distance_m(slice / (EyeLayout::kDistances - 1.0), sine), 10.0);
            const std::array<double, 3> ends{begin + before, begin + 0.5 * (before + distance),
                                             begin + distance};
            const Rays rays{layout_.height_m, sine, suns_};
            integrate(air_.coefficients(), once, rays, ends, false, sunlight);
            integrate(air_.coefficients(), further, rays, ends, false, diffuse);
            before = distance;
            for (std::size_t i = 0; i < suns_.size(); ++i) {
                to[at(0, slice, row) + i] =
                    texel(diffuse[i], sine, suns_[i], distance) +
                    glm::vec4(night_scattered(sine) * night_irradiance(), 0);
                to[at(1, slice, row) + i] = texel(sunlight[i], sine, suns_[i], distance);
            }
        }
    }

  private:
    std::size_t at(int order, int slice, int row) const {
        return static_cast<std::size_t>(
                   (order * EyeLayout::kDistances + slice) * EyeLayout::kBetweenElevations + row) *
               suns_.size();
    }

    glm::vec4 texel(const BroughtColour& brought, double sine, const Sun& sun,
                    double distance) const {
        const auto phase = static_cast<float>(aerosol_phase(ray_sun_cosine(sine, sun)));
        const glm::vec3 scattered =
            static_cast<float>(kPi) * glm::vec3(brought.air + phase * brought.aerosol);
        const double through = std::clamp<double>(colour(brought.through).g, 1e-20, 1.0);
        const auto depth = static_cast<float>(std::max(-std::log(through), 1e-9));
        const glm::vec3 taken(-std::expm1(-depth * extinction_.r),
                              -std::expm1(-depth * extinction_.g),
                              -std::expm1(-depth * extinction_.b));
        return {scattered / taken, depth / static_cast<float>(distance)};
    }

    const Atmosphere& air_;
    const EyeLayout& layout_;
    glm::vec3 extinction_;
    std::span<const Sun> suns_;
};

/// Extinction of colours relative to that of green, on the way to the horizon, where half of the
/// green light is left.
glm::vec3 extinction_colour(const Atmosphere& air, const EyeLayout& layout) {
    const auto passed = [&](double distance_m) {
        return colour_of(air.transmittance(layout.height_m, layout.horizon, distance_m));
    };
    double near_m = 1000, far_m = 4e6;
    for (int i = 0; i < 24; ++i) {
        const double middle_m = std::sqrt(near_m * far_m);
        (passed(middle_m).g > 0.5 ? near_m : far_m) = middle_m;
    }
    const glm::dvec3 seen = glm::clamp(passed(near_m), 1e-6, 1 - 1e-9);
    return glm::vec3(glm::log(seen) / std::log(seen.g));
}

/// The inverse of EyeLayout::place_of(), by bisection.
double away_of(double place, double band) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (EyeLayout::place_of(middle, band) < place ? low : high) = middle;
    }
    return place >= 1 ? 1 : low;
}

}  // namespace

EyeLayout::EyeLayout(double eye_height_m)
    : height_m(std::max(eye_height_m, 0.0)), horizon(horizon_sine(height_m)) {
    constexpr double kAir_m = 8000;  // scale height
    const double to_horizon_m = -horizon * (kEarthRadius_m + height_m);
    above_band = std::clamp(4 * kAir_m / std::max(to_horizon_m, 1.0), 0.012, 0.5);
    below_band = std::max(-5 * horizon, 0.002);
    // A little above the ground, so that the way to it is not 0.
    const double level = std::min(horizon, horizon_sine(1));
    horizon_m = -level * (kEarthRadius_m + height_m) - path_of(height_m, level).begin_m;
    farthest_m = horizon_m + (height_m < kHigh_m ? 350e3 : 0);
}

double EyeLayout::reach_m(double sine) const {
    if (sine >= horizon) return farthest_m;
    const Path path = path_of(std::max(height_m, 1.0), sine);
    const double to_ground_m = path.ground ? path.end_m - path.begin_m : horizon_m;
    return to_ground_m * farthest_m / horizon_m;
}

double EyeLayout::distance_m(double w, double sine) const {
    return reach_m(sine) * (height_m < kHigh_m ? w * w : 1 - (1 - w) * (1 - w));
}

double EyeLayout::place_of(double away, double band) {
    return kEven * away + (1 - kEven) * std::sqrt(away * (1 + band) / (away + band));
}

double EyeLayout::sine_above(double v) const {
    return std::min(horizon + (1 - horizon) * away_of(v, above_band), 1.0);
}

double EyeLayout::sine_below(double v) const {
    return std::max(horizon - (1 + horizon) * away_of(v, below_band), -1.0);
}

double EyeLayout::sine_between(double v) const {
    return v > 0.5 ? sine_above(2 * v - 1) : sine_below(1 - 2 * v);
}

EyeTables eye_tables(const Atmosphere& air, double height_m, double sun_sine,
                     const EyeParts& parts) {
    EyeTables made{.layout = EyeLayout(height_m), .sky = {}, .between = {}, .colour = {}};
    made.colour = extinction_colour(air, made.layout);
    const int rows = parts.sky ? EyeLayout::kAbove + EyeLayout::kBelow : 0;
    const int between_rows = parts.between ? EyeLayout::kBetweenElevations : 0;
    made.sky.resize(static_cast<std::size_t>(EyeLayout::kAzimuths * rows * EyeLayout::kLayers));
    made.between.resize(static_cast<std::size_t>(EyeLayout::kBetweenAzimuths * between_rows *
                                                 EyeLayout::kDistances * EyeTables::kOrders));
    const std::vector<Sun> around = suns_around(EyeLayout::kAzimuths, sun_sine);
    const std::vector<Sun> between_around = suns_around(EyeLayout::kBetweenAzimuths, sun_sine);
    const Between between(air, made.layout, made.colour, between_around);
    parallel_for(0, rows + between_rows, 1, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            if (row < rows)
                write_row(air, made.layout, row, around, made.sky);
            else
                between.write(row - rows, made.between);
        }
    });
    return made;
}

double nearest_eye_height_m(double height_m) {
    constexpr double kBase_m = 100, kStep = 0.005;
    const double steps = std::round(std::log1p(std::max(height_m, 0.0) / kBase_m) / kStep);
    return kBase_m * std::expm1(kStep * steps);
}

double nearest_sun_sine(double sine) {
    constexpr double kStep = 1e-4;
    return kStep * std::round(sine / kStep);
}

}  // namespace relevo::sky
