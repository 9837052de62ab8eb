#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

/// The verbs under `relevo sun` where the ground is not what a figure needs: holes, edges, heights
/// and eyes that no landscape has; and values that mean nothing.
namespace relevo::test::test_sun_ground {
namespace {

using nlohmann::json;

const std::string kZurich = "Europe/Zurich";
const std::string kHere = "46.98679,9.0";  // the middle of ridge(): column 100, row 100

std::filesystem::path dir() {
    static const std::filesystem::path folder = scratch_dir("cli_sun_ground");
    return folder;
}
std::string out(const std::string& name) {
    return (dir() / name).string();
}

/// A plain of 30 m posts at 100 m, with a ridge of 420 m 2400 m to the west of the middle, which
/// has a gap of five posts. Ten degrees high, it hides the evening sun.
std::string ridge(const std::string& name, double in_the_gap_m, double factor = 1) {
    Raster raster;
    raster.columns = raster.rows = 201;
    raster.geotransform = {{496985, 30, 0, 5206715, 0, -30}};
    raster.value = [=](int column, int row, int) {
        // Not quite level, or its edge would look like one that was added.
        const double height_m = column != 20              ? 100.0 + 0.001 * (column + row - 200)
                                : row >= 98 && row <= 102 ? in_the_gap_m
                                                          : 520.0;
        return factor * height_m;
    };
    return write_raster(dir() / name, raster);
}
const std::string& holed() {
    static const std::string path = ridge("holed.tif", std::numeric_limits<double>::quiet_NaN());
    return path;
}
const std::string& whole() {
    static const std::string path = ridge("whole.tif", 520);
    return path;
}

std::vector<std::string> verb(const std::string& name, const std::string& dem,
                              const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"sun", name, dem, "--at", kHere};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
}
const std::vector<std::string> kEvening{"--date", "2026-04-01", "--tz", kZurich};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

json json_of(const std::vector<std::string>& arguments) {
    const Result run = relevo(with(arguments, {"--json"}));
    EXPECT_EQ(run.status, 0) << run.err;
    return of_one_day(json::parse(run.out));
}

/// How often a text comes.
int count(const std::string& text, const std::string& piece) {
    int found = 0;
    for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1))
        ++found;
    return found;
}

TEST(Holes, LightThroughThemIsSaidNotToBeKnown) {
    const std::vector<std::string> day = with(verb("day", holed(), kEvening), {"--highest", "0"});
    const Result run = relevo(day);
    ASSERT_EQ(run.status, 0) << run.err;
    // Two spells; the second is there only because of the hole.
    EXPECT_EQ(count(run.out, "direct sun          "), 2) << run.out;
    EXPECT_EQ(count(run.out, "  not known: a void of the DEM\n"), 1) << run.out;
    EXPECT_EQ(count(run.out, ", of it 0:2"), 1) << run.out;
    EXPECT_EQ(count(run.out,
                    "not known: direct sun through voids of the DEM from azimuth 268 (W) to 272 "
                    "(W), where ground as high as its highest post would hide it\n"),
              1)
        << run.out;
    EXPECT_TRUE(
        run.err.starts_with("relevo: warning: the DEM has voids from azimuth 268 (W) to 272 (W): "
                            "of the direct sun 0:2"))
        << run.err;
    EXPECT_TRUE(run.err.ends_with(
        " is not known, as ground in them could hide it; use a DEM without voids\n"))
        << run.err;
    const json object = json_of(day);
    ASSERT_EQ(object["direct_sun"].size(), 2U);
    EXPECT_FALSE(object["direct_sun"][0].contains("not_known"));
    const json& second = object["direct_sun"][1];
    ASSERT_EQ(second["not_known"].size(), 1U);
    EXPECT_EQ(second["not_known"][0]["begin_utc"], second["first_utc"]);
    EXPECT_EQ(second["not_known"][0]["end_utc"], second["last_utc"]);
    EXPECT_NEAR(object["hole_sectors"][0]["from_azimuth_deg"].get<double>(), 268, 0.5);
    EXPECT_GT(object["not_known_h"], 0.1);
    const std::string csv = relevo(with(day, {"--csv"})).out;
    EXPECT_EQ(
        count(csv, ",direct_sun,direct_sun_h,first_sun,last_sun,minutes,not_known,not_known_h\n"),
        1)
        << csv;
    EXPECT_EQ(count(csv, "# not known: direct sun through voids of the DEM"), 1) << csv;
    const std::string days =
        relevo(verb("day", holed(),
                    {"--from", "2026-04-01", "--to", "2026-04-02", "--tz", kZurich, "-q"}))
            .out;
    EXPECT_EQ(count(days, " not known\n"), 2) << days;

    ASSERT_EQ(relevo(with(day, {"-o", out("day.svg"), "--overwrite", "-q"})).status, 0);
    const std::string svg = read_text(out("day.svg"), "test");
    EXPECT_EQ(count(svg, "void of the DEM: the horizon may be higher"), 1);
    EXPECT_EQ(count(svg, "min of it not known because of voids in the DEM"), 1);

    // Without a hole, and on a day whose sun does not come by it, not a word.
    for (const auto& arguments :
         {with(verb("day", whole(), kEvening), {"--highest", "0"}),
          verb("day", holed(), {"--date", "2026-12-21", "--tz", kZurich, "--highest", "0"})}) {
        const Result silent = relevo(arguments);
        EXPECT_EQ(silent.err, "");
        EXPECT_EQ(count(silent.out, "not known"), 0) << silent.out;
        EXPECT_FALSE(json_of(arguments).contains("hole_sectors"));
    }
}

