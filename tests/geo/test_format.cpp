#include "geo/format.h"
#include "support/support.h"

namespace relevo::geo {
namespace {

TEST(UtmText, GeographicLibsOwnExamples) {
    // GeoConvert(1), EXAMPLES: "-1 3" is 31s 500000 9889470; 38SMB4488 has its centre at
    // 33:20:03.25N 044:24:13.06E, which is 38n 444500 3688500.
    EXPECT_EQ(utm_text(geodetic_deg(-1, 3)), "31S 500000 E 9889470 N");
    EXPECT_EQ(utm_text(geodetic_deg(33 + 20 / 60.0 + 3.25 / 3600, 44 + 24 / 60.0 + 13.06 / 3600)),
              "38N 444500 E 3688500 N");
}

TEST(UtmText, CentralMeridianHasHalfAMillion) {
    EXPECT_EQ(utm_text(geodetic_deg(0, 9)), "32N 500000 E 0 N");
}

TEST(UtmText, NorwayAndSvalbardHaveTheirExceptions) {
    // DMA TM 8358.1, figure 3-1: zone 32V begins at 3 E; 33X spans 9 to 21 E.
    EXPECT_TRUE(utm_text(geodetic_deg(60, 4)).starts_with("32N "));
    EXPECT_TRUE(utm_text(geodetic_deg(50, 4)).starts_with("31N "));
    EXPECT_TRUE(utm_text(geodetic_deg(78, 10)).starts_with("33N "));
}

TEST(UtmText, PolesAreUps) {
    EXPECT_EQ(utm_text(geodetic_deg(90, 0)), "UPS N 2000000 E 2000000 N");
    EXPECT_EQ(utm_text(geodetic_deg(-90, 0)), "UPS S 2000000 E 2000000 N");
    // IOGP publication 373-7-2, "Polar Stereographic (variant A)": 73 N 44 E is E 3320416.75,
    // N 632668.43 in UPS North, which is used from 84 N on only: 85 N on the same meridian is on
    // the same line from the pole.
    EXPECT_TRUE(utm_text(geodetic_deg(73, 44)).starts_with("38N "));
    EXPECT_TRUE(utm_text(geodetic_deg(85, 44)).starts_with("UPS N "));
}

TEST(MgrsText, GeographicLibsOwnExamples) {
    // GeoConvert(1): "E44d24 N33d20" with -m -p -3 (kilometres) is 38SMB4488.
    const Geodetic baghdad = geodetic_deg(33 + 20 / 60.0, 44.4);
    EXPECT_EQ(mgrs_text(baghdad, 2), "38SMB4488");
    EXPECT_EQ(mgrs_text(baghdad, 0), "38SMB");
    EXPECT_TRUE(mgrs_text(baghdad).starts_with("38SMB44"));
    EXPECT_EQ(mgrs_text(baghdad).size(), std::string("38SMB4416388395").size());
    // 79.9 S 6.1 E with -m -p -3 is 32CMS4328.
    EXPECT_EQ(mgrs_text(geodetic_deg(-79.9, 6.1), 2), "32CMS4328");
}

TEST(MgrsText, PoleIsInASquareOfItsOwn) {
    EXPECT_EQ(mgrs_text(geodetic_deg(90, 0), 1), "ZAH00");
}

TEST(DegreesText, HemispheresAreLetters) {
    EXPECT_EQ(degrees_text(geodetic_deg(47.417, 11.437084)), "47.41700 N 11.43708 E");
    EXPECT_EQ(degrees_text(geodetic_deg(-34.01, -118.15)), "34.01000 S 118.15000 W");
}

TEST(DegreesText, ZeroIsNorthAndEast) {
    EXPECT_EQ(degrees_text(geodetic_deg(0, 0)), "0.00000 N 0.00000 E");
}

TEST(MgrsText, HasTheDigitsOfTheMap) {
    // Those of UTM, cut off and not rounded.
    const Geodetic place = geodetic_deg(46.9510, 7.4390);
    EXPECT_EQ(utm_text(place), "32N 381217 E 5200902 N");
    EXPECT_EQ(mgrs_text(place, 5), "32TLT8121600901");
}

TEST(CompassPoint, IsTheNearestOfSixteen) {
    EXPECT_STREQ(compass_point(0), "N");
    EXPECT_STREQ(compass_point(200), "SSW");
    EXPECT_STREQ(compass_point(348.7), "NNW");
    EXPECT_STREQ(compass_point(348.8), "N");
    EXPECT_STREQ(compass_point(360), "N");
}

}  // namespace
}  // namespace relevo::geo
