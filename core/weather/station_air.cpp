#include "weather/station_air.h"

#include <algorithm>
#include <cmath>

namespace relevo::weather {
namespace {

constexpr double kLapse_k_m = 0.0065;
constexpr double kSeaLevel_hpa = 1013.25, kSeaLevel_k = 288.15;
constexpr double kExponent = 5.25588;  // of the pressure: g / (R lapse)

}  // namespace

double StationAir::pressure_hpa(double height_m) const {
    const double height = std::clamp(height_m, -1000.0, 11000.0);
    const double base =
        std::pow(qnh_hpa / kSeaLevel_hpa, 1 / kExponent) - kLapse_k_m * height / kSeaLevel_k;
    return kSeaLevel_hpa * std::pow(base, kExponent);
}

double StationAir::temperature_at_c(double height_m) const {
    return temperature_c - kLapse_k_m * (std::min(height_m, 11000.0) - station_m);
}

std::optional<StationAir> station_air(const Metar& report, double station_m) {
    if (!report.qnh_hpa && !report.temperature_c) return std::nullopt;
    StationAir air{.station_m = station_m};
    air.qnh_hpa = report.qnh_hpa.value_or(air.qnh_hpa);
    air.temperature_c = report.temperature_c.value_or(15 - kLapse_k_m * station_m);
    return air;
}

}  // namespace relevo::weather