TEST(Holes, AreSaidOfHorizonCarpetAndSummit) {
    const Result horizon = relevo(verb("horizon", holed(), {"--highest", "0"}));
    EXPECT_EQ(count(horizon.err,
                    "relevo: warning: the DEM has voids from azimuth 268 (W) to 272 (W): ground in "
                    "them could raise the horizon; use a DEM without voids\n"),
              1)
        << horizon.err;
    EXPECT_EQ(count(horizon.out, "  not known: a void of the DEM\n"), 1) << horizon.out;
    EXPECT_EQ(count(horizon.out, "not known: the horizon from azimuth 268 (W) to 272 (W), "), 1);
    const json object = json_of(verb("horizon", holed(), {"-q"}));
    EXPECT_EQ(object["hole_sectors"].size(), 1U);
    EXPECT_EQ(count(relevo(verb("horizon", holed(), {"-q", "--csv"})).out, "# not known: "), 1);
    ASSERT_EQ(relevo(with(verb("horizon", holed(), kEvening), {"-q", "-o", out("h.svg")})).status,
              0);
    EXPECT_EQ(count(read_text(out("h.svg"), "test"), "void of the DEM: the horizon may be higher"),
              1);

    const std::vector<std::string> year{"--year", "2026", "--tz", kZurich, "--step", "1h"};
    const Result carpet = relevo(with(verb("carpet", holed(), year), {"--highest", "0"}));
    EXPECT_EQ(count(carpet.err,
                    "relevo: warning: the DEM has voids from azimuth 268 (W) to 272 (W): of the "
                    "direct sun "),
              1)
        << carpet.err;
    EXPECT_EQ(count(carpet.out, " h of the direct sun, through voids of the DEM from azimuth 268"),
              1)
        << carpet.out;
    const json hours = json_of(with(verb("carpet", holed(), year), {"-q"}));
    EXPECT_GT(hours["not_known_h"], 1);
    EXPECT_EQ(hours["hole_sectors"].size(), 1U);
    EXPECT_FALSE(json_of(with(verb("carpet", whole(), year), {"-q"})).contains("not_known_h"));
    ASSERT_EQ(relevo(with(verb("carpet", holed(), year), {"-q", "-o", out("c.svg")})).status, 0);
    EXPECT_EQ(count(read_text(out("c.svg"), "test"), "not known because of voids in the DEM"), 2);

    // A point 300 m over the plain behind the gap, seen through it.
    const std::vector<std::string> over{"--over", "46.98679,8.962,300", "--year", "2026", "--tz",
                                        kZurich};
    const Result when = relevo(verb("when", holed(), over));
    EXPECT_EQ(
        count(when.out, "not known           whether it is visible, through a void of the DEM\n"),
        1)
        << when.out << when.err;
    EXPECT_EQ(
        count(when.err,
              "relevo: warning: the DEM has voids in the way: ground in them could hide the summit "
              "or the sun over it; use a DEM without voids"),
        1)
        << when.err;
    EXPECT_EQ(json_of(with(verb("when", holed(), over), {"-q"}))["sight"]["hole"], true);
    EXPECT_EQ(relevo(verb("when", whole(), over)).err, "");
}

