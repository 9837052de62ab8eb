// How well the hours of sun of a day are found, as Markdown tables. Run in Release:
//   cmake -B build/bench -DCMAKE_BUILD_TYPE=Release -DRELEVO_TESTS=ON &&
//   build/bench/bin/bench_sun_days steps [DEM...]
//   build/bench/bin/bench_sun_days cells [-n CELL_DAYS] [DEM...]
//   build/bench/bin/bench_sun_days post DEM COLUMN ROW DATE
// Without DEMs: those of docs/accuracy-sun-rasters.md, some of which are outside test data.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/parallel_for.h"
#include "base/units.h"
#include "light/fields.h"
#include "light/point/direct_light.h"
#include "light/raster/sun_hours.h"

namespace relevo::light {
namespace {

using Paths = std::vector<std::string>;

constexpr std::array kStepDems{"vancouver-island.tif", "jacksboro.tif",
                               "srtm_bigtujunga30m_utm11.tif", "monterey_bay_topobathy.tif"};
constexpr std::array kCellDems{
    "jacksboro.tif",         "srtm_bigtujunga30m_utm11.tif", "tyrol_aw3d30_n47e011_1s_cog.tif",
    "N42E001.hgt",           "mt_rainier_90m.tif",           "hawaii_rotated20.tif",
    "missoula_valley.img",   "colorado_tut_relief.nc",       "swellendam/srtm_41_19_4326.tif",
    "dem_RGI50-05.08389.tif"};

/// The path of a DEM that ships with the project or is outside test data; empty: it is not here.
std::string found(const std::string& name) {
    const std::filesystem::path bundled = test::source_dir() / "data" / "dem" / name;
    if (std::filesystem::exists(bundled)) return bundled.string();
    const auto outside = test::test_data_dir();
    if (outside && std::filesystem::exists(*outside / "dem" / name))
        return (*outside / "dem" / name).string();
    fmt::print(stderr, "{}: not here, skipped\n", name);
    return {};
}

/// Full hours of mean solar time in the middle of a DEM.
sun::Zone zone_of(const dem::Grid& grid) {
    const double hours = std::round(degrees(grid.center().lon_rad) / 15);
    return sun::Zone::fixed(static_cast<int>(3600 * hours));
}

SunHours hours_of(const dem::Posts& posts, const sun::TimeSpan& day, SunHoursOptions options) {
    options.air = [](const geo::Geodetic& place) { return sun::Refraction::standard(place); };
    return sun_hours(posts, day.begin, day.end, options);
}

/// Absolute differences of two rasters, voids skipped.
struct Differences {
    std::vector<double> minutes{};
    int far = 0;  // beyond a minute
    struct Worst {
        double minutes = 0;
        int column = 0, row = 0;
        void take(double off_min, int c, int r) {
            if (off_min > minutes) *this = {off_min, c, r};
        }
    };
    Worst worst{}, within{};  // of all, and of posts that are not near the edge
    static constexpr int kEdge = 8;
    int by_3_min = 0, by_3_min_within = 0;  // how many posts are off by more than 3 minutes

