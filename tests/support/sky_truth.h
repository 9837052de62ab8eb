#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "sky/air.h"
#include "support/support.h"

/// Skies by the path integral (tests/data/sky/README.md), and how far a model is from them.
namespace relevo::test {

/// A direction of a sky. Rows of level irradiance have no direction: elevation and azimuth are 0.
struct SkyRow {
    std::string air;  ///< clean, turbid
    double height_m, sun_deg, elevation_deg, azimuth_deg;
    double luminance;  ///< 1: a white diffuse surface that faces the sun outside the atmosphere
    glm::dvec2 uv;     ///< CIE u', v'
    double error;      ///< standard error of the luminance, as a share of it
    double error_uv;

    sky::Air parameters() const {
        return air == "turbid" ? sky::Air{.angstrom_beta = 0.2} : sky::Air{.angstrom_beta = 0.04};
    }
};

/// @param file  sky_truth.csv or sky_truth_level.csv
inline std::vector<SkyRow> sky_truth(const std::string& file = "sky_truth.csv") {
    const Csv csv = read_csv(source_dir() / "tests/data/sky" / file);
    const bool level =
        std::find(csv.header.begin(), csv.header.end(), "azimuth_deg") == csv.header.end();
    std::vector<SkyRow> rows;
    for (const auto& row : csv.rows) {
        const auto number = [&](const char* column) { return std::stod(row[csv.column(column)]); };
        rows.push_back({row[csv.column("air")],
                        number("height_m"),
                        number("sun_deg"),
                        level ? 0 : number("elevation_deg"),
                        level ? 0 : number("azimuth_deg"),
                        number("luminance"),
                        {number("u"), number("v")},
                        number("standard_error_percent") / 100,
                        number("standard_error_uv")});
    }
    return rows;
}

/// How far a model is from the truth, over the directions of one sun.
struct SkyScore {
    std::string air;
    double height_m = 0, sun_deg = 0;
    int directions = 0;
    double mean_error = 0;   ///< mean of |model / truth - 1|
    double worst_error = 0;  ///< the largest of them
    double factor = 1;       ///< largest of model / truth and truth / model
    double mean_uv = 0, worst_uv = 0;
};

/// Compares a model with all rows, and prints a line a sun.
/// @param model  spectrum that reaches the eye of a row, as a share of the sun's; radiances in the
///               unit of SkyRow::luminance
inline std::vector<SkyScore> score_sky(const std::vector<SkyRow>& rows,
                                       const std::function<sky::Spectrum(const SkyRow&)>& model) {
    std::map<std::string, SkyScore> scores;
    std::vector<std::string> order;
    for (const SkyRow& row : rows) {
        const glm::dvec3 xyz = sky::xyz_of(model(row));
        const double ratio = xyz.y / row.luminance, error = std::abs(ratio - 1);
        const double uv = glm::distance(sky::chromaticity(xyz), row.uv);
        const std::string key = fmt::format("{} {} {}", row.air, row.height_m, row.sun_deg);
        if (!scores.contains(key)) order.push_back(key);
        SkyScore& score = scores[key];
        score.air = row.air;
        score.height_m = row.height_m;
        score.sun_deg = row.sun_deg;
        ++score.directions;
        score.mean_error += error;
        score.worst_error = std::max(score.worst_error, error);
        score.factor = std::max({score.factor, ratio, 1 / ratio});
        score.mean_uv += uv;
        score.worst_uv = std::max(score.worst_uv, uv);
    }
    std::vector<SkyScore> result;
    for (const std::string& key : order) {
        SkyScore score = scores[key];
        score.mean_error /= score.directions;
        score.mean_uv /= score.directions;
        fmt::print(
            "[ accuracy ] {:6} air, {:6} m, sun {:3} deg, {:2} directions: error mean {:4.1f} "
            "%, worst {:5.1f} %, factor {:.2f}; u'v' mean {:.4f}, worst {:.4f}\n",
            score.air, score.height_m, score.sun_deg, score.directions, 100 * score.mean_error,
            100 * score.worst_error, score.factor, score.mean_uv, score.worst_uv);
        result.push_back(score);
    }
    return result;
}

}  // namespace relevo::test