TEST(Edge, MattersWhereTheSunStandsAndHasAHeight) {
    // The plain is 3 km wide to all sides and its horizon level: terrain of 520 m beyond could
    // stand over it everywhere. A December sun keeps to the south.
    const std::vector<std::string> winter{"--date", "2026-12-21", "--tz", kZurich};
    const Result day = relevo(verb("day", whole(), winter));
    EXPECT_TRUE(day.err.starts_with(
        "relevo: warning: mountains of up to 520 m (the DEM's highest post) outside the DEM could "
        "hide the sun: above 1"))
        << day.err;
    // 8.7 km over the plain are seen over a level horizon from 359 km, by the refraction taken.
    EXPECT_NE(day.err.find("; those of up to 8850 m (the Earth's highest) as far as 35"),
              std::string::npos)
        << day.err;
    EXPECT_EQ(count(day.err, " m from azimuth 12"), 1) << day.err;
    EXPECT_EQ(count(day.err, " m from azimuth "), 1) << day.err;
    EXPECT_EQ(count(day.err, " (N) "), 0) << day.err;
    const Result horizon = relevo(verb("horizon", whole(), {}));
    EXPECT_TRUE(
        horizon.err.starts_with("relevo: warning: mountains of up to 520 m (the DEM's highest "
                                "post) outside the DEM could raise the horizon: above 10"))
        << horizon.err;
    EXPECT_NE(horizon.err.find(" m from azimuth 321 (NW) to 219 (SW) "), std::string::npos)
        << horizon.err;
    // A year's suns are more than a day's, and less than all round.
    const auto sectors = [&](const std::vector<std::string>& days) {
        return relevo(with(verb("day", whole(), days), {"--csv"})).err;
    };
    EXPECT_NE(sectors({"--year", "2026", "--tz", kZurich}), day.err);
    EXPECT_EQ(count(sectors({"--year", "2026", "--tz", kZurich}), " (N) "), 0);
    EXPECT_EQ(sectors({"--date", "2026-12-21", "--tz", kZurich}), day.err);
    // The sun over a point is as low as that point.
    const std::vector<std::string> over{"--over", "46.98679,9.03,150", "--year", "2026", "--tz",
                                        kZurich};
    const Result when = relevo(verb("when", whole(), over));
    EXPECT_TRUE(
        when.err.starts_with("relevo: warning: mountains of up to 520 m (the DEM's highest post) "
                             "outside the DEM could hide the summit or the sun: above 1"))
        << when.err;
    const Result bounded = relevo(verb("horizon", whole(), {"--highest", "900"}));
    EXPECT_TRUE(bounded.err.starts_with(
        "relevo: warning: mountains of up to 900 m outside the DEM could raise the horizon: "))
        << bounded.err;
    EXPECT_EQ(bounded.err.find("8850"), std::string::npos) << bounded.err;
    EXPECT_EQ(relevo(with(verb("when", whole(), over), {"--highest", "50"})).err, "");
    // In a polar night no terrain matters.
    Raster north;
    north.columns = north.rows = 21;
    north.geotransform = {{500000, 30, 0, 8800000, 0, -30}};
    north.value = [](int column, int row, int) { return column == 3 ? 900.0 : 100 + 0.001 * row; };
    const std::string path = write_raster(dir() / "north.tif", north);
    const json center = json_of({"info", path})["center"];
    const std::string at =
        fmt::format("{},{}", center["lat_deg"].get<double>(), center["lon_deg"].get<double>());
    const Result night = relevo(
        {"sun", "day", path, "--at", at, "--date", "2026-12-21", "--tz", "Arctic/Longyearbyen"});
    EXPECT_EQ(night.status, 0);
    EXPECT_EQ(night.err, "");
}

