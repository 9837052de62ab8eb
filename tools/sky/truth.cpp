#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "path_integral.h"

/// Makes the tables that skies are judged by: tests/data/sky/README.md.
namespace relevo::skymaker {
namespace {

struct Place {
    const char* air;
    sky::Air parameters;
    double height_m;
    std::vector<double> suns_deg, elevations_deg, azimuths_deg;
};

/// Directions are at least 9 degrees from the sun.
std::vector<Place> places() {
    const sky::Air clean{.angstrom_beta = 0.04}, turbid{.angstrom_beta = 0.2};
    const std::vector<double> suns{60, 30, 10, 5, 2, 0, -2, -4, -6, -8};
    const std::vector<double> some{60, 10, 2, -2, -6};
    const std::vector<double> sky{2, 6, 15, 35, 55, 80}, round{15, 60, 100, 140, 180};
    const std::vector<double> high{0, 8, 30, 75}, three{15, 90, 180};
    // From 400 km the lines of sight that pass 5, 15, 30 and 60 km above the sea.
    const std::vector<double> limb{-19.667, -19.414, -19.029, -18.234};
    return {{"clean", clean, 0, suns, sky, round},
            {"clean", clean, 3000, some, high, three},
            {"clean", clean, 11000, some, high, three},
            {"clean", clean, 400000, {60, 10, 0, -8}, limb, {15}},
            {"turbid", turbid, 0, {60, 30, 10, 2}, sky, round}};
}

double wanted_error(double sun_deg) {
    return sun_deg < -4 ? 0.02 : 0.01;
}

double luminance_of(const Spectrum& share) {
    return sky::xyz_of(share).y;
}

/// A first run says how many paths the second, which counts, needs.
template <typename Run>
Batches with_error(const Run& run, double wanted) {
    PathIntegral::Effort effort{.paths = 200, .seed = 1};
    Batches batches = run(effort);
    for (int round = 0; round < 3; ++round) {
        const Figure y = figure(batches, luminance_of);
        if (round > 0 && y.standard_error <= wanted * y.value) break;
        const double more = std::pow(1.1 * y.standard_error / (wanted * y.value), 2);
        effort.paths = static_cast<int>(std::clamp(more * effort.paths, 100.0, 30000.0));
        ++effort.seed;
        batches = run(effort);
    }
    return batches;
}

/// Says on standard output that a row misses the error that was wanted of it.
void tell_if_missed(const Batches& batches, double wanted, const std::string& row) {
    const Figure y = figure(batches, luminance_of);
    if (y.standard_error > wanted * y.value)
        fmt::print("{}: standard error {:.2f} %, wanted {:.0f} %\n", row,
                   100 * y.standard_error / y.value, 100 * wanted);
}

/// Columns of light: luminance, colour, chromaticity, standard errors.
std::string columns_of(const Batches& batches) {
    const Spectrum share = mean(batches);
    const glm::dvec3 colour = sky::colour_of(share);
    const glm::dvec2 uv = sky::chromaticity(sky::xyz_of(share));
    const Figure y = figure(batches, luminance_of);
    std::array<double, 2> uv_error{};
    for (int c = 0; c < 2; ++c)
        uv_error[static_cast<std::size_t>(c)] = figure(batches, [&](const Spectrum& s) {
                                                    return sky::chromaticity(sky::xyz_of(s))[c];
                                                }).standard_error;
    return fmt::format("{:.5e},{:.5e},{:.5e},{:.5e},{:.4f},{:.4f},{:.2f},{:.4f}", y.value, colour.r,
                       colour.g, colour.b, uv.x, uv.y, 100 * y.standard_error / y.value,
                       std::hypot(uv_error[0], uv_error[1]));
}

constexpr const char* kLight =
    "luminance,red,green,blue,u,v,standard_error_percent,standard_error_uv";

void make(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::ofstream rows(folder / "sky_truth.csv"), level(folder / "sky_truth_level.csv");
    if (!rows || !level)
        bad_input(fmt::format("relevo_sky_truth: {}: cannot be written", folder.string()));
    rows << "air,height_m,sun_deg,elevation_deg,azimuth_deg," << kLight << '\n';
    level << "air,height_m,sun_deg," << kLight << '\n';
    for (const Place& place : places())
        for (const double sun_deg : place.suns_deg) {
            const auto start = std::chrono::steady_clock::now();
            const PathIntegral integral(medium_of(place.parameters), radians(sun_deg));
            const double wanted = wanted_error(sun_deg);
            for (const double elevation_deg : place.elevations_deg)
                for (const double azimuth_deg : place.azimuths_deg) {
                    const Sight sight{place.height_m, radians(elevation_deg), radians(azimuth_deg)};
                    const Batches batches = with_error(
                        [&](const auto& effort) { return integral.radiance(sight, effort); },
                        wanted);
                    const std::string row = fmt::format("{},{},{},{},{}", place.air, place.height_m,
                                                        sun_deg, elevation_deg, azimuth_deg);
                    rows << row << ',' << columns_of(batches) << '\n';
                    tell_if_missed(batches, wanted, row);
                }
            if (place.height_m <= 11000) {
                const Batches batches = with_error(
                    [&](const auto& effort) { return integral.irradiance(place.height_m, effort); },
                    wanted);
                const std::string row = fmt::format("{},{},{}", place.air, place.height_m, sun_deg);
                level << row << ',' << columns_of(batches) << '\n';
                tell_if_missed(batches, wanted, row);
            }
            rows.flush();
            level.flush();
            fmt::print(
                "{} air, {} m, sun {} degrees: {:.1f} s\n", place.air, place.height_m, sun_deg,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
            std::fflush(stdout);
        }
}

}  // namespace
}  // namespace relevo::skymaker

int main(int argc, char** argv) {
    using namespace relevo;
    try {
        if (argc != 2 || std::string(argv[1]).starts_with('-'))
            bad_usage(
                "usage: relevo_sky_truth FOLDER\nMakes sky_truth.csv and "
                "sky_truth_level.csv in FOLDER, in about ten minutes.\n");
        skymaker::make(argv[1]);
        return 0;
    } catch (const Error& error) {
        log::error(error.what());
        return error.exit_status();
    } catch (const std::exception& error) {
        log::error(fmt::format("relevo_sky_truth: {}", error.what()));
        return 1;
    }
}
