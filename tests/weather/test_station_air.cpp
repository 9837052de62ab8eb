#include "support/support.h"
#include "weather/station_air.h"

namespace relevo::weather {
namespace {

// ICAO Doc 7488, table 4: heights and pressures of the standard atmosphere.
TEST(StationAir, OfTheStandardAtmosphereHasItsPressures) {
    const StationAir air;
    EXPECT_NEAR(air.pressure_hpa(0), 1013.25, 1e-9);
    EXPECT_NEAR(air.pressure_hpa(1000), 898.75, 0.02);
    EXPECT_NEAR(air.pressure_hpa(3000), 701.09, 0.02);
    EXPECT_NEAR(air.temperature_at_c(1000), 8.5, 1e-9);
}

// QNH is what an altimeter is set to so that it shows the station's height.
TEST(StationAir, FollowsTheReport) {
    Metar report;
    report.qnh_hpa = 990;
    report.temperature_c = -5;
    const StationAir air = *station_air(report, 1560);
    EXPECT_NEAR(air.pressure_hpa(0), 990, 1e-9);
    EXPECT_NEAR(air.pressure_hpa(1560), 819,
                1);  // 990 hPa less 8.4 m a hPa at sea level, 10 up there
    EXPECT_NEAR(air.temperature_at_c(1560), -5, 1e-9);
    EXPECT_NEAR(air.temperature_at_c(2560), -11.5, 1e-9);
    EXPECT_FALSE(station_air(Metar(), 0));
}

}  // namespace
}  // namespace relevo::weather