TEST(Eye, OfNoLandscapeIsRefused) {
    for (const auto& [name, options] :
         {std::pair<std::string, std::vector<std::string>>{"day", kEvening},
          {"horizon", {}},
          {"carpet", {"--year", "2026", "--tz", kZurich}},
          {"when", {"--over", "46.99,9.0", "--year", "2026", "--tz", kZurich}}}) {
        for (const std::string height : {"1e9", "1e308", "10101", "20000agl"}) {
            const Result run =
                relevo(with({"sun", name, whole(), "--at", kHere + "," + height}, options));
            EXPECT_EQ(run.status, 3) << name << " " << height;
            EXPECT_NE(run.err.find("expected at most 10000 m above the ground, which is at 100.0 m "
                                   "there; the refraction model does not hold above"),
                      std::string::npos)
                << run.err;
        }
        for (const std::string height : {"99.9", "-1e9", "-1e308", "-1agl"}) {
            const Result run =
                relevo(with({"sun", name, whole(), "--at", kHere + "," + height}, options));
            EXPECT_EQ(run.status, 3) << name << " " << height;
            EXPECT_NE(run.err.find(" is under the ground, which is at 100.0 m there"),
                      std::string::npos)
                << run.err;
        }
        for (const std::string height : {"nan", "inf", "1e309", "", "-nan", "1 000"}) {
            const Result run =
                relevo(with({"sun", name, whole(), "--at", kHere + "," + height}, options));
            EXPECT_EQ(run.status, 2) << name << " " << height;
            EXPECT_NE(run.err.find("height, expected a number of metres"), std::string::npos)
                << run.err;
        }
    }
    for (const std::string height : {"1e9", "20001", "-12001", "1e308agl"}) {
        const Result run = relevo(verb(
            "when", whole(), {"--over", "46.99,9.0," + height, "--year", "2026", "--tz", kZurich}));
        EXPECT_EQ(run.status, 3) << height;
        EXPECT_NE(run.err.find("expected -12000 to 20000; no landscape has such a height"),
                  std::string::npos)
            << run.err;
    }
}

