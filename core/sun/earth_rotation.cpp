#include "sun/earth_rotation.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <erfa.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "sun/interpolate.h"

namespace relevo::sun {

namespace {

#include "sun/earth_rotation_table.inc"

constexpr double kUnixEpoch_mjd = 40587;
constexpr double kYear_d = 365.25;
constexpr double kNoLeapSeconds_mjd = 64328;  // 2035-01-01
constexpr int kInterpolationError_ms = 6;
constexpr double kTtMinusTai_s = 32.184;

double mjd_of(Instant utc) {
    return kUnixEpoch_mjd + static_cast<double>(utc.unix_us()) / (kDay_s * 1e6);
}

/// Where the pole is on average; it goes around this within 0.3 arcsec.
/// Source: IERS Conventions (2010) version 1.3.0, equation 21 (secular pole).
struct MeanPole {
    double x_rad, y_rad;
    explicit MeanPole(double mjd) {
        const double years = (mjd - 51544.5) / kYear_d;
        x_rad = (0.0550 + 0.001677 * years) * kArcsecond_rad;
        y_rad = (0.3205 + 0.003460 * years) * kArcsecond_rad;
    }
};

double delta_t_before_1962_s(double mjd) {
    constexpr int kCount = static_cast<int>(std::size(kDeltaT));
    const double at = (mjd - kFirstDeltaT_mjd) / kDeltaTStep_d;
    const int node = std::clamp(static_cast<int>(std::floor(at)), 1, kCount - 3);
    const CubicWeights weights(std::clamp(at - node, -1.0, 2.0));
    double sum_ms = 0;
    for (int k = 0; k < 4; ++k)
        sum_ms += weights.w[k] * kDeltaT[node - 1 + k];
    return sum_ms * 1e-3;
}

}  // namespace

double tai_minus_utc_s(Instant utc) {
    const CivilTime civil = utc.utc();
    const double day_fraction =
        (civil.hour * 3600 + civil.minute * 60 + civil.second + civil.microsecond * 1e-6) / kDay_s;
    double seconds = 0;
    // Status 1 says that leap seconds announced after the library's release are not known.
    eraDat(civil.date.year, civil.date.month, civil.date.day, day_fraction, &seconds);
    return seconds;
}

const EarthRotation& EarthRotation::built_in() {
    static const EarthRotation table = [] {
        EarthRotation rotation;
        rotation.first_mjd_ = kFirstNode_mjd;
        rotation.step_d_ = kNodeStep_d;
        rotation.last_measured_mjd_ = kLastMeasured_mjd;
        for (const auto& [ut1, x, y] : kEarthRotation)
            rotation.nodes_.push_back(
                {ut1 * 1e-4, x * 1e-4 * kArcsecond_rad, y * 1e-4 * kArcsecond_rad});
        return rotation;
    }();
    return table;
}

EarthRotation EarthRotation::load_finals2000a(const std::filesystem::path& path) {
    EarthRotation rotation;
    int line_number = 0;
    const auto fail = [&](const std::string& what) {
        bad_input(fmt::format("Earth rotation: {}: line {}: {}", path.string(), line_number, what));
    };
    const std::string text = read_text(path, "Earth rotation");
    for (const std::string& line : split(text, '\n')) {
        ++line_number;
        // Columns of the "finals" format: MJD 8-15, pole 19-27 and 38-46, flag 58, UT1-UTC 59-68.
        if (line.size() < 68 || (line[57] != 'I' && line[57] != 'P')) {
            if (rotation.nodes_.empty() && line_number > 1)
                fail("not IERS Bulletin A, expected the finals2000A format");
            continue;
        }
        const auto field = [&](std::size_t column, std::size_t width) {
            const auto number = parse_number(trimmed(line.substr(column - 1, width)));
            if (!number)
                fail(fmt::format("no number in columns {} to {}; expected the finals2000A format",
                                 column, column + width - 1));
            return *number;
        };
        const int mjd = static_cast<int>(std::lround(field(8, 8)));
        if (rotation.nodes_.empty()) rotation.first_mjd_ = mjd;
        const int expected = rotation.first_mjd_ + static_cast<int>(rotation.nodes_.size());
        if (mjd != expected)
            fail(fmt::format("a day is missing, expected MJD {} but got {}", expected, mjd));
        if (line[57] == 'I') rotation.last_measured_mjd_ = mjd;
        const Instant day =
            Instant::from_unix_us(std::int64_t{mjd - static_cast<int>(kUnixEpoch_mjd)} *
                                  static_cast<std::int64_t>(kDay_s * 1e6));
        rotation.nodes_.push_back({field(59, 10) - tai_minus_utc_s(day),
                                   field(19, 9) * kArcsecond_rad, field(38, 9) * kArcsecond_rad});
    }
    if (rotation.nodes_.size() < 4) fail("too short, expected four days or more");
    return rotation;
}

EarthRotation EarthRotation::fixed(const EarthOrientation& orientation) {
    EarthRotation rotation;
    rotation.fixed_ = orientation;
    return rotation;
}

EarthOrientation EarthRotation::at(Instant utc) const {
    if (fixed_) return *fixed_;
    const double mjd = mjd_of(utc);
    EarthOrientation result;
    if (mjd < kFirstNode_mjd) {
        const MeanPole pole(mjd);
        return {delta_t_before_1962_s(mjd), 0, pole.x_rad, pole.y_rad};
    }
    if (mjd < first_mjd_) return built_in().at(utc);

    const double tai_utc_s = tai_minus_utc_s(utc);
    result.tt_minus_utc_s = tai_utc_s + kTtMinusTai_s;
    const double last_mjd = first_mjd_ + step_d_ * (static_cast<double>(nodes_.size()) - 1);
    const double at = (std::min(mjd, last_mjd) - first_mjd_) / step_d_;
    const int node = std::clamp(static_cast<int>(at), 1, static_cast<int>(nodes_.size()) - 3);
    const CubicWeights weights(at - node);
    for (int k = 0; k < 4; ++k) {
        const Node& n = nodes_[static_cast<std::size_t>(node - 1 + k)];
        result.ut1_minus_utc_s += weights.w[k] * n.ut1_minus_tai_s;
        result.pole_x_rad += weights.w[k] * n.pole_x_rad;
        result.pole_y_rad += weights.w[k] * n.pole_y_rad;
    }
    result.ut1_minus_utc_s += tai_utc_s;
    if (mjd > last_mjd) {
        const MeanPole pole(mjd);
        const double share = std::min(1.0, (mjd - last_mjd) / kYear_d);
        result.pole_x_rad += share * (pole.x_rad - result.pole_x_rad);
        result.pole_y_rad += share * (pole.y_rad - result.pole_y_rad);
    }
    return result;
}

double EarthRotation::ut1_uncertainty_s(Instant utc) const {
    if (fixed_) return 0;
    const double mjd = mjd_of(utc);
    if (mjd < kFirstNode_mjd) return 0;
    if (mjd < first_mjd_) return built_in().ut1_uncertainty_s(utc);
    if (mjd <= last_measured_mjd_) return kInterpolationError_ms * 1e-3;
    const double last_mjd = first_mjd_ + step_d_ * (static_cast<double>(nodes_.size()) - 1);
    const double predicted_s =
        kInterpolationError_ms * 1e-3 +
        0.00025 * std::pow(std::min(mjd, last_mjd) - last_measured_mjd_, 0.75);
    if (mjd <= last_mjd) return predicted_s;
    const double held_s = std::abs(at(utc).ut1_minus_utc_s);
    const double kept_s = 0.9 + held_s;
    const double bounded_s = std::min(predicted_s + (mjd - last_mjd) / kYear_d, kept_s);
    return bounded_s + std::max(0.0, (mjd - kNoLeapSeconds_mjd) / kYear_d);
}

}  // namespace relevo::sun
