#include "sun/earth_rotation.h"

#include <algorithm>
#include <cmath>

#include <erfa.h>

#include "base/units.h"
#include "sun/interpolate.h"

namespace relevo::sun {

namespace {

#include "sun/earth_rotation_table.inc"

constexpr double kUnixEpoch_mjd = 40587;
constexpr double kYear_d = 365.25;
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
        for (const auto& [ut1, x, y] : kEarthRotation)
            rotation.nodes_.push_back(
                {ut1 * 1e-4, x * 1e-4 * kArcsecond_rad, y * 1e-4 * kArcsecond_rad});
        return rotation;
    }();
    return table;
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

    const double tai_utc_s = tai_minus_utc_s(utc);
    result.tt_minus_utc_s = tai_utc_s + kTtMinusTai_s;
    const double last_mjd = kFirstNode_mjd + kNodeStep_d * (static_cast<double>(nodes_.size()) - 1);
    const double at = (std::min(mjd, last_mjd) - kFirstNode_mjd) / kNodeStep_d;
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

}  // namespace relevo::sun
