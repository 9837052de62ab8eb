#include "base/units.h"
#include "dem/unit.h"
#include "support/support.h"

namespace relevo::dem::test_unit {
namespace {

TEST(Unit, WordsOfFilesAndPeople) {
    const struct {
        const char* word;
        const char* name;
        double metres;
    } cases[] = {
        {"m", "m", 1},
        {"Metre", "m", 1},
        {"meters", "m", 1},
        {"ft", "ft", 0.3048},
        {"Feet", "ft", 0.3048},
        {"international foot", "ft", 0.3048},
        {"us-ft", "us-ft", 1200.0 / 3937},
        {"US survey foot", "us-ft", 1200.0 / 3937},
        {"Foot_US", "us-ft", 1200.0 / 3937},
        {"ftUS", "us-ft", 1200.0 / 3937},
        {"cm", "cm", 0.01},
        {"centimeters", "cm", 0.01},
        {"km", "km", 1000},
        {"[m]", "m", 1},
        {"gpm", "m", 1},
        {"metres above EGM96", "m", 1},
        {"Meters (NAVD88)", "m", 1},
        {"m a.s.l.", "m", 1},
        {"foot (US survey) above NAVD88", "us-ft", 1200.0 / 3937},
    };
    for (const auto& c : cases)
        EXPECT_EQ(known_unit(c.word), (Unit{c.name, c.metres})) << c.word;
    for (const char* word : {"", "furlong", "degree", "K", "m/s", "1", "m/m", "m2", "m**2 s**-2",
                             "0.001 m", "[dB]", "[-]"})
        EXPECT_FALSE(known_unit(word)) << word;
}

TEST(Unit, SomeWordsSayThatThereIsNone) {
    for (const char* word : {"", " ", "unknown", "Unspecified", "none", "N/A"})
        EXPECT_TRUE(means_no_unit(word)) << word;
    for (const char* word : {"m", "furlong", "1"})
        EXPECT_FALSE(means_no_unit(word)) << word;
}

TEST(Unit, TheTwoFeetAreToldApart) {
    EXPECT_EQ(unit_of(0.3048, "x").name, "ft");
    EXPECT_EQ(unit_of(0.304800609601219, "x").name, "us-ft");
    EXPECT_EQ(unit_of(1.8288, "fathom"), (Unit{"fathom", 1.8288}));
}

TEST(Unit, ErrorsNameTheUnits) {
    EXPECT_EQ(test::error_of([] { parse_unit("furlong", "--unit"); }),
              "exit 2: --unit: furlong: a unit of height, expected m, ft, us-ft, cm, mm, dm or km");
    EXPECT_EQ(test::error_of([] { parse_unit(" ", "--unit"); }),
              "exit 2: --unit: \"\": a unit of height, expected m, ft, us-ft, cm, mm, dm or km");
    EXPECT_EQ(parse_unit("FT", "--unit").metres, kFoot_m);
}

}  // namespace
}  // namespace relevo::dem::test_unit
