#include "light/raster/direction_table.h"

#include <algorithm>

namespace relevo::light {
namespace {

/// Half of what stands at an entry is over it.
std::vector<float> summed_from_above(std::vector<double>& at) {
    double above = 0;
    std::vector<float> over(at.size());
    for (std::size_t k = at.size(); k-- > 0;) {
        over[k] = static_cast<float>(above + at[k] / 2);
        above += at[k];
    }
    at = {};
    return over;
}

}  // namespace

void DirectionTable::add(double azimuth_rad, double elevation_rad, double hours, double level_wh,
                         double up_wh) {
    if (hours_.empty())
        for (auto* const each : {&hours_, &level_wh_, &up_wh_})
            each->resize(kEntries, 0);
    azimuth_sum_rad_ += azimuth_rad * hours;
    sum_h_ += hours;
    // An entry between two: to each its share.
    const double at =
        std::clamp((elevation_rad - kLowest_rad) / kEntry_rad, 0.0, double{kEntries} - 1.001);
    const auto entry = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(entry);
    const auto put = [&](std::vector<double>& to, double sum) {
        to[entry] += sum * (1 - part);
        to[entry + 1] += sum * part;
    };
    put(hours_, hours);
    put(level_wh_, level_wh);
    put(up_wh_, up_wh);
}

void DirectionTable::sum_up() {
    hours_over_ = summed_from_above(hours_);
    level_wh_over_ = summed_from_above(level_wh_);
    up_wh_over_ = summed_from_above(up_wh_);
}

}  // namespace relevo::light
