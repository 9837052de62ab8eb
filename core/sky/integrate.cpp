#include "sky/integrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

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

/// Adds a * light_a + b * light_b.
void add(float a, const Values& light_a, float b, const Values& light_b, Values& to) {
    for (std::size_t k = 0; k < kWavelengths; ++k)
        to[k] += a * light_a[k] + b * light_b[k];
}
void add(float a, const glm::vec4& light_a, float b, const glm::vec4& light_b, glm::vec4& to) {
    to += a * light_a + b * light_b;
}

void assign(const Values& light, Values& to) {
    to = light;
}
void assign(const Values& light, glm::vec4& to) {
    to = colour(light);
}

/// Diffuse light of a height, by the sun: with all that a step does to it. Made where it is asked
/// for.
template <class Light>
class Scattered {
  public:
    Scattered(const Coefficients& air, const DiffuseTable& table, const Step& step)
        : aerosol_(aerosol_moments(air)),
          table_(table),
          step_(step),
          row_(DiffuseTable::row_of(step.height_m)),
          harmonics_(step.height_m > kHighestAerosol_m ? kOfAir : kHarmonics),
          powers_(harmonic_powers(step.sine)) {
        made_.fill(false);
    }

    /// @param cosine  ray_sun_cosine()
    void add_to(BroughtAs<Light>& to, double sun_sine, double cosine) {
        const double sun_level = std::sqrt(std::max(1 - sun_sine * sun_sine, 1e-12));
        const double level = std::sqrt(std::max(1 - step_.sine * step_.sine, 0.0));
        const double across =
            std::clamp((cosine - step_.sine * sun_sine) / sun_level, -level, level);
        const DiffuseTable::Place at = DiffuseTable::column_of(sun_sine);
        const auto& a = node(at.first);
        const auto& b = node(at.first + 1);
        float power = 1;
        for (std::size_t p = 0; p < kPowers; ++p) {
            add((1 - at.share) * power, a[p], at.share * power, b[p], to.air);
            power *= static_cast<float>(across);
        }
    }

  private:
    /// Air alone scatters by the harmonics up to the second degree. Above a height of 15 km, 4e-6
    /// of the aerosol is left.
    static constexpr std::size_t kOfAir = 6;
    static constexpr double kHighestAerosol_m = 15e3;

    /// Light of the harmonics together, by power of `across`.
    const std::array<Light, kPowers>& node(int column) {
        auto& values = nodes_[static_cast<std::size_t>(column)];
        if (made_[static_cast<std::size_t>(column)]) return values;
        made_[static_cast<std::size_t>(column)] = true;
        const auto& low = table_.at(row_.first, column).moments;
        const auto& high = table_.at(row_.first + 1, column).moments;
        std::array<Values, kPowers> sums{};
        for (std::size_t c = 0; c < harmonics_; ++c) {
            const auto l = static_cast<std::size_t>(kDegree[c]);
            Values light;
            for (std::size_t k = 0; k < kWavelengths; ++k)
                light[k] =
                    (low[c][k] + row_.share * (high[c][k] - low[c][k])) *
                    (kRayleighMoments[l] * step_.rayleigh[k] + aerosol_[l] * step_.aerosol[k]);
            for (std::size_t p = 0; p < kPowers; ++p)
                if (powers_[c][p] != 0)
                    for (std::size_t k = 0; k < kWavelengths; ++k)
                        sums[p][k] += powers_[c][p] * light[k];
        }
        for (std::size_t p = 0; p < kPowers; ++p)
            assign(sums[p], values[p]);
        return values;
    }

    std::array<float, kDegrees> aerosol_;
    const DiffuseTable& table_;
    const Step& step_;
    DiffuseTable::Place row_;
    std::size_t harmonics_;  // that count
    HarmonicPowers powers_;
    std::array<std::array<Light, kPowers>, DiffuseTable::kSuns> nodes_;
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

/// Sunlight that a step scatters, without phase functions.
template <class Light>
struct Sunlit {
    Light air, aerosol;

    Sunlit() = default;
    Sunlit(const Coefficients& coefficients, const Step& step, double sun_sine) {
        const Values light =
            sunlight(coefficients, coefficients.aerosol_taken, step.height_m, sun_sine);
        Values by_air, by_aerosol;
        for (std::size_t k = 0; k < kWavelengths; ++k) {
            by_air[k] = light[k] * step.rayleigh[k];
            by_aerosol[k] = light[k] * step.aerosol[k];
        }
        assign(by_air, air);
        assign(by_aerosol, aerosol);
    }
};

/// Sunlit by the sine of the sun's elevation, which differs little among the rays of a step: as
/// spectra for each ray, as colours between a few sines where the whole disc is up.
template <class Light>
class SunlitRays {
  public:
    SunlitRays(const Coefficients& air, const Step& step, std::span<const double> sun_sines)
        : air_(air), step_(step) {
        if (std::is_same_v<Light, Values>) return;
        const auto [lowest, highest] = std::ranges::minmax(sun_sines);
        if (disc_above_horizon(step.height_m, lowest) < 1) return;
        const Sunlit<Light> first(air, step, lowest), last(air, step, highest);
        // A line between two sines is off by an eighth of the square of the logarithm's change.
        constexpr float kChange = 0.09f;
        const float change = std::abs(std::log(blue(last) / std::max(blue(first), 1e-30f)));
        // Light changes most at the lowest sines.
        const float intervals = std::ceil(2 * change / kChange);
        if (!(intervals <= static_cast<float>(kMost))) return;
        count_ = std::max(static_cast<int>(intervals), 1);
        lowest_ = lowest;
        per_sine_ = count_ / std::max(highest - lowest, 1e-12);
        nodes_[0] = first;
        for (int i = 1; i < count_; ++i)
            nodes_[static_cast<std::size_t>(i)] = Sunlit<Light>(air, step, lowest + i / per_sine_);
        nodes_[static_cast<std::size_t>(count_)] = last;
    }

