#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_moon_verbs {
namespace {

using nlohmann::json;

const std::string kValley = "36.30,-84.24";  // in the bundled DEM

json json_of(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    return of_one_day(json::parse(run.out));
}

std::string dem() {
    return bundled_dem();
}

TEST(MoonPositionVerb, IsWhatTheObservatoriesHave) {
    // JPL Horizons, 29 N 81 W, 10 m (tests/data/moon/horizons_airless.csv).
    const json moon = json_of({"moon", "position", "--at", "29,-81,10", "--time",
                               "2000-11-05T00:00Z", "--no-refraction"});
    EXPECT_EQ(moon["apparent_elevation_deg"], moon["elevation_deg"]);
    EXPECT_GT(moon["distance_km"], 356000);
    EXPECT_LT(moon["distance_km"], 407000);
    EXPECT_NEAR(moon["illuminated_fraction"],
                (1 + std::cos(moon["phase_angle_deg"].get<double>() * M_PI / 180)) / 2, 1e-9);
    EXPECT_EQ(moon["phase"], "waxing gibbous");
    for (const char* key : {"azimuth_deg", "elongation_deg", "bright_limb_deg",
                            "bright_limb_from_zenith_deg", "phase_longitude_deg", "age_d"})
        EXPECT_TRUE(moon[key].is_number()) << key;
    EXPECT_FALSE(moon.contains("equation_of_time_min"));
}

TEST(MoonPositionVerb, TakesManyPlaces) {
    const std::filesystem::path points = scratch_dir("points") / "points.csv";
    std::ofstream(points) << "name,lat,lon\nnorth,60,10\nsouth,-60,10\n";
    const Result run = relevo(
        {"moon", "position", "--points", points.string(), "--time", "2026-03-25T20:00Z", "--csv"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("bright_limb_from_zenith_deg,phase_longitude_deg,age_d,phase,error"),
              std::string::npos)
        << run.out;
    EXPECT_NE(run.out.find("north,60,10,"), std::string::npos);
    EXPECT_NE(run.out.find(",first quarter,"), std::string::npos);
}

TEST(MoonDayVerb, HasItsEventsPhasesAndDefinition) {
    const json day = json_of({"moon", "day", "--at", "46.55,8.56", "--date", "2026-03-25"});
    EXPECT_EQ(day["phase"], "first quarter");
    ASSERT_EQ(day["phases"].size(), 1U);
    EXPECT_EQ(day["phases"][0]["phase"], "first quarter");
    EXPECT_EQ(day["phases"][0]["utc"].get<std::string>().substr(0, 16), "2026-03-25T19:17");
    EXPECT_EQ(day["definition"],
              "moonrise and moonset: upper limb of the moon 34 arc-minutes below the horizon, "
              "without refraction (U.S. Naval Observatory)");
    std::string kinds;
    for (const json& event : day["events"])
        kinds += event["kind"].get<std::string>() + " ";
    EXPECT_EQ(kinds, "moonset lower_transit moonrise transit ");
    EXPECT_TRUE(day["all_day"].is_null());
    EXPECT_NEAR(day["moon_up_h"], 16.264, 0.01);
    // A day without moonset.
    EXPECT_TRUE(
        json_of({"moon", "day", "--at", "46.55,8.56", "--date", "2026-03-23"})["moonset_utc"]
            .is_null());
    EXPECT_EQ(json_of({"moon", "day", "--at", "85,20", "--date", "2026-03-25"})["all_day"], "up");
}

TEST(MoonDayVerb, StandsMoonlightBesideTheFlatHorizon) {
    const json day =
        json_of({"moon", "day", dem(), "--at", kValley, "--date", "2026-03-25", "--limb", "upper"});
    ASSERT_EQ(day["direct_moonlight"].size(), 2U);
    EXPECT_LT(day["direct_moonlight_h"], day["moon_up_h"]);
    EXPECT_EQ(day["light_definition"].get<std::string>().substr(0, 46),
              "direct light: any part of the moon's disc over");
    const Result csv = relevo({"moon", "day", dem(), "--at", kValley, "--from", "2026-03-25",
                               "--to", "2026-03-27", "--csv"});
    EXPECT_NE(csv.out.find("phase_time,direct_moonlight,direct_moonlight_h,first_moon,last_moon,"
                           "minutes\n2026-03-25,"),
              std::string::npos)
        << csv.out;
    EXPECT_NE(csv.err.find("could hide the moon"), std::string::npos) << csv.err;
}

TEST(MoonHorizonVerb, DrawsThePathOfItsDay) {
    const std::string picture = (scratch_dir("horizon") / "moon.svg").string();
    const Result run = relevo({"moon", "horizon", dem(), "--at", kValley, "--date", "2026-03-25",
                               "-o", picture, "--overwrite"});
    EXPECT_EQ(run.status, 0) << run.err;
    std::stringstream svg;
    svg << std::ifstream(picture).rdbuf();
    for (const char* words : {"path of the moon, 25 March 2026", "Direct moonlight", "moonrise",
                              "Moonrise and moonset: upper limb"})
        EXPECT_NE(svg.str().find(words), std::string::npos) << words;
    EXPECT_EQ(svg.str().find("of the sun"), std::string::npos);
    // Its times are those of the clock, in summer too.
    EXPECT_EQ(relevo({"moon", "horizon", dem(), "--at", kValley, "--date", "2026-07-25", "-o",
                      picture, "--overwrite"})
                  .status,
              0);
    std::stringstream summer;
    summer << std::ifstream(picture).rdbuf();
    EXPECT_NE(summer.str().find("path of the moon, 25 July 2026"), std::string::npos);
    EXPECT_EQ(summer.str().find("summer time"), std::string::npos);
    EXPECT_EQ(relevo({"moon", "horizon", dem(), "--at", kValley, "--year", "2026", "-o", picture,
                      "--overwrite"})
                  .err,
              "relevo: time zone America/New_York of the place; --tz sets another\n"
              "relevo: error: --from, --to and --year: a panorama shows one day of the moon; pass "
              "--date\n");
}

TEST(MoonWhenVerb, FindsTheMoonOverASummit) {
    std::vector<std::string> arguments{"moon",
                                       "when",
                                       dem(),
                                       "--at",
                                       "36.2,-84.15",
                                       "--over",
                                       "36.1983,-84.2306",
                                       "--tolerance",
                                       "2",
                                       "--tz",
                                       "UTC",
                                       "--from",
                                       "2026-03-01",
                                       "--to",
                                       "2026-04-30",
                                       "--summit-radius",
                                       "500",
                                       "-q"};
    const json found = json_of(arguments);
    ASSERT_GE(found["passages"].size(), 2U);
    for (const json& p : found["passages"]) {
        EXPECT_LE(p["separation_deg"].get<double>(), 2);
        EXPECT_TRUE(p["moon_visible"].is_boolean() && !p.contains("sun_visible"));
        const json there = json_of(
            {"moon", "position", "--at", "36.2,-84.15,300", "--time", p["utc"].get<std::string>()});
        EXPECT_NEAR(there["azimuth_deg"].get<double>(), p["azimuth_deg"].get<double>(), 0.002);
    }
    EXPECT_NE(found["definition"].get<std::string>().find("of the moon's centre"),
              std::string::npos);
    const Result text = relevo(arguments);
    EXPECT_EQ(text.out.find("sun"), std::string::npos) << text.out;
    arguments.emplace_back("--csv");
    EXPECT_NE(relevo(arguments).out.find(",moon_visible\n"), std::string::npos);
}

TEST(SunEclipsesVerb, HasContactsAndWhatIsSeen) {
    // Burgos saw totality before sunset; fourth contact was below the horizon.
    const json found = json_of({"sun", "eclipses", "--at", "42.34,-3.70", "--year", "2026"});
    ASSERT_EQ(found["eclipses"].size(), 1U);
    const json& eclipse = found["eclipses"][0];
    EXPECT_EQ(eclipse["date"], "2026-08-12");
    EXPECT_EQ(eclipse["kind"], "total");
    EXPECT_NEAR(eclipse["central_s"], 104, 4);
    EXPECT_EQ(eclipse["greatest"]["sun"], "up");
    EXPECT_EQ(eclipse["last_contact"]["sun"], "down");
    EXPECT_EQ(eclipse["greatest_seen"], eclipse["greatest"]);
    EXPECT_EQ(eclipse["obscuration"], 1);
    // Munich on 31 May 2003: it began before sunrise.
    const json dawn = json_of({"sun", "eclipses", "--at", "48.137,11.575", "--year", "2003"});
    ASSERT_EQ(dawn["eclipses"].size(), 1U);
    EXPECT_EQ(dawn["eclipses"][0]["first_contact"]["sun"], "down");
    EXPECT_FALSE(dawn["eclipses"][0].contains("second_contact"));
    const Result none = relevo({"sun", "eclipses", "--at", "46,8", "--date", "2025-01-15"});
    EXPECT_EQ(none.status, 0);
    EXPECT_NE(none.out.find("no eclipse of the sun is seen there then"), std::string::npos);
}

TEST(SunEclipsesVerb, SaysWhatTerrainHides) {
    // A wall 1.5 km west of the place stands 13 degrees high: first contact is over it, totality at
    // 8 degrees behind it.
    Raster raster;
    raster.columns = 101;
    raster.rows = 101;
    raster.crs = "EPSG:32630";
    raster.geotransform = {{440800, 30, 0, 4689250, 0, -30}};
    raster.value = [](int column, int, int) { return column < 2 ? 1250.0 : 900.0; };
    const std::string wall = write_raster(scratch_dir("wall") / "wall.tif", raster);
    const json found = json_of({"sun", "eclipses", wall, "--at", "42.34,-3.70", "--year", "2026"});
    ASSERT_EQ(found["eclipses"].size(), 1U);
    const json& eclipse = found["eclipses"][0];
    EXPECT_EQ(eclipse["first_contact"]["sun"], "up");
    EXPECT_EQ(eclipse["second_contact"]["sun"], "behind terrain");
    EXPECT_EQ(eclipse["last_contact"]["sun"], "down");
    EXPECT_EQ(eclipse["direct_sun"].size(), 1U);
    EXPECT_LT(eclipse["greatest_seen"]["obscuration"], 0.9);
    const Result text = relevo({"sun", "eclipses", wall, "--at", "42.34,-3.70", "--year", "2026"});
    EXPECT_NE(text.out.find("behind terrain"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("most that is seen 2026-08-12T"), std::string::npos) << text.out;
    const Result csv =
        relevo({"sun", "eclipses", wall, "--at", "42.34,-3.70", "--year", "2026", "--csv"});
    EXPECT_NE(csv.out.find(",up,behind terrain,down,"), std::string::npos) << csv.out;
    EXPECT_EQ(csv.out.find("not_known"), std::string::npos) << csv.out;

    // A void nearer by may hide first contact, but the wall stands behind it all the same.
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        const bool in_void = column >= 20 && column < 30 && row >= 30 && row < 70;
        return column < 2 ? 1250.0 : in_void ? -9999.0 : 900.0;
    };
    const std::string holed = write_raster(scratch_dir("wall") / "holed.tif", raster);
    const std::vector<std::string> asked{"sun",         "eclipses", holed, "--at",
                                         "42.34,-3.70", "--year",   "2026"};
    const json unsure = json_of(asked);
    ASSERT_EQ(unsure["eclipses"].size(), 1U);
    EXPECT_EQ(unsure["eclipses"][0]["first_contact"]["sun"], "not known");
    EXPECT_EQ(unsure["eclipses"][0]["second_contact"]["sun"], "behind terrain");
    EXPECT_EQ(unsure["eclipses"][0]["not_known"].size(), 1U);
    EXPECT_GT(unsure["eclipses"][0]["not_known_h"], 0.1);
    EXPECT_TRUE(unsure.contains("hole_sectors"));
    const std::string said = relevo(asked).out;
    EXPECT_NE(said.find("elevation  18.41  not known: a void of the DEM\n"), std::string::npos)
        << said;
    EXPECT_NE(said.find("\nnot known: direct sun through voids of the DEM"), std::string::npos)
        << said;
    std::vector<std::string> as_csv = asked;
    as_csv.emplace_back("--csv");
    const std::string rows = relevo(as_csv).out;
    EXPECT_NE(rows.find(",obscuration_seen,not_known,not_known_h\n"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",not known,behind terrain,down,"), std::string::npos) << rows;
}

TEST(SunEclipsesVerb, TakesTheDaysOfAnyZone) {
    const auto dates = [](const std::string& at, const std::string& zone, const std::string& from,
                          const std::string& to) {
        const json answer =
            json_of({"sun", "eclipses", "--at", at, "--tz", zone, "--from", from, "--to", to});
        std::string found;
        for (const json& eclipse : answer["eclipses"])
            found += eclipse["date"].get<std::string>() + " ";
        return found;
    };
    // Samoa went from 29 to 31 December 2011.
    EXPECT_EQ(dates("-13.8,-172.1", "Pacific/Apia", "2011-12-30", "2012-01-31"), "");
    EXPECT_EQ(dates("-13.8,-172.1", "Pacific/Apia", "2011-12-30", "2011-12-30"), "");
    EXPECT_EQ(dates("-13.8,-172.1", "Pacific/Apia", "2009-07-01", "2011-12-30"),
              "2009-07-21 2010-07-11 ");
    // By a clock that shows midnight 42 s after the greatest eclipse, of one of the two days.
    EXPECT_EQ(dates("42.34,-3.70", "+05:30", "2026-08-12", "2026-08-12"), "2026-08-12 ");
    EXPECT_EQ(dates("42.34,-3.70", "+05:30", "2026-08-13", "2026-08-13"), "");
}

}  // namespace
}  // namespace relevo::test::test_moon_verbs
