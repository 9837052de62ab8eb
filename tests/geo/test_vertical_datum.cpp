#include <gtest/gtest.h>

#include "base/units.h"
#include "geo/vertical_datum.h"

namespace relevo::geo::test_vertical_datum {
namespace {

const VerticalCrs kEgm96{"EGM96 height", "EPSG:5773", "metre", 1, false},
    kEllipsoidal{"ellipsoidal height", "", "metre", 1, false};

TEST(VerticalDatum, Egm96IsAsHighAboveTheEllipsoidAsItsGridSays) {
    // Test points of NGA's program F477, which interpolates the same grid of 15' by splines.
    struct Point {
        double lat_deg, lon_deg, up_m;
    };
    for (const Point& p : {Point{38.628155, -90.220845, -31.628},
                           {46.874319, 102.448729, -43.575},
                           {-23.617446, 133.874712, 15.871},
                           {38.625473, -0.0005, 50.066}}) {
        const Geodetic place{radians(p.lat_deg), radians(p.lon_deg), 0};
        const auto up = vertical_step_m(kEgm96, kEllipsoidal, place);
        ASSERT_TRUE(up);  // PROJ's data has this grid
        EXPECT_NEAR(*up, p.up_m, 0.5);
        EXPECT_NEAR(vertical_step_m(kEllipsoidal, kEgm96, place).value(), -*up, 1e-3);
    }
}

TEST(VerticalDatum, NoStepIsGuessed) {
    const Geodetic place{radians(47.0), radians(11.5), 0};
    const VerticalCrs nameless{"local height", "", "metre", 1, false},
        unknown{"?", "EPSG:999999", "metre", 1, false};
    EXPECT_FALSE(vertical_step_m(nameless, kEllipsoidal, place));
    EXPECT_FALSE(vertical_step_m(unknown, kEllipsoidal, place));
    // Heights of Hong Kong, whose grid to WGS 84 nobody has published.
    const VerticalCrs hong_kong{"HKPD height", "EPSG:5738", "metre", 1, false};
    EXPECT_FALSE(vertical_step_m(hong_kong, kEllipsoidal, place));
}

}  // namespace
}  // namespace relevo::geo::test_vertical_datum
