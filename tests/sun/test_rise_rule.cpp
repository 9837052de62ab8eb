#include <cmath>

#include "base/units.h"
#include "sun/events.h"
#include "sun/position.h"
#include "sun/rise_rule.h"
#include "sun/tables.h"

namespace relevo::sun::test_rise_rule {
namespace {

const Zone kZurich = Zone::named("Europe/Zurich");
const geo::Geodetic kBern{radians(46.951), radians(7.4386), 560};

TEST(RiseRule, OptionsMoveSunrise) {
    const auto sunrise = [](const RiseRule& rule) {
        DayOptions options;
        options.rule = rule;
        const Day day = day_events({2026, 3, 20}, kZurich, kBern, options);
        EXPECT_EQ(day.definition, rule.description());
        return *day.first(EventKind::Sunrise);
    };
    const Instant usno = sunrise(RiseRule());
    const Refraction air = Refraction::standard(kBern);
    const Instant upper = sunrise(RiseRule::seen(Limb::Upper, air));
    const Instant center = sunrise(RiseRule::seen(Limb::Center, air));
    const Instant lower = sunrise(RiseRule::seen(Limb::Lower, air));
    // A diameter of 32.1 arc-minutes, at the rate of that morning.
    const double rate = rate_arcsec_s(center, kBern);
    const double semidiameter = position(center, kBern).semidiameter_rad / kArcsecond_rad;
    EXPECT_NEAR((center - upper) * rate, semidiameter, 1);
    EXPECT_NEAR((lower - center) * rate, semidiameter, 1);
    // At 560 m the standard air lifts by 31.2 arc-minutes, not by the almanac's 34.
    EXPECT_NEAR((upper - usno) * rate / 60, 50 - 31.2 - semidiameter / 60, 0.1);
    // The dip of the horizon from 100 m is 17.6 arc-minutes.
    const Instant high = sunrise(RiseRule::seen(Limb::Upper, air, 100));
    EXPECT_GT((upper - high) * rate / 60, 17.6);
    EXPECT_LT((upper - high) * rate / 60, 22.0);  // refraction is stronger there, too

    // Without air: the limb alone.
    EXPECT_NEAR(RiseRule::seen(Limb::Upper, Refraction::none()).center_elevation_rad(1),
                -semidiameter_rad(1), 1e-12);
    EXPECT_EQ(RiseRule::seen(Limb::Center, Refraction::none()).center_elevation_rad(1), 0);
    EXPECT_NEAR(
        degrees(RiseRule::seen(Limb::Center, Refraction::none(), 100).center_elevation_rad(1)) * 60,
        -1.926 * 10, 0.01);
}

TEST(RiseRule, SaysWhatItIs) {
    EXPECT_EQ(RiseRule::at_center_elevation(radians(-0.25)).description(),
              "sunrise and sunset: centre of the sun 15 arc-minutes below the horizon, without "
              "refraction");
    EXPECT_EQ(RiseRule::seen(Limb::Upper, Refraction::saemundsson(), 100).description(),
              "sunrise and sunset: upper limb of the sun on the horizon as seen from 100 m above "
              "it (dip 17.60 arc-minutes), Saemundsson's refraction, 1010 hPa, 10 C");
    EXPECT_EQ(RiseRule::seen(Limb::Lower, Refraction::standard({0, 0, 0})).description(),
              "sunrise and sunset: lower limb of the sun on the horizon, refraction integrated "
              "through the atmosphere, 1013 hPa, 15.0 C, 0 m");
    EXPECT_EQ(RiseRule::seen(Limb::Center, Refraction::none()).description(),
              "sunrise and sunset: centre of the sun on the horizon, no refraction");
}

TEST(RiseRule, ADipCanBeGivenItself) {
    const Refraction air = Refraction::standard(kBern);
    const RiseRule by_eye = RiseRule::seen(Limb::Upper, air, 100);
    EXPECT_NEAR(
        RiseRule::seen_over_dip(Limb::Upper, air, radians(17.6 / 60)).center_elevation_rad(1),
        by_eye.center_elevation_rad(1), 1e-9);
    EXPECT_EQ(RiseRule::seen_over_dip(Limb::Center, Refraction::none(), radians(0.5)).description(),
              "sunrise and sunset: centre of the sun on the horizon 30.00 arc-minutes below the "
              "level one, no refraction");
    EXPECT_EQ(test::error_of([&] { RiseRule::seen_over_dip(Limb::Upper, air, radians(6.0)); }),
              "exit 3: sunrise: dip of the horizon 6 degrees: impossible, expected 0 to 5");
}

TEST(RiseRule, AnImpossibleEyeIsAnError) {
    EXPECT_EQ(
        test::error_of([] { RiseRule::seen(Limb::Upper, Refraction::none(), -3); }),
        "exit 3: sunrise: eye height -3 m: impossible, expected 0 to 10000 above the sea or plain");
}

}  // namespace
}  // namespace relevo::sun::test_rise_rule
