#include "path_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"
#include "chord.h"

namespace relevo::skymaker {
namespace {

using sky::kEarthRadius_m;
using sky::kWavelengths;

/// Directions that are drawn towards the horizon under a low sun: a wide lobe, and a narrow one for
/// dusk, when the only sunlit air is far away.
struct Lobe {
    double share, asymmetry;
};
constexpr std::array<Lobe, 2> kLobes{Lobe{0.45, 0.7}, Lobe{0.55, 0.93}};
constexpr int kHeights = 32, kSuns = 64;  // of the table of brightness
/// The wavelengths that free paths are drawn for.
constexpr std::array<std::size_t, 4> kDrawn{0, 5, 10, 15};

/// S. Vigna's splitmix64, in [0, 1).
double next(std::uint64_t& state) {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// The direction at an angle from an axis.
glm::dvec3 around(const glm::dvec3& axis, double cosine, double azimuth_rad) {
    const glm::dvec3 other = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return cosine * axis + sine * (std::cos(azimuth_rad) * u + std::sin(azimuth_rad) * v);
}

glm::dvec3 cosine_weighted(const glm::dvec3& up, std::uint64_t& random) {
    return around(up, std::sqrt(1 - next(random)), 2 * kPi * next(random));
}

double draw_henyey_greenstein(double g, double u) {
    if (g == 0) return 1 - 2 * u;
    const double s = (1 - g * g) / (1 - g + 2 * g * u);
    return std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
}

double draw_rayleigh(double u) {
    const double z = 2 * (2 * u - 1);
    const double w = std::cbrt(z + std::sqrt(z * z + 1));
    return std::clamp(w - 1 / w, -1.0, 1.0);
}

double optical_depth(const sky::Extinction& e, const Columns& c, std::size_t k) {
    return c.rayleigh_m * e.rayleigh[k] + c.aerosol_m * e.aerosol[k] + c.ozone_m * e.ozone[k];
}

void pass(Spectrum& through, const sky::Extinction& e, const Columns& c, double factor) {
    for (std::size_t k = 0; k < kWavelengths; ++k)
        through[k] *= factor * std::exp(-optical_depth(e, c, k));
}

double edge_sine(double height_m) {
    const double cosine = kEarthRadius_m / (kEarthRadius_m + height_m);
    return -std::sqrt(1 - cosine * cosine);
}

glm::dvec3 direction_of(double elevation_rad, double azimuth_rad) {
    return {std::cos(elevation_rad) * std::cos(azimuth_rad),
            std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

glm::dvec3 eye_at(double height_m) {
    return {0, 0, kEarthRadius_m + height_m};
}

double largest(const Spectrum& s) {
    return *std::max_element(s.begin(), s.end());
}

}  // namespace

/// A path on its way back from the eye.
struct PathIntegral::Path {
    glm::dvec3 at{}, direction{}, sun{};
    Spectrum weight{};
    std::uint64_t random = 0;
    double first = 0;        // random number of the first step, stratified; then negative
    double last_weight = 1;  // largest, after the last scattering
    bool on_ground = false, lost = false;
};

Medium medium_of(const sky::Air& air) {
    return {.extinction = sky::extinction(air), .ground_albedo = air.ground_albedo};
}

Spectrum mean(const Batches& batches) {
    Spectrum sum{};
    for (const Spectrum& batch : batches)
        for (std::size_t k = 0; k < kWavelengths; ++k)
            sum[k] += batch[k] / static_cast<double>(batches.size());
    return sum;
}

Figure figure(const Batches& batches, const std::function<double(const Spectrum&)>& of) {
    const double n = static_cast<double>(batches.size());
    double sum = 0, squares = 0;
    for (const Spectrum& batch : batches)
        sum += of(batch) / n;
    for (const Spectrum& batch : batches)
        squares += std::pow(of(batch) - sum, 2);
    return {of(mean(batches)), std::sqrt(squares / (n * (n - 1)))};
}

PathIntegral::PathIntegral(const Medium& medium, double sun_elevation_rad, double sun_radius_rad)
    : medium_(medium),
      sun_(direction_of(sun_elevation_rad, 0)),
      sun_cap_(1 - std::cos(sun_radius_rad)) {
    lobe_ = 0.6 * std::clamp((10 - degrees(sun_elevation_rad)) / 14, 0.0, 1.0);
    tabulate_brightness();
}

void PathIntegral::tabulate_brightness() {
    brightness_.resize(static_cast<std::size_t>(kHeights * kSuns));
    for (int row = 0; row < kHeights; ++row) {
        const double h = sky::kTopOfAir_m * std::pow(row / (kHeights - 1.0), 2);
        const double edge = edge_sine(h);
        for (int column = 0; column < kSuns; ++column) {
            const double t = (column + 1e-3) / (kSuns - 1.0);
            const double sine = std::min(1.0, edge + (1 - edge) * t * t);
            const Columns c = Chord(eye_at(h), direction_of(std::asin(sine), 0)).columns();
            double& value = brightness_[static_cast<std::size_t>(row * kSuns + column)];
            for (const std::size_t k : kDrawn)
                value += std::exp(-optical_depth(medium_.extinction, c, k)) / kDrawn.size();
        }
    }
}

/// Estimate of the light at a height, that sampling follows: the sun's by the nearest lower entry
/// of the table, and the sky's, which loses a factor of 2.8 with each degree of dusk.
double PathIntegral::brightness(double height_m, double sun_sine) const {
    const double dusk_deg = std::max(0.0, -degrees(sun_sine) - 1);
    const double sky = std::pow(10, -1 - 0.5 * std::min(dusk_deg, 12.0));
    const double edge = edge_sine(height_m);
    if (sun_sine < edge) return sky;
    const double u = std::sqrt((sun_sine - edge) / (1 - edge));
    const double v = std::sqrt(std::min(1.0, height_m / sky::kTopOfAir_m));
    const int column = std::clamp(static_cast<int>(u * (kSuns - 1)), 0, kSuns - 1);
    const int row = std::clamp(static_cast<int>(v * (kHeights - 1)), 0, kHeights - 1);
    return sky + brightness_[static_cast<std::size_t>(row * kSuns + column)];
}

/// The expected light along the next straight line of a path: scattered in each cell and by the
/// ground, at the wavelengths in kDrawn.
PathIntegral::Expected PathIntegral::expect(const Path& path, const Chord& chord) const {
    const auto& ends = chord.ends();
    const double sun_along = glm::dot(path.sun, path.direction),
                 sun_up = glm::dot(path.sun, path.at);
    const auto bright = [&](double distance) {
        const double h = chord.height_m(distance);
        return brightness(h, (sun_up + distance * sun_along) / (kEarthRadius_m + h));
    };
    Expected expected;
    std::array<double, kDrawn.size()> through{};
    for (std::size_t j = 0; j < kDrawn.size(); ++j)
        through[j] = path.weight[kDrawn[j]];
    for (std::size_t i = 0; i < Chord::kCells; ++i) {
        expected.before[i] = expected.columns;
        const Columns cell = chord.columns(ends[i], ends[i + 1]);
        expected.columns += cell;
        double scattered = 0;
        for (std::size_t j = 0; j < kDrawn.size(); ++j) {
            const double depth = optical_depth(medium_.extinction, cell, kDrawn[j]);
            const double absorbed = medium_.extinction.ozone[kDrawn[j]] * cell.ozone_m;
            const double after = through[j] * std::exp(-depth);
            if (depth > 0) scattered += (through[j] - after) * (1 - absorbed / depth);
            through[j] = after;
        }
        expected.cells[i] = scattered * bright(0.5 * (ends[i] + ends[i + 1]));
        expected.total += expected.cells[i];
    }
    if (!chord.meets_ground() || medium_.ground_albedo <= 0) return expected;
    double light = 0;
    for (const double t : through)
        light += t * medium_.ground_albedo * bright(ends.back());
    const double sum = light + expected.total;
    expected.ground_chance = expected.total > 0 ? std::clamp(light / sum, 0.02, 0.98) : 1;
    return expected;
}

/// Moves a path to its next vertex, in the air or on the ground. Its weight becomes that of the
/// light which the vertex sends.
void PathIntegral::step(Path& path) const {
    const Chord chord(path.at, path.direction);
    const auto& ends = chord.ends();
    const Expected expected = expect(path, chord);
    path.lost = expected.total <= 0 && expected.ground_chance <= 0;
    if (path.lost) return;
    double u = path.first >= 0 ? path.first : next(path.random);
    path.first = -1;
    path.on_ground = u < expected.ground_chance;
    if (path.on_ground) {
        pass(path.weight, medium_.extinction, expected.columns, 1 / expected.ground_chance);
        path.at = kEarthRadius_m * glm::normalize(path.at + ends.back() * path.direction);
        return;
    }
    const double chance = 1 - expected.ground_chance;
    u = expected.total * (u - expected.ground_chance) / chance;
    std::size_t i = 0;
    while (i + 1 < Chord::kCells && (u >= expected.cells[i] || expected.cells[i] <= 0))
        u -= expected.cells[i++];
    while (i > 0 && expected.cells[i] <= 0)  // rounding led beyond the last cell
        --i;
    const double width = ends[i + 1] - ends[i];
    const double distance = ends[i] + width * std::clamp(u / expected.cells[i], 0.0, 1.0);
    Columns columns = expected.before[i];
    columns += chord.columns(ends[i], distance);
    pass(path.weight, medium_.extinction, columns,
         width * expected.total / (expected.cells[i] * chance));
    path.at += distance * path.direction;
}

PathIntegral::Scattering PathIntegral::scattering(const glm::dvec3& at) const {
    const double h = std::max(0.0, glm::length(at) - kEarthRadius_m);
    const double air = sky::rayleigh_density(h),
                 aerosol = sky::aerosol_density(h) * medium_.aerosol_albedo;
    Scattering s;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        s.rayleigh[k] = air * medium_.extinction.rayleigh[k];
        s.aerosol[k] = aerosol * medium_.extinction.aerosol[k];
    }
    return s;
}

/// Adds the sun's light that the vertex sends back along the path.
void PathIntegral::add_sunlight(const Path& path, Spectrum& sum) const {
    const double cosine = glm::dot(path.at, path.sun) / glm::length(path.at);
    if (path.on_ground && cosine <= 0) return;
    const Chord to_sun(path.at, path.sun);
    if (to_sun.meets_ground()) return;
    Spectrum light = path.weight;
    // In the unit where an irradiance of 1 has radiance 1.
    pass(light, medium_.extinction, to_sun.columns(), kPi);
    if (path.on_ground) {
        for (std::size_t k = 0; k < kWavelengths; ++k)
            sum[k] += light[k] * medium_.ground_albedo / kPi * cosine;
        return;
    }
    const double deflection = glm::dot(path.direction, path.sun);
    const double rayleigh = sky::rayleigh_phase(deflection),
                 aerosol = sky::henyey_greenstein(deflection, medium_.aerosol_asymmetry);
    const Scattering s = scattering(path.at);
    for (std::size_t k = 0; k < kWavelengths; ++k)
        sum[k] += light[k] * (s.rayleigh[k] * rayleigh + s.aerosol[k] * aerosol);
}

/// Gives a path in the air its next direction: by a phase function, or towards the horizon under
/// the sun.
void PathIntegral::scatter_in_air(Path& path) const {
    const Scattering s = scattering(path.at);
    double by_aerosol = 0, all = 0;
    for (const std::size_t k : kDrawn) {
        by_aerosol += path.weight[k] * s.aerosol[k];
        all += path.weight[k] * (s.aerosol[k] + s.rayleigh[k]);
    }
    const double share = all > 0 ? by_aerosol / all : 0.5;
    const glm::dvec3 up = glm::normalize(path.at);
    const glm::dvec3 level = path.sun - glm::dot(path.sun, up) * up;
    const glm::dvec3 lobe = glm::normalize(level + 0.12 * up);
    const double g = medium_.aerosol_asymmetry, azimuth = 2 * kPi * next(path.random);
    const double which = next(path.random), u = next(path.random);
    const glm::dvec3 before = path.direction;
    if (which < lobe_)
        path.direction = around(
            lobe,
            draw_henyey_greenstein(kLobes[which < lobe_ * kLobes[0].share ? 0 : 1].asymmetry, u),
            azimuth);
    else if (which < lobe_ + (1 - lobe_) * share)
        path.direction = around(before, draw_henyey_greenstein(g, u), azimuth);
    else
        path.direction = around(before, draw_rayleigh(u), azimuth);
    const double deflection = glm::dot(before, path.direction);
    const double rayleigh = sky::rayleigh_phase(deflection),
                 aerosol = sky::henyey_greenstein(deflection, g);
    double density = (1 - lobe_) * (share * aerosol + (1 - share) * rayleigh);
    const double from_lobe = glm::dot(lobe, path.direction);
    for (const Lobe& l : kLobes)
        density += lobe_ * l.share * sky::henyey_greenstein(from_lobe, l.asymmetry);
    for (std::size_t k = 0; k < kWavelengths; ++k)
        path.weight[k] *= (s.rayleigh[k] * rayleigh + s.aerosol[k] * aerosol) / density;
}

/// Light that reaches the eye by one path.
Spectrum PathIntegral::follow(Path& path, int orders) const {
    Spectrum sum{};
    for (int order = 1;; ++order) {
        step(path);
        if (path.lost) return sum;
        add_sunlight(path, sum);
        if (order == orders) return sum;
        if (path.on_ground) {
            path.direction = cosine_weighted(glm::normalize(path.at), path.random);
            for (double& weight : path.weight)
                weight *= medium_.ground_albedo;
        } else {
            scatter_in_air(path);
        }
        // Russian roulette, so that what is followed keeps its weight.
        const double survival = std::clamp(largest(path.weight) / path.last_weight, 0.2, 1.0);
        if (order >= 3 && next(path.random) >= survival) return sum;
        if (order >= 3)
            for (double& weight : path.weight)
                weight /= survival;
        path.last_weight = largest(path.weight);
        if (path.last_weight <= 0) return sum;
    }
}

Batches PathIntegral::run(double height_m, const Start& direction, const Effort& effort) const {
    Batches batches(static_cast<std::size_t>(effort.batches));
    parallel_for(0, effort.batches, 1, [&](int first, int last) {
        for (int batch = first; batch < last; ++batch) {
            std::uint64_t random = effort.seed * 0x100000001b3u + static_cast<std::uint64_t>(batch);
            next(random);
            Spectrum& sum = batches[static_cast<std::size_t>(batch)];
            for (int i = 0; i < effort.paths; ++i) {
                Path path;
                path.at = eye_at(height_m);
                path.direction = direction(random);
                path.sun = around(sun_, 1 - sun_cap_ * next(random), 2 * kPi * next(random));
                path.weight.fill(1);
                path.first = (i + next(random)) / effort.paths;
                path.random = random;
                const Spectrum light = follow(path, effort.orders);
                random = path.random;
                for (std::size_t k = 0; k < kWavelengths; ++k)
                    sum[k] += light[k] / effort.paths;
            }
        }
    });
    return batches;
}

Batches PathIntegral::radiance(const Sight& sight, const Effort& effort) const {
    const glm::dvec3 direction = direction_of(sight.elevation_rad, sight.azimuth_rad);
    return run(
        sight.height_m, [&](std::uint64_t&) { return direction; }, effort);
}

Batches PathIntegral::irradiance(double height_m, const Effort& effort, double tilt_rad) const {
    const glm::dvec3 normal(std::sin(tilt_rad), 0, std::cos(tilt_rad));
    // The mean of radiances so distributed is the irradiance over pi.
    const Start start = [&](std::uint64_t& random) { return cosine_weighted(normal, random); };
    return run(height_m, start, effort);
}

Spectrum PathIntegral::transmittance(const Sight& sight) const {
    const Chord chord(eye_at(sight.height_m), direction_of(sight.elevation_rad, sight.azimuth_rad));
    Spectrum through{};
    if (chord.meets_ground()) return through;
    through.fill(1);
    pass(through, medium_.extinction, chord.columns(), 1);
    return through;
}

}  // namespace relevo::skymaker
