#include "sky/integrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/units.h"
#include "sky/columns.h"

namespace relevo::sky {
namespace {

/// Share of a species' scattering in harmonics of degree l: by the phase function's moment.
constexpr std::array<float, kDegrees> kRayleighMoments{1, 0, 0.1f, 0, 0};
std::array<float, kDegrees> aerosol_moments(const Coefficients& air) {
    constexpr auto kG = static_cast<float>(kAerosolAsymmetry);
    const float f = air.forward;
    return {1 - f, kG - f, kG * kG - f, kG * kG * kG - f, kG * kG * kG * kG - f};
}

/// One step, as it is for all rays.
struct Step {
    double distance_m = 0, height_m = 0, radius_m = 0;  // of its middle
    double sine = 0;                                    // of the rays' elevation there
    // Light that arrives at the eye, for a radiance of 1 a length that scatters.
    Values rayleigh{}, aerosol{};
};

/// Diffuse light of a height, by the sun: with all that a step does to it. Made where it is asked
/// for.
class Scattered {
  public:
    Scattered(const Coefficients& air, const DiffuseTable& table, const Step& step)
        : aerosol_(aerosol_moments(air)),
          table_(table),
          step_(step),
          row_(DiffuseTable::row_of(step.height_m)),
          harmonics_(step.height_m > kHighestAerosol_m ? kOfAir : kHarmonics) {
        made_.fill(false);
    }

    /// @param cosine  ray_sun_cosine()
    void add(Brought& to, double sun_sine, double cosine) {
        const double sun_level = std::sqrt(std::max(1 - sun_sine * sun_sine, 1e-12));
        const double level = std::sqrt(std::max(1 - step_.sine * step_.sine, 0.0));
        const double across =
            std::clamp((cosine - step_.sine * sun_sine) / sun_level, -level, level);
        const std::array<float, kHarmonics> direction = harmonics(step_.sine, across);
        const DiffuseTable::Place at = DiffuseTable::column_of(sun_sine);
        const auto& a = node(at.first);
        const auto& b = node(at.first + 1);
        for (std::size_t c = 0; c < harmonics_; ++c) {
            const float first = (1 - at.share) * direction[c], second = at.share * direction[c];
            for (std::size_t k = 0; k < kWavelengths; ++k)
                to.air[k] += first * a[c][k] + second * b[c][k];
        }
    }

  private:
    /// Air alone scatters by the harmonics up to the second degree. Above a height of 15 km, 4e-6
    /// of the aerosol is left.
    static constexpr std::size_t kOfAir = 6;
    static constexpr double kHighestAerosol_m = 15e3;

    const std::array<Values, kHarmonics>& node(int column) {
        auto& values = nodes_[static_cast<std::size_t>(column)];
        if (made_[static_cast<std::size_t>(column)]) return values;
        made_[static_cast<std::size_t>(column)] = true;
        const auto& low = table_.at(row_.first, column).moments;
        const auto& high = table_.at(row_.first + 1, column).moments;
        for (std::size_t c = 0; c < harmonics_; ++c) {
            const auto l = static_cast<std::size_t>(kDegree[c]);
            for (std::size_t k = 0; k < kWavelengths; ++k)
                values[c][k] =
                    (low[c][k] + row_.share * (high[c][k] - low[c][k])) *
                    (kRayleighMoments[l] * step_.rayleigh[k] + aerosol_[l] * step_.aerosol[k]);
        }
        return values;
    }

    std::array<float, kDegrees> aerosol_;
    const DiffuseTable& table_;
    const Step& step_;
    DiffuseTable::Place row_;
    std::size_t harmonics_;  // that count
    std::array<std::array<Values, kHarmonics>, DiffuseTable::kSuns> nodes_;
    std::array<bool, DiffuseTable::kSuns> made_;
};

Step step_of(const Coefficients& air, const Rays& rays, double from_m, double to_m,
             Values& through) {
    Step step;
    step.distance_m = 0.5 * (from_m + to_m);
    step.height_m = height_at(rays.height_m, rays.sine, step.distance_m);
    step.radius_m = kEarthRadius_m + step.height_m;
    step.sine =
        std::clamp(((kEarthRadius_m + rays.height_m) * rays.sine + step.distance_m) / step.radius_m,
                   -1.0, 1.0);
    const auto length = static_cast<float>(to_m - from_m);
    // Less that of the top, so that the air does not end at an edge.
    static const double kAtTop = rayleigh_density(kTopOfAir_m);
    const auto gas =
        static_cast<float>(std::max(rayleigh_density(step.height_m) - kAtTop, 0.0)) * length;
    const auto dust = static_cast<float>(aerosol_density(step.height_m)) * length;
    const auto ozone = static_cast<float>(ozone_density(step.height_m)) * length;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        const float by_gas = gas * air.rayleigh[k], by_dust = dust * air.aerosol[k];
        const float depth = by_gas + dust * air.aerosol_taken[k] + ozone * air.ozone[k];
        const float share = passed(depth);
        const float arrives = through[k] * mean_passed(depth, share);
        step.rayleigh[k] = arrives * by_gas;
        step.aerosol[k] = arrives * by_dust * static_cast<float>(kAerosolAlbedo);
        through[k] *= share;
    }
    return step;
}

/// Sine of the sun's elevation at a distance along a ray. @param cosine  ray_sun_cosine()
double local_sun(const Rays& rays, const Sun& sun, double cosine, double distance_m,
                 double radius_m) {
    const double at_eye = (kEarthRadius_m + rays.height_m) * sun.sine;
    return std::clamp((at_eye + distance_m * cosine) / radius_m, -1.0, 1.0);
}

void add_sunlight(const Coefficients& air, const Step& step, double sun_sine, double cosine,
                  Brought& to) {
    const Values light = sunlight(air, air.aerosol_taken, step.height_m, sun_sine);
    const auto phase = static_cast<float>(rayleigh_phase(cosine));
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        to.air[k] += phase * light[k] * step.rayleigh[k];
        to.aerosol[k] += light[k] * step.aerosol[k];
    }
}