    Differences(const Array2d<float>& hours, const Array2d<float>& expected) {
        for (int r = 0; r < hours.height(); ++r)
            for (int c = 0; c < hours.width(); ++c) {
                const double off_min = 60 * std::abs(double{hours.at(c, r)} - expected.at(c, r));
                if (std::isnan(off_min)) continue;
                minutes.push_back(off_min);
                far += off_min > 1;
                worst.take(off_min, c, r);
                by_3_min += off_min > 3;
                if (std::min(c, r) < kEdge || c + kEdge >= hours.width() ||
                    r + kEdge >= hours.height())
                    continue;
                within.take(off_min, c, r);
                by_3_min_within += off_min > 3;
            }
    }
};

double mean(const std::vector<double>& numbers) {
    double sum = 0;
    for (const double number : numbers)
        sum += number;
    return sum / static_cast<double>(numbers.size());
}

double quantile(std::vector<double> numbers, double share) {
    std::sort(numbers.begin(), numbers.end());
    return numbers[static_cast<std::size_t>(share * static_cast<double>(numbers.size() - 1))];
}

/// Hours of all posts by the time between two suns, against suns 6 s apart.
void print_steps(const Paths& paths) {
    fmt::print(
        "| DEM | date | posts | suns apart [s] | mean [min] | beyond 1 min [%] | "
        "posts beyond 3 min | worst [min] | column, row | {} posts and more from the edge: beyond "
        "3 min | worst [min] | column, row |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        Differences::kEdge);
    for (const std::string& path : paths) {
        const dem::Heightfield field = dem::load(path);
        const dem::Posts posts(field);
        for (const char* const date : {"2026-03-21", "2026-06-21", "2026-12-21"}) {
            const sun::TimeSpan day = zone_of(field.grid).day(sun::parse_date(date));
            const Array2d<float> expected = hours_of(posts, day, {.step_s = 6}).hours;
            for (const double step_s : {600.0, 180.0, 60.0, 30.0}) {
                const Differences off(hours_of(posts, day, {.step_s = step_s}).hours, expected);
                fmt::print(
                    "| {} | {} | {} | {} | {:.4f} | {:.4f} | {} | {:.2f} | {}, {} | {} | {:.2f} | "
                    "{}, "
                    "{} |\n",
                    std::filesystem::path(path).filename().string(), date, off.minutes.size(),
                    step_s, mean(off.minutes),
                    100.0 * off.far / static_cast<double>(off.minutes.size()), off.by_3_min,
                    off.worst.minutes, off.worst.column, off.worst.row, off.by_3_min_within,
                    off.within.minutes, off.within.column, off.within.row);
                std::fflush(stdout);
            }
        }
    }
}

/// A post and a day of a DEM, and its hours.
struct CellDay {
    glm::ivec2 post;
    sun::Date date;
    double hours = 0, exact_h = 0;
};

bool has_void_near(const Array2d<float>& height_m, const glm::ivec2& post) {
    constexpr int kNear = 20;
    for (int r = std::max(0, post.y - kNear); r <= std::min(height_m.height() - 1, post.y + kNear);
         ++r)
        for (int c = std::max(0, post.x - kNear);
             c <= std::min(height_m.width() - 1, post.x + kNear); ++c)
            if (std::isnan(height_m.at(c, r))) return true;
    return false;
}

std::vector<CellDay> drawn(const dem::Heightfield& field, int count, unsigned seed) {
    std::mt19937 lot(seed);
    std::vector<CellDay> drawn;
    while (static_cast<int>(drawn.size()) < count) {
        const glm::ivec2 post(lot() % static_cast<unsigned>(field.grid.columns()),
                              lot() % static_cast<unsigned>(field.grid.rows()));
        const auto day = static_cast<int>(lot() % 365);
        if (!has_void_near(field.height_m, post))
            drawn.push_back({post, sun::add_days({2026, 1, 1}, day)});
    }
    return drawn;
}

/// Hours of random posts on random days, as rasters have them and over the exact horizon.
void print_cells(const Paths& paths, int cell_days) {
    fmt::print(
        "| DEM | cell-days | mean [min] | 99 % within [min] | worst [min] | its column, row, date "
        "|\n|---|---|---|---|---|---|\n");
    std::vector<double> all_min;
    const int each = cell_days / static_cast<int>(paths.size());
    unsigned seed = 20260321;
    for (const std::string& path : paths) {
        const dem::Heightfield field = dem::load(path);
        const dem::Posts posts(field);
        const sun::Zone zone = zone_of(field.grid);
        std::vector<CellDay> cells = drawn(field, each, ++seed);
        for (CellDay& cell : cells)
            cell.hours = double{
                hours_of(posts, zone.day(cell.date), {.part = {cell.post.x, cell.post.y, 1, 1}})
                    .hours.at(0, 0)};
        parallel_for(0, each, 1, [&](int begin, int end) {
            for (int i = begin; i < end; ++i) {
                CellDay& cell = cells[static_cast<std::size_t>(i)];
                const TerrainHorizon horizon(posts, field.grid.place(cell.post.x, cell.post.y));
                cell.exact_h = DirectLight(horizon).day(cell.date, zone).lit_s / 3600;
            }
        });
        std::vector<double> minutes;
        for (const CellDay& cell : cells)
            minutes.push_back(60 * std::abs(cell.hours - cell.exact_h));
        const auto worst = static_cast<std::size_t>(
            std::max_element(minutes.begin(), minutes.end()) - minutes.begin());
        fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {}, {}, {} |\n",
                   std::filesystem::path(path).filename().string(), each, mean(minutes),
                   quantile(minutes, 0.99), minutes[worst], cells[worst].post.x,
                   cells[worst].post.y, sun::to_string(cells[worst].date));
        std::fflush(stdout);
        all_min.insert(all_min.end(), minutes.begin(), minutes.end());
    }
    fmt::print("| all | {} | {:.2f} | {:.2f} | {:.2f} | |\n", all_min.size(), mean(all_min),
               quantile(all_min, 0.99), quantile(all_min, 1));
}

/// Of one post and day: its light over the exact horizon, and its hours by the step.
/// @param arguments  path, column, row, date
void print_post(const Paths& arguments) {
    const dem::Heightfield field = dem::load(arguments.at(0));
    const dem::Posts posts(field);
    const int column = std::stoi(arguments.at(1)), row = std::stoi(arguments.at(2));
    const sun::Date date = sun::parse_date(arguments.at(3));
    const sun::Zone zone = zone_of(field.grid);
    const TerrainHorizon horizon(posts, field.grid.place(column, row));
    const LightDay exact = DirectLight(horizon).day(date, zone);
    for (const LitInterval& lit : exact.lit)
        for (const LightEdge& edge : {lit.begin, lit.end}) {
            const HorizonPoint at = horizon.at(edge.azimuth_rad);
            fmt::print("{} azimuth {:.3f}, elevation {:.3f} degrees, over ground {:.0f} m away\n",
                       sun::to_iso(edge.utc, zone), degrees(edge.azimuth_rad),
                       degrees(edge.elevation_rad), at.distance_m);
        }
    fmt::print("exact: {:.3f} min in {} periods\n", exact.lit_s / 60, exact.lit.size());
    for (const double step_s : {600.0, 180.0, 60.0, 30.0, 6.0, 2.0}) {
        const SunHours found = hours_of(
            posts, zone.day(date), {.step_s = step_s, .spells = true, .part = {column, row, 1, 1}});
        fmt::print("suns {} s apart: {:.3f} min in {} periods, first {:.3f} h, last {:.3f} h\n",
                   step_s, 60 * found.hours.at(0, 0), found.spells.at(0, 0), found.first_h.at(0, 0),
                   found.last_h.at(0, 0));
    }
}

template <typename Names>
Paths defaults(const Names& names) {
    Paths paths;
    for (const char* const name : names)
        if (const std::string path = found(name); !path.empty()) paths.push_back(path);
    return paths;
}

int run(Paths arguments) {
    const std::string verb = arguments.empty() ? "" : arguments.front();
    if (verb != "steps" && verb != "cells" && (verb != "post" || arguments.size() != 5)) {
        fmt::print(stderr,
                   "usage: bench_sun_days steps|cells [-n CELL_DAYS] [DEM...]\n"
                   "       bench_sun_days post DEM COLUMN ROW DATE\n");
        return 2;
    }
    arguments.erase(arguments.begin());
    int cell_days = 2000;
    if (arguments.size() > 1 && arguments.front() == "-n") {
        cell_days = std::atoi(arguments[1].c_str());
        arguments.erase(arguments.begin(), arguments.begin() + 2);
    }
    if (verb == "post")
        print_post(arguments);
    else if (verb == "steps")
        print_steps(arguments.empty() ? defaults(kStepDems) : arguments);
    else
        print_cells(arguments.empty() ? defaults(kCellDems) : arguments, cell_days);
    return 0;
}

}  // namespace
}  // namespace relevo::light

int main(int count, char** arguments) {
    try {
        return relevo::light::run({arguments + 1, arguments + count});
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
