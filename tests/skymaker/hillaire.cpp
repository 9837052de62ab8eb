#include "hillaire.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"
#include "base/units.h"

namespace relevo::skymaker {
namespace {

using namespace sky;

constexpr double kEarth_m = kEarthRadius_m;
constexpr double kTop_m = 80000;  // of the tables; 5e-5 of the air is above
constexpr double kSunRadius_rad = radians(0.2666);

// Tables: heights by the square root, the sun by the root of its distance from the Earth's edge.
constexpr int kHeights = 48, kSuns = 256;
constexpr int kManyHeights = 24, kManySuns = 96;

double edge_sine(double height_m) {
    const double cosine = kEarth_m / (kEarth_m + height_m);
    return -std::sqrt(1 - cosine * cosine);
}

/// Distance to the sphere of that height from a point, along a direction that meets it.
double distance_to(double radius_m, double from_m, double sine) {
    const double across = from_m * from_m * (1 - sine * sine);
    return -from_m * sine + std::sqrt(std::max(radius_m * radius_m - across, 0.0));
}

double smooth(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Linear interpolation in a table over the unit square.
struct Place {
    std::size_t i00, i10, i01, i11;
    double x, y;
};
Place place(double u, double v, int columns, int rows) {
    const double c = std::clamp(u, 0.0, 1.0) * (columns - 1),
                 r = std::clamp(v, 0.0, 1.0) * (rows - 1);
    const int c0 = std::min(static_cast<int>(c), columns - 2);
    const int r0 = std::min(static_cast<int>(r), rows - 2);
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * columns + i); };
    return {at(c0, r0), at(c0 + 1, r0), at(c0, r0 + 1), at(c0 + 1, r0 + 1), c - c0, r - r0};
}
double mix(double a, double b, double t) {
    return a + t * (b - a);
}

}  // namespace

HillaireSky::HillaireSky(const Air& air) : air_(air), extinction_(extinction(air)) {
    to_sun_.resize(static_cast<std::size_t>(kHeights * kSuns));
    parallel_for(0, kHeights, 1, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const double h = kTop_m * std::pow(row / (kHeights - 1.0), 2);
            const double edge = edge_sine(h);
            for (int column = 0; column < kSuns; ++column) {
                const double t = column / (kSuns - 1.0);
                to_sun_[static_cast<std::size_t>(row * kSuns + column)].columns =
                    columns(h, edge + (1 - edge) * t * t);
            }
        }
    });
    scatter_many();
}

/// Air along a ray to the top of the atmosphere, as lengths of it at full density.
HillaireSky::Columns HillaireSky::columns(double height_m, double sine) const {
    const double from = kEarth_m + height_m;
    const double length = distance_to(kEarth_m + kTop_m, from, sine);
    constexpr int kSteps = 400;
    const double step = length / kSteps;
    Columns sum;
    for (int i = 0; i < kSteps; ++i) {
        const double d = (i + 0.5) * step;
        const double h =
            std::max(0.0, std::sqrt(from * from + d * d + 2 * from * d * sine) - kEarth_m);
        sum.rayleigh_m += step * rayleigh_density(h);
        sum.aerosol_m += step * aerosol_density(h);
        sum.ozone_m += step * ozone_density(h);
    }
    return sum;
}

HillaireSky::Lit HillaireSky::towards_sun(double height_m, double sine) const {
    const double edge = edge_sine(height_m);
    const double above_edge_rad = std::asin(std::clamp(sine, -1.0, 1.0)) - std::asin(edge);
    Lit lit;
    lit.share = smooth(0.5 + 0.5 * above_edge_rad / kSunRadius_rad);
    const double u = std::sqrt(std::max(0.0, (sine - edge) / (1 - edge)));
    const Place at = place(u, std::sqrt(height_m / kTop_m), kSuns, kHeights);
    const auto read = [&](double Columns::*member) {
        const auto value = [&](std::size_t i) { return to_sun_[i].columns.*member; };
        return mix(mix(value(at.i00), value(at.i10), at.x), mix(value(at.i01), value(at.i11), at.x),
                   at.y);
    };
    lit.columns = {read(&Columns::rayleigh_m), read(&Columns::aerosol_m), read(&Columns::ozone_m)};
    return lit;
}

void HillaireSky::pass(Spectrum& through, const Columns& c, double length) const {
    for (std::size_t k = 0; k < kWavelengths; ++k)
        through[k] *= std::exp(-length * (c.rayleigh_m * extinction_.rayleigh[k] +
                                          c.aerosol_m * extinction_.aerosol[k] +
                                          c.ozone_m * extinction_.ozone[k]));
}