void add_ground(const Coefficients& air, const Sources& sources, const Rays& rays, double end_m,
                const Values& through, std::size_t ray, Brought& to) {
    const Sun& at_eye = rays.suns[ray];
    const double sun =
        local_sun(rays, at_eye, ray_sun_cosine(rays.sine, at_eye), end_m, kEarthRadius_m);
    Values light{};
    if (sources.sun && sun > 0) {
        light = sunlight(air, air.aerosol_taken, 0, sun);
        for (float& value : light)
            value *= static_cast<float>(sun);
    }
    if (sources.diffuse) {
        const Values level = sources.diffuse->level(0, sun);
        for (std::size_t k = 0; k < kWavelengths; ++k)
            light[k] += level[k];
    }
    for (std::size_t k = 0; k < kWavelengths; ++k)
        to.ground[k] = through[k] * light[k] * static_cast<float>(1 / kPi);
}

}  // namespace

double ray_sun_cosine(double ray_sine, const Sun& sun) {
    const double level2 = (1 - ray_sine * ray_sine) * (1 - sun.sine * sun.sine);
    return std::clamp(ray_sine * sun.sine + sun.azimuth_cos * std::sqrt(std::max(level2, 0.0)),
                      -1.0, 1.0);
}

Coefficients coefficients(const Air& air) {
    const Extinction full = extinction(air);
    Coefficients made{};
    made.forward = forward_share(air);
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        made.rayleigh[k] = static_cast<float>(full.rayleigh[k]);
        made.aerosol[k] = static_cast<float>(full.aerosol[k]);
        made.ozone[k] = static_cast<float>(full.ozone[k]);
        made.aerosol_taken[k] =
            made.aerosol[k] * (1 - static_cast<float>(kAerosolAlbedo) * made.forward);
    }
    made.albedo = static_cast<float>(air.ground_albedo);
    return made;
}

Values sunlight(const Coefficients& air, const Values& aerosol, double height_m, double sun_sine) {
    const auto share = static_cast<float>(disc_above_horizon(height_m, sun_sine));
    if (share <= 0) return Values{};
    const Column column = Columns::shared().towards(height_m, sun_sine);
    Values light;
    for (std::size_t k = 0; k < kWavelengths; ++k)
        light[k] = share * passed(column.rayleigh_m * air.rayleigh[k] +
                                  column.aerosol_m * aerosol[k] + column.ozone_m * air.ozone[k]);
    return light;
}

void integrate(const Coefficients& air, const Sources& sources, const Rays& rays,
               std::span<const double> ends, bool ground, std::span<Brought> onwards) {
    if (onwards.empty()) return;
    Values through = onwards[0].through;
    std::vector<double> cosines(onwards.size());
    for (std::size_t ray = 0; ray < onwards.size(); ++ray)
        cosines[ray] = ray_sun_cosine(rays.sine, rays.suns[ray]);
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const Step step = step_of(air, rays, ends[i - 1], ends[i], through);
        std::optional<Scattered> scattered;
        if (sources.diffuse) scattered.emplace(air, *sources.diffuse, step);
        for (std::size_t ray = 0; ray < onwards.size(); ++ray) {
            const Sun& sun = rays.suns[ray];
            const double cosine = cosines[ray];
            const double sun_sine = local_sun(rays, sun, cosine, step.distance_m, step.radius_m);
            if (sources.sun) add_sunlight(air, step, sun_sine, cosine, onwards[ray]);
            if (scattered) scattered->add(onwards[ray], sun_sine, cosine);
        }
    }
    for (std::size_t ray = 0; ray < onwards.size(); ++ray) {
        if (ground) add_ground(air, sources, rays, ends.back(), through, ray, onwards[ray]);
        onwards[ray].through = through;
    }
}

}  // namespace relevo::sky
