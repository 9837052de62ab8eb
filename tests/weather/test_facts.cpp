#include <algorithm>

#include <fmt/format.h>

#include "support/support.h"
#include "weather/facts.h"

namespace relevo::weather {
namespace {

Facts facts(const std::string& text, double station_m = 510) {
    return facts_of(parse_metar(text), station_m);
}

TEST(WeatherFacts, BasesCountFromTheStation) {
    const Facts f = facts("LSZB 011150Z 24009KT 9999 -SHRA FEW015 BKN040 OVC080 17/13 Q1014");
    EXPECT_EQ(f.words, (std::vector<std::string>{"rainy", "cloudy"}));
    EXPECT_NEAR(*f.figure("deck_1_base_m"), 510 + 457.2, 1e-9);
    EXPECT_NEAR(*f.figure("deck_2_base_m"), 510 + 1219.2, 1e-9);
    EXPECT_NEAR(*f.figure("deck_3_base_m"), 510 + 2438.4, 1e-9);
    EXPECT_EQ(f.figure("deck_1_cover"), 3.0 / 16);
    EXPECT_EQ(f.figure("rain"), 0.6);
    EXPECT_NEAR(*f.figure("wind_m_s"), 4.63, 1e-9);
    EXPECT_FALSE(f.figure("visibility_km"));  // 9999 is no visibility, but 10 km or more
    for (const auto& [name, value] : f.figures)
        EXPECT_TRUE(std::ranges::count(fact_figures(), name)) << name;
}

TEST(WeatherFacts, TopsAreAboveBases) {
    const Facts f = facts("LSZB 011150Z 24009KT 9999 FEW015CB SCT250 BKN300TCU BKN100 17/13 Q1014");
    for (const char* const deck : {"deck_1", "deck_2", "deck_3"})
        EXPECT_GT(*f.figure(fmt::format("{}_top_m", deck)),
                  *f.figure(fmt::format("{}_base_m", deck)) + 100);
    EXPECT_FALSE(f.figure("deck_4_cover"));
}

TEST(WeatherFacts, VisibilityOfFogIsNotThatOfTheAirAbove) {
    const Facts fog = facts("LSZB 010550Z 00000KT 0300 FG VV001 03/03 Q1025");
    EXPECT_EQ(fog.words, std::vector<std::string>{"foggy"});
    EXPECT_EQ(fog.figure("fog_visibility_m"), 300);
    EXPECT_GT(*fog.figure("fog_top_m"), 510);
    EXPECT_FALSE(fog.figure("visibility_km"));
    EXPECT_EQ(facts("LSZB 010550Z 00000KT 3000 BR NSC 03/03 Q1025").figure("visibility_km"), 3);
    const Facts snow = facts("LSZB 010550Z 00000KT 1200 SN OVC010 M03/M03 Q1005");
    EXPECT_EQ(snow.words, (std::vector<std::string>{"snowy", "cloudy"}));
    EXPECT_EQ(snow.figure("snow_visibility_m"), 1200);
}

TEST(WeatherFacts, ClearSkiesHaveDecksWithoutCover) {
    const Facts f = facts("LSZB 011150Z VRB01KT CAVOK 20/10 Q1020");
    EXPECT_TRUE(f.words.empty());
    for (const char* deck : {"deck_1_cover", "deck_2_cover", "deck_3_cover"})
        EXPECT_EQ(f.figure(deck), 0) << deck;
    EXPECT_EQ(facts("KSEA 011800Z 9999").figure("deck_1_cover"), std::nullopt);
    EXPECT_EQ(summary(parse_metar("LSZB 011150Z VRB01KT CAVOK 20/10 Q1020")),
              "LSZB, day 1, 11:50 UTC: wind 0.5 m/s, variable, visibility 10.0 km or more, no "
              "clouds, 20 C, 1020 hPa");
}

TEST(WeatherFacts, TheThickestAirIsNotTheClearest) {
    // A parameter of 0 stands for none.
    EXPECT_EQ(facts_of(parse_metar("KSEA 011800Z 0000 DS"), 0).figure("visibility_km"), 0.05);
}

}  // namespace
}  // namespace relevo::weather