// In one piece: one integral, over heights, directions and steps along them.
void HillaireSky::scatter_many() {
    constexpr int kDirections = 64, kSteps = 32;
    many_.assign(static_cast<std::size_t>(kManyHeights * kManySuns), Spectrum{});
    std::vector<Spectrum> made(many_.size());
    parallel_for(0, kManyHeights * kManySuns, 1, [&](int first, int last) {
        for (int index = first; index < last; ++index) {
            const double h = kTop_m * std::pow(index / kManySuns / (kManyHeights - 1.0), 2);
            const double y = 2.0 * (index % kManySuns) / (kManySuns - 1.0) - 1;
            const double sun = y * std::abs(y);  // dense about the horizon
            Spectrum second{}, share{};
            for (int d = 0; d < kDirections; ++d) {
                const double sine = 1 - (2 * d + 1.0) / kDirections;
                const double azimuth = d * kPi * (3 - std::sqrt(5.0));
                const double cosine =
                    sine * sun +
                    std::sqrt((1 - sine * sine) * std::max(0.0, 1 - sun * sun)) * std::cos(azimuth);
                const double from = kEarth_m + h;
                const bool ground = sine < edge_sine(h);
                const double length =
                    ground ? -from * sine -
                                 std::sqrt(std::max(
                                     0.0, kEarth_m * kEarth_m - from * from * (1 - sine * sine)))
                           : distance_to(kEarth_m + kTop_m, from, sine);
                Spectrum through;
                through.fill(1);
                double before = 0;
                for (int i = 0; i < kSteps; ++i) {
                    const double next = length * std::pow((i + 1.0) / kSteps, 2);
                    const double step = next - before, at = 0.5 * (next + before);
                    before = next;
                    const double r = std::sqrt(from * from + at * at + 2 * from * at * sine);
                    const double height = std::clamp(r - kEarth_m, 0.0, kTop_m);
                    // The sun's sine there: the same direction against another vertical.
                    const double local = std::clamp((from * sun + at * cosine) / r, -1.0, 1.0);
                    const Lit lit = towards_sun(height, local);
                    Spectrum light;
                    light.fill(lit.share);
                    pass(light, lit.columns, 1);
                    const double air = rayleigh_density(height), dust = aerosol_density(height);
                    Spectrum after = through;
                    pass(after, {air, dust, ozone_density(height)}, step);
                    for (std::size_t k = 0; k < kWavelengths; ++k) {
                        const double scattered = air * extinction_.rayleigh[k] +
                                                 dust * kAerosolAlbedo * extinction_.aerosol[k];
                        const double taken = air * extinction_.rayleigh[k] +
                                             dust * extinction_.aerosol[k] +
                                             ozone_density(height) * extinction_.ozone[k];
                        const double passed =
                            taken > 0 ? (through[k] - after[k]) / taken * scattered : 0.0;
                        second[k] += passed * light[k] / (4 * kPi) / kDirections;
                        share[k] += passed / kDirections;
                    }
                    through = after;
                }
                if (ground) {
                    const double local =
                        std::clamp((from * sun + length * cosine) / kEarth_m, -1.0, 1.0);
                    const Lit lit = towards_sun(0, local);
                    Spectrum light;
                    light.fill(lit.share * std::max(local, 0.0) * air_.ground_albedo / kPi);
                    pass(light, lit.columns, 1);
                    for (std::size_t k = 0; k < kWavelengths; ++k)
                        second[k] += through[k] * light[k] / kDirections;
                }
            }
            for (std::size_t k = 0; k < kWavelengths; ++k)
                made[static_cast<std::size_t>(index)][k] = second[k] / (1 - share[k]);
        }
    });
    many_ = std::move(made);
}

Spectrum HillaireSky::many(double height_m, double sun_sine) const {
    const double y = std::copysign(std::sqrt(std::abs(sun_sine)), sun_sine);
    const Place at = place(0.5 + 0.5 * y, std::sqrt(height_m / kTop_m), kManySuns, kManyHeights);
    Spectrum result;
    for (std::size_t k = 0; k < kWavelengths; ++k)
        result[k] = mix(mix(many_[at.i00][k], many_[at.i10][k], at.x),
                        mix(many_[at.i01][k], many_[at.i11][k], at.x), at.y);
    return result;
}

Spectrum HillaireSky::radiance(double sine, double sun_sine, double azimuth_cos) const {
    constexpr int kSteps = 40;
    const double cosine =
        sine * sun_sine +
        azimuth_cos * std::sqrt(std::max(0.0, (1 - sine * sine) * (1 - sun_sine * sun_sine)));
    const double air_phase = rayleigh_phase(cosine), dust_phase = aerosol_phase(cosine);
    const double length = distance_to(kEarth_m + kTop_m, kEarth_m, sine);
    Spectrum sum{};
    Spectrum through;
    through.fill(1);
    double before = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double next = length * std::pow((i + 1.0) / kSteps, 2);
        const double step = next - before, at = 0.5 * (next + before);
        before = next;
        const double r = std::sqrt(kEarth_m * kEarth_m + at * at + 2 * kEarth_m * at * sine);
        const double height = std::clamp(r - kEarth_m, 0.0, kTop_m);
        const double local = std::clamp((kEarth_m * sun_sine + at * cosine) / r, -1.0, 1.0);
        const Lit lit = towards_sun(height, local);
        Spectrum light;
        light.fill(lit.share);
        pass(light, lit.columns, 1);
        const Spectrum around = many(height, local);
        const double air = rayleigh_density(height), dust = aerosol_density(height);
        Spectrum after = through;
        pass(after, {air, dust, ozone_density(height)}, step);
        for (std::size_t k = 0; k < kWavelengths; ++k) {
            const double by_air = air * extinction_.rayleigh[k];
            const double by_dust = dust * kAerosolAlbedo * extinction_.aerosol[k];
            const double taken = by_air + dust * extinction_.aerosol[k] +
                                 ozone_density(height) * extinction_.ozone[k];
            const double sent = light[k] * (by_air * air_phase + by_dust * dust_phase) +
                                around[k] * (by_air + by_dust);
            if (taken <= 0) continue;
            const double passed = (through[k] - after[k]) / taken * kPi;
            sum[k] += passed * sent;
        }
        through = after;
    }
    return sum;
}

}  // namespace relevo::skymaker