    void add_to(BroughtAs<Light>& to, double sun_sine, double cosine) const {
        const auto phase = static_cast<float>(rayleigh_phase(cosine));
        if (count_ == 0) {
            const Sunlit<Light> here(air_, step_, sun_sine);
            add(phase, here.air, 0, here.air, to.air);
            add(1, here.aerosol, 0, here.aerosol, to.aerosol);
            return;
        }
        const double at = (sun_sine - lowest_) * per_sine_;
        const int first = std::clamp(static_cast<int>(at), 0, count_ - 1);
        const auto share = static_cast<float>(at - first);
        const Sunlit<Light>*const a = &nodes_[static_cast<std::size_t>(first)], *const b = a + 1;
        add(phase * (1 - share), a->air, phase * share, b->air, to.air);
        add(1 - share, a->aerosol, share, b->aerosol, to.aerosol);
    }

  private:
    static constexpr int kMost = 8;  // intervals, with fewer than rays

    static float blue(const Sunlit<Light>& light) { return light.air[2]; }

    const Coefficients& air_;
    const Step& step_;
    int count_ = 0;  // of intervals; 0: none
    double lowest_ = 0, per_sine_ = 0;
    std::array<Sunlit<Light>, kMost + 1> nodes_;
};

template <class Light>
void add_ground(const Coefficients& air, const Sources& sources, const Rays& rays, double end_m,
                const Values& through, std::size_t ray, BroughtAs<Light>& to) {
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
        light[k] *= through[k] * static_cast<float>(1 / kPi);
    assign(light, to.ground);
}

template <class Light>
void follow(const Coefficients& air, const Sources& sources, const Rays& rays,
            std::span<const double> ends, bool ground, std::span<BroughtAs<Light>> onwards) {
    if (onwards.empty()) return;
    Values through = onwards[0].through;
    std::vector<double> cosines(onwards.size()), sun_sines(onwards.size());
    for (std::size_t ray = 0; ray < onwards.size(); ++ray)
        cosines[ray] = ray_sun_cosine(rays.sine, rays.suns[ray]);
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const Step step = step_of(air, rays, ends[i - 1], ends[i], through);
        for (std::size_t ray = 0; ray < onwards.size(); ++ray)
            sun_sines[ray] =
                local_sun(rays, rays.suns[ray], cosines[ray], step.distance_m, step.radius_m);
        std::optional<SunlitRays<Light>> sunlit;
        if (sources.sun) sunlit.emplace(air, step, sun_sines);
        std::optional<Scattered<Light>> scattered;
        if (sources.diffuse) scattered.emplace(air, *sources.diffuse, step);
        for (std::size_t ray = 0; ray < onwards.size(); ++ray) {
            if (sunlit) sunlit->add_to(onwards[ray], sun_sines[ray], cosines[ray]);
            if (scattered) scattered->add_to(onwards[ray], sun_sines[ray], cosines[ray]);
        }
    }
    for (std::size_t ray = 0; ray < onwards.size(); ++ray) {
        if (ground) add_ground(air, sources, rays, ends.back(), through, ray, onwards[ray]);
        onwards[ray].through = through;
    }
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

glm::vec4 colour(const Values& light) {
    static const std::array<glm::vec4, kWavelengths> kWeights = [] {
        std::array<glm::vec4, kWavelengths> weights{};
        for (std::size_t k = 0; k < kWavelengths; ++k) {
            Spectrum one{};
            one[k] = 1;
            weights[k] = glm::vec4(glm::vec3(colour_of(one)), 0);
        }
        return weights;
    }();
    glm::vec4 sum(0);
    for (std::size_t k = 0; k < kWavelengths; ++k)
        sum += light[k] * kWeights[k];
    return sum;
}

void integrate(const Coefficients& air, const Sources& sources, const Rays& rays,
               std::span<const double> ends, bool ground, std::span<Brought> onwards) {
    follow(air, sources, rays, ends, ground, onwards);
}

void integrate(const Coefficients& air, const Sources& sources, const Rays& rays,
               std::span<const double> ends, bool ground, std::span<BroughtColour> onwards) {
    follow(air, sources, rays, ends, ground, onwards);
}

}  // namespace relevo::sky
