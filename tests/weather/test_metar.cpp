#include <random>

#include <fmt/format.h>

#include "base/error.h"
#include "support/support.h"
#include "weather/metar.h"

namespace relevo::weather {
namespace {

using test::error_of;

TEST(Metar, OfBernReadsAllGroups) {
    // The example of the project's brief: a summer's noon with showers.
    const Metar r = parse_metar("LSZB 011150Z 24009KT 9999 -SHRA FEW015 BKN040 OVC080 17/13 Q1014");
    EXPECT_EQ(r.station, "LSZB");
    EXPECT_EQ(r.day, 1);
    EXPECT_EQ(r.hour, 11);
    EXPECT_EQ(r.minute, 50);
    EXPECT_FALSE(r.is_auto);
    EXPECT_NEAR(*r.wind_m_s, 9 * 0.514444, 1e-5);
    EXPECT_EQ(r.wind_from_deg, 240);
    EXPECT_EQ(r.visibility_m, 10000);
    EXPECT_TRUE(r.visibility_is_least);
    EXPECT_TRUE(r.present.rain);
    EXPECT_EQ(r.present.intensity, PresentWeather::Intensity::Light);
    ASSERT_EQ(r.clouds.size(), 3U);
    EXPECT_NEAR(*r.clouds[0].base_m, 457.2, 1e-9);
    EXPECT_NEAR(*r.clouds[1].base_m, 1219.2, 1e-9);
    EXPECT_EQ(r.clouds[1].least_oktas, 5);
    EXPECT_EQ(r.clouds[1].most_oktas, 7);
    EXPECT_EQ(r.clouds[0].cover(), 0.1875);
    EXPECT_EQ(r.clouds[1].cover(), 0.75);
    EXPECT_EQ(r.clouds[2].cover(), 1);
    EXPECT_EQ(r.temperature_c, 17);
    EXPECT_EQ(r.dew_point_c, 13);
    EXPECT_EQ(r.qnh_hpa, 1014);
}

TEST(Metar, OfTheUnitedStatesHasMilesInchesAndRemarks) {
    const Metar r = parse_metar(
        "METAR KDEN 121753Z AUTO 34012G21KT 1 1/2SM R35L/4500FT -SN BR FEW008 OVC015 M03/M05 A2992 "
        "RMK AO2 SLP172 SN10 T10281050 nonsense");
    EXPECT_TRUE(r.is_auto);
    EXPECT_NEAR(*r.gust_m_s, 21 * 0.514444, 1e-4);
    EXPECT_NEAR(*r.visibility_m, 1.5 * 1609.344, 1e-6);
    EXPECT_FALSE(r.visibility_is_least);
    EXPECT_TRUE(r.present.snow);
    EXPECT_TRUE(r.present.mist);
    EXPECT_EQ(r.temperature_c, -3);
    EXPECT_EQ(r.dew_point_c, -5);
    EXPECT_NEAR(*r.qnh_hpa, 1013.2, 0.05);  // 29.92 inches are the standard atmosphere
}

TEST(Metar, VisibilityHasItsForms) {
    const auto metres = [](const std::string& group) {
        const Metar r = parse_metar("EDDF 010000Z 00000KT " + group + " 10/05 Q1000");
        return std::pair(r.visibility_m.value_or(-1), r.visibility_is_least);
    };
    EXPECT_EQ(metres("CAVOK"), std::pair(10000.0, true));
    EXPECT_EQ(metres("P6SM"), std::pair(6 * 1609.344, true));
    EXPECT_EQ(metres("M1/4SM"), std::pair(0.25 * 1609.344, false));
    EXPECT_EQ(metres("2SM"), std::pair(2 * 1609.344, false));
    EXPECT_EQ(metres("0800"), std::pair(800.0, false));
    EXPECT_EQ(metres("4000NDV"), std::pair(4000.0, false));
    EXPECT_EQ(metres("3000 1500SW"), std::pair(3000.0, false));
    EXPECT_EQ(metres("////"), std::pair(-1.0, false));
}

TEST(Metar, SkiesWithoutCloudsAreClear) {
    for (const char* const group : {"NSC", "NCD", "SKC", "CLR", "CAVOK"}) {
        const Metar r = parse_metar(fmt::format("EDDF 010000Z VRB02KT {} 10/05 Q1000", group));
        EXPECT_TRUE(r.sky_is_clear) << group;
        EXPECT_TRUE(r.clouds.empty()) << group;
        EXPECT_FALSE(r.wind_from_deg) << group;
    }
    EXPECT_FALSE(parse_metar("EDDF 010000Z 00000KT 9999 FEW020 10/05 Q1000").sky_is_clear);
}

TEST(Metar, CloudsHaveKindsAndUnknownBases) {
    const Metar r = parse_metar("EGLL 010000Z 09005MPS 9999 SCT025CB BKN030TCU OVC/// 10/05 Q1000");
    EXPECT_EQ(r.wind_m_s, 5);
    EXPECT_EQ(r.clouds[0].kind, CloudLayer::Kind::Cumulonimbus);
    EXPECT_EQ(r.clouds[1].kind, CloudLayer::Kind::ToweringCumulus);
    EXPECT_FALSE(r.clouds[2].base_m);
    const Metar obscured = parse_metar("EGLL 010000Z AUTO 00000KT 0100 FG VV001 M00/M00 Q1000=");
    EXPECT_NEAR(*obscured.vertical_visibility_m, 30.48, 1e-9);
    EXPECT_TRUE(obscured.present.fog);
    EXPECT_EQ(obscured.temperature_c, 0);
}

TEST(Metar, WeatherNearbyIsNotAtTheStation) {
    const Metar r = parse_metar("EGLL 010000Z 00000KT 9999 VCSH VCFG FEW020 10/05 Q1000");
    EXPECT_FALSE(r.present.rain);
    EXPECT_FALSE(r.present.fog);
}

TEST(Metar, NonsenseNamesTheGroup) {
    const auto error = [](const std::string& text) { return error_of([&] { parse_metar(text); }); };
    EXPECT_EQ(error("LSZB 011150Z 24009KT 9999 BKNX40 17/13 Q1014"),
              "exit 3: weather: METAR LSZB: \"BKNX40\": it is no group of a METAR that has a "
              "meaning here");
    EXPECT_EQ(
        error("LSZB 321150Z 24009KT"),
        "exit 3: weather: METAR LSZB: \"321150Z\": expected a day of 01 to 31, an hour to 23 and a "
        "minute to 59");
    EXPECT_EQ(
        error("LSZB 011150Z 40009KT"),
        "exit 3: weather: METAR LSZB: \"40009KT\": expected a direction of 000 to 360 degrees");
    EXPECT_EQ(error("LSZB 011150Z 13/17 Q1014"),
              "exit 3: weather: METAR LSZB: \"13/17\": expected a dew point that is not above the "
              "temperature");
    EXPECT_EQ(error("LSZB 011150Z Q0140"),
              "exit 3: weather: METAR LSZB: \"Q0140\": expected 850 to 1100 hPa at sea level but "
              "got 140");
    EXPECT_EQ(error("METAR LSZB NIL="),
              "exit 3: weather: METAR LSZB: \"NIL\": the station has sent no report");
    EXPECT_EQ(
        error("bern 011150Z"),
        "exit 3: weather: METAR: \"bern\": expected a station of four letters or digits, such as "
        "LSZB");
    EXPECT_EQ(error(""),
              "exit 3: weather: METAR: expected a station, a time and groups of weather but got "
              "nothing");
}

TEST(Metar, GroupsThatSayNothingOfThePictureAreSkipped) {
    const Metar read = parse_metar(
        "LSZB 011150Z 240ABV49KT 9999 ///015 BKN040 WS R24L WS R06 88290195 17/13 Q1014 QFE742 "
        "BLACKWHT FM1230 OVC002");
    EXPECT_NEAR(*read.wind_m_s, 49 * 1852.0 / 3600, 1e-9);
    ASSERT_EQ(read.clouds.size(), 1u);  // the forecast is none
    EXPECT_EQ(read.clouds[0].most_oktas, 7);
    EXPECT_EQ(*read.qnh_hpa, 1014);
    EXPECT_EQ(parse_metar("KSEA 011800Z 24009KT 10SM CLR 17/10 A2992 $").clouds.size(), 0u);
}

TEST(Metar, StatesOfRunwaysAreSkipped) {
    for (const char* group : {"R/SNOCLO", "R24/SNOCLO", "SNOCLO", "24CLRD70", "R24/CLRD70",
                              "14LCLRD//", "R88/CLRD//", "88CLRD95"}) {
        const Metar read = parse_metar(std::string("LSZB 051250Z 24009KT 9999 BKN040 M01/M02 ") +
                                       group + " Q1014");
        EXPECT_EQ(read.clouds.size(), 1u) << group;
        EXPECT_FALSE(read.sky_is_clear) << group;
        EXPECT_EQ(*read.qnh_hpa, 1014) << group;
    }
    EXPECT_THROW(parse_metar("LSZB 051250Z 4CLRD70"), Error);
}

TEST(Metar, VisibilityInKilometres) {
    const Metar far = parse_metar("SKBO 051250Z 24009KT 20KM FEW015 17/13 Q1014");
    EXPECT_EQ(*far.visibility_m, 20000);
    EXPECT_FALSE(far.visibility_is_least);
    EXPECT_EQ(*parse_metar("SKBO 051250Z 8KM").visibility_m, 8000);
    EXPECT_TRUE(parse_metar("SKBO 051250Z P15KM").visibility_is_least);
    EXPECT_THROW(parse_metar("SKBO 051250Z KM"), Error);
    EXPECT_THROW(parse_metar("SKBO 051250Z 2XKM"), Error);
}

TEST(Metar, ADateOfAnArchiveIsSkipped) {
    for (const char* date : {"2024-01-05 12:50 METAR ", "202401051250 METAR ", "2024-01-05 12:50 ",
                             "2024/01/05 12:50 ", "2024-01-05T12:50Z METAR COR ", "METAR "}) {
        const std::string text = date + std::string("LSZB 051250Z 24009KT 9999 17/13 Q1014");
        EXPECT_TRUE(is_report(text)) << text;
        const Metar read = parse_metar(text);
        EXPECT_EQ(read.station, "LSZB") << text;
        EXPECT_EQ(read.day, 5) << text;
        EXPECT_EQ(*read.qnh_hpa, 1014) << text;
    }
    EXPECT_THROW(parse_metar("2024-01-05 12:50"), Error);
    EXPECT_THROW(parse_metar("2024-1-5 LSZB 051250Z"), Error);
}

TEST(Metar, SnowThatTheWindRaisesDoesNotFall) {
    EXPECT_FALSE(parse_metar("LSZB 011150Z 9999 DRSN").present.snow);
    EXPECT_FALSE(parse_metar("LSZB 011150Z 2000 BLSN").present.snow);
    EXPECT_TRUE(parse_metar("LSZB 011150Z 2000 -SN BLSN").present.snow);
}

// Whatever comes is a report or an error of one line.
TEST(Metar, RandomBytesAreReadOrRefused) {
    std::mt19937 random(7);
    const std::string report =
        "METAR LSZB 011150Z AUTO 24009G20KT 210V270 1 1/2SM R14/P2000 -SHRA FEW015 BKN040CB VV002 "
        "M01/M02 Q1014 NOSIG";
    int read = 0, refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = report;
        const int changes = 1 + static_cast<int>(random() % 8);
        for (int c = 0; c < changes; ++c) {
            const std::size_t at = random() % text.size();
            if (random() % 3 == 0)
                text.erase(at, 1 + random() % 4);
            else
                text[at] = static_cast<char>(random() % 2 ? random() % 256 : report[random() % 60]);
            if (text.empty()) break;
        }
        try {
            parse_metar(text);
            ++read;
        } catch (const Error& error) {
            ++refused;
            EXPECT_EQ(error.code(), ErrorCode::BadInput);
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
        }
    }
    EXPECT_GT(read, 200);
    EXPECT_GT(refused, 5000);
}

}  // namespace
}  // namespace relevo::weather