TEST(Ground, InCentimetresIsRefusedUnlessItsUnitIsGiven) {
    const std::string path = ridge("centimetres.tif", 52'000, 1000);
    const auto captured = [&](const char* unit) {
        return relevo({"capture", path, "-o", out("cm.png"), "--size", "64x48", "--time",
                       "2026-06-21T12:00Z", "--only", "", "--overwrite", "--allow-blank", "--unit",
                       unit});  // a mast of 5 km is narrower than a pixel
    };
    const Result picture = captured("cm");
    EXPECT_EQ(picture.status, 0) << picture.err;
    EXPECT_EQ(captured("m").status, 0);  // who insists gets a mast of 520 km
    EXPECT_EQ(relevo({"info", path, "--time", "2026-06-21T12:00Z"}).status, 0);
    for (const auto& arguments : {verb("day", path, kEvening), verb("horizon", path, {})}) {
        const Result run = relevo(with(arguments, {"-q"}));
        EXPECT_EQ(run.status, 3);
        EXPECT_NE(run.err.find("add --unit cm (998 to 5200 m) or mm"), run.err.npos) << run.err;
        const Result insisted = relevo(with(arguments, {"-q", "--unit", "m"}));
        EXPECT_EQ(insisted.status, 3);
        EXPECT_EQ(count(insisted.err,
                        "the ground is at 100000 m there, expected a height of the Earth; "
                        "pass --unit cm where the DEM's heights are centimetres, or "
                        "--nodata V where V is no height\n"),
                  1)
            << insisted.err;
    }
    // As it says.
    EXPECT_EQ(relevo(with(verb("day", path, kEvening), {"--unit", "cm", "-q"})).status, 0);

    const auto position = [](const std::string& height) {
        return relevo(
            {"sun", "position", "--at", "46.9,8.9," + height, "--time", "2026-06-21T12:00Z"});
    };
    const Result high = position("60000");
    EXPECT_EQ(high.status, 0) << high.err;
    EXPECT_NE(high.out.find("no refraction, above the air at 60000 m"), std::string::npos)
        << high.out;
    EXPECT_EQ(position("-4000").status, 0);
    EXPECT_EQ(position("1e9").status, 3);
    EXPECT_EQ(position("1e9").err,
              "relevo: error: sun: height 1000000000 m: no place on Earth, expected -12000 "
              "to 100000 m above the ellipsoid\n");
}

TEST(Years, BeyondTheCalendarAreRefusedWithTheRangeThereIs) {
    const auto refused = [](const std::vector<std::string>& arguments) {
        const Result run = relevo(arguments);
        EXPECT_TRUE(run.status == 2 || run.status == 3) << run.status;
        EXPECT_NE(run.err.find("sun and moon are computed for the years 1900 to 2100"),
                  std::string::npos)
            << run.err;
    };
    const std::string at = "46.9,8.9";
    for (const std::string year :
         {"99999", "2101", "1899", "0", "-5", "99999999999", "-99999999999999999999999"}) {
        refused({"sun", "day", "--at", at, "--year", year, "--tz", "UTC"});
        refused({"sun", "carpet", whole(), "--at", kHere, "--year", year, "--tz", "UTC"});
    }
    for (const std::string year : {"99999", "2101", "1899", "0000", "9999", "99999999999"}) {
        const std::string date = year + "-06-21";
        refused({"sun", "day", "--at", at, "--date", date, "--tz", "UTC"});
        refused({"sun", "day", "--at", at, "--from", "2026-01-01", "--to", date, "--tz", "UTC"});
        refused({"sun", "day", "--at", at, "--from", date, "--to", "2026-01-01", "--tz", "UTC"});
        refused({"sun", "position", "--at", at, "--time", date + "T12:00Z"});
        refused({"sun", "position", "--at", at, "--time", date + " sunrise", "--tz", "UTC"});
        refused(
            {"sun", "position", "--at", at, "--time", "sunrise", "--date", date, "--tz", "UTC"});
        refused({"info", whole(), "--time", date + "T12:00Z"});
    }
}

TEST(Refraction, LeftOutWithoutALimbIsLeftOutEverywhere) {
    // The upper limb on the horizon, 16 minutes of arc down, against the Naval Observatory's 50: at
    // 46.9 N in March the sun takes 34 / (15 cos 46.9) = 3 min 19 s for the difference.
    const auto day = [](const std::vector<std::string>& options) {
        return json_of(with(
            {"sun", "day", "--at", "46.9,8.9", "--date", "2026-03-20", "--tz", "UTC"}, options));
    };
    const auto seconds = [](const json& of, const char* key) {
        const std::string text = of[key].get<std::string>().substr(11);
        return 3600 * *parse_number(text.substr(0, 2)) + 60 * *parse_number(text.substr(3, 2)) +
               *parse_number(text.substr(6, 6));
    };
    const json usual = day({}), none = day({"--no-refraction"});
    EXPECT_NEAR(seconds(none, "sunrise_utc") - seconds(usual, "sunrise_utc"), 199, 3);
    EXPECT_NEAR(seconds(usual, "sunset_utc") - seconds(none, "sunset_utc"), 199, 3);
    EXPECT_EQ(none["definition"],
              "sunrise and sunset: upper limb of the sun on the horizon, no refraction");
    EXPECT_EQ(day({"--refraction", "none"}), none);
    // Beside a DEM, of the light, of the level horizon, of the paths and of passages.
    const auto text = [](const std::vector<std::string>& arguments) {
        const Result run = relevo(with(arguments, {"--no-refraction", "-q"}));
        EXPECT_EQ(run.status, 0) << run.err;
        return run.out;
    };
    EXPECT_EQ(count(text(verb("day", whole(), kEvening)), ", no refraction\n"), 2);
    EXPECT_EQ(
        count(text(verb("carpet", whole(), {"--year", "2026", "--tz", kZurich, "--step", "1h"})),
              ", no refraction\n"),
        1);
    EXPECT_EQ(count(text(verb("when", whole(),
                              {"--over", "46.99,9.0", "--year", "2026", "--tz", kZurich})),
                    "; no refraction; "),
              1);
    EXPECT_EQ(count(text({"sun", "position", "--at", "46.9,8.9", "--time", "2026-06-21T04:00Z"}),
                    "no refraction\n"),
              1);
    text(with(verb("horizon", whole(), kEvening), {"-o", out("none.svg"), "--overwrite"}));
    EXPECT_EQ(count(read_text(out("none.svg"), "test"), "no refraction"), 3);
}

TEST(Names, WithControlCharactersMakeWholePictures) {
    const std::string name = "a\x01\x1b[31m\xff<&>\n\xef\xbf\xbf";
    for (const std::string file : {"odd.svg", "odd.png"}) {
        const Result run =
            relevo(with(verb("day", whole(), kEvening),
                        {"-q", "--name", name, "-o", out(file), "--scale", "0.5", "--overwrite"}));
        EXPECT_EQ(run.status, 0) << file << ": " << run.err;
    }
    const std::string svg = read_text(out("odd.svg"), "test");
    EXPECT_EQ(count(svg, "<title>a\\x01\\x1b[31m\\xff&lt;&amp;&gt;\\n\\xef\\xbf\\xbf: path"), 1);
    for (const char c : svg)
        EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
    EXPECT_EQ(image::read(out("odd.png")).width, 450);
}

TEST(Values, ThatMeanNothingAreErrorsNotResults) {
    const std::string long_text(70'000, '9');
    for (const std::string value : {"nan", "inf", "-inf", "1e308", "-1e308", "1e309", "", " ",
                                    "0x10", "1;5", long_text.c_str()}) {
        const auto refused = [&](const std::vector<std::string>& arguments) {
            const Result run = relevo(arguments);
            EXPECT_TRUE(run.status == 2 || run.status == 3)
                << arguments[1] << " " << value.substr(0, 20) << ": " << run.status;
            EXPECT_EQ(run.out, "");
            EXPECT_TRUE(run.err.starts_with("relevo: error: ")) << run.err.substr(0, 300);
        };
        for (const std::string option :
             {"--step", "-k", "--highest", "--eye-height", "--dip", "--scale"})
            refused(verb("horizon", whole(), {"-q", option, value}));
        for (const std::string option : {"--step", "--year", "--tz"}) {
            std::vector<std::string> arguments = verb("carpet", whole(), {"-q"});
            for (const auto& [name, usual] :
                 {std::pair<std::string, std::string>{"--year", "2026"}, {"--tz", "UTC"}})
                if (name != option) arguments = with(arguments, {name, usual});
            refused(with(arguments, {option, value}));
        }
        for (const std::string option : {"--tolerance", "--summit-radius"})
            refused(verb(
                "when", whole(),
                {"-q", "--over", "46.99,9.0", "--year", "2026", "--tz", "UTC", option, value}));
        for (const std::string& place : {value, value + ",9.0", "46.99," + value})
            refused({"sun", "when", whole(), "-q", "--at", kHere, "--over", place, "--year", "2026",
                     "--tz", "UTC"});
        refused({"sun", "day", "--at", value + ",9.0", "--date", "2026-06-21", "--tz", "UTC"});
        refused({"sun", "day", "--at", "46.9,8.9", "--date", value, "--tz", "UTC"});
        refused({"sun", "position", "--at", "46.9,8.9", "--time", value});
        refused({"sun", "position", "--at", "46.9,8.9", "--time", "sunrise+" + value, "--date",
                 "2026-06-21", "--tz", "UTC"});
    }
    for (const std::string step : {"0", "0s", "0min", "-1s", "0.5s", "86401s", "7min", "1d"})
        EXPECT_NE(
            relevo(verb("carpet", whole(), {"-q", "--year", "2026", "--tz", "UTC", "--step", step}))
                .status,
            0)
            << step;
    for (const std::string step : {"0", "-1", "0.001", "0.7", "91"})
        EXPECT_NE(relevo(verb("horizon", whole(), {"-q", "--step", step})).status, 0) << step;
}

}  // namespace
}  // namespace relevo::test::test_sun_ground
