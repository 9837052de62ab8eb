#include "sun/seasons.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "sun/position.h"

namespace relevo::sun {

Seasons seasons(int year) {
    if (year < kFirstYear || year > kLastYear)
        bad_input(fmt::format("seasons: {}: the sun is computed for the years {} to {}", year,
                              kFirstYear, kLastYear));
    const auto when = [](Instant near, double longitude_rad) {
        constexpr double kRate_rad_s = 2 * kPi / (365.2422 * kDay_s);
        // Newton's method with the mean rate: each pass leaves a thirtieth of the error.
        for (int pass = 0; pass < 20; ++pass) {
            const double ahead =
                std::remainder(longitude_rad - geocentric(Epoch::at(near)).longitude_rad, 2 * kPi);
            near = near + ahead / kRate_rad_s;
            if (std::abs(ahead) / kRate_rad_s < 1e-3) break;
        }
        return near;
    };
    return {when(Instant::from_utc({{year, 3, 20}, 12}), 0),
            when(Instant::from_utc({{year, 6, 21}, 12}), kPi / 2),
            when(Instant::from_utc({{year, 9, 23}, 0}), kPi),
            when(Instant::from_utc({{year, 12, 21}, 12}), 3 * kPi / 2)};
}

}  // namespace relevo::sun
