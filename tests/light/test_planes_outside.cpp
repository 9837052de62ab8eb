#include <cmath>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/csv.h"
#include "light/plane/horizon_file.h"
#include "light/plane/irradiance_file.h"
#include "support/support.h"

/// Planes against pvlib 0.16.1, with the tables of ASHRAE 140 and its three horizons.
namespace relevo::light::test_planes_outside {
namespace {

/// A CSV of the outside data, perhaps packed, with its columns by name.
struct Answers {
    test::Csv csv;

    explicit Answers(const std::filesystem::path& path) {
        const std::string name = path.string();
        const std::filesystem::path plain = test::scratch_dir() / "answers.csv";
        std::ofstream(plain) << dem::read_packed_text({name, "test"}, std::uint64_t{64} << 20);
        csv = test::read_csv(plain);
    }
    const std::string& text(const std::vector<std::string>& row, std::string_view name) const {
        return row[csv.column(name)];
    }
    double number(const std::vector<std::string>& row, std::string_view name) const {
        return std::stod(text(row, name));
    }
};

LightOptions center_without_air() {
    LightOptions options;
    options.refraction = sun::Refraction::none();
    return options;
}

Plane plane_of(double tilt_deg, double azimuth_deg) {
    return {radians(tilt_deg), radians(azimuth_deg)};
}

/// One of the sites, whose table is an EPW.
struct Site {
    IrradianceTable table;
    DirectLight level;

    Site(const std::filesystem::path& dir, const std::string& name)
        : table(read_irradiance((dir / "weather" / (name + ".epw.gz")).string(), "test")),
          level(*table.place, Skyline({0.0}), "a level horizon", center_without_air()) {}

    std::vector<PlaneHour> hours(const Plane& plane, SkyModel sky,
                                 const DirectLight* over = nullptr) const {
        return PlaneLight({plane, sky, 0.2}, level, over).of(table.rows, table.instant_s).hours;
    }
};

TEST(PlanesOutside, MonthsAreThoseOfPvlib) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::filesystem::path dir = data / "sun" / "outside" / "planes";
    const Answers answers(dir / "answers" / "sums.csv");
    std::vector<double> off;  // as shares of 0.05 % and 2 Wh/m2
    for (const char* name : {"WD100", "WD300"}) {
        const Site site(dir, name);
        std::map<std::string, std::array<std::vector<PlaneSum>, 3>> found;
        for (const auto& row : answers.csv.rows) {
            const int month = static_cast<int>(answers.number(row, "month"));
            if (answers.text(row, "case") != name || month == 0) continue;
            auto& sums = found[answers.text(row, "surface")];
            for (std::size_t k = 0; k < 3 && sums[k].empty(); ++k)
                sums[k] = sums_by(SumBy::Month,
                                  site.hours(plane_of(answers.number(row, "tilt"),
                                                      answers.number(row, "azimuth")),
                                             static_cast<SkyModel>(k)),
                                  site.table.clock, true);
            const auto i = static_cast<std::size_t>(month - 1);
            const auto compare = [&](double value, const char* column) {
                const double expected = answers.number(row, column);
                off.push_back(std::abs(value - expected) / (0.0005 * expected + 2));
            };
            compare(sums[0][i].beam_wh, "beam_up");
            compare(sums[1][i].diffuse_wh, "hd_midup");
            compare(sums[2][i].diffuse_wh, "perez_midup");
            const double iso = answers.number(row, "iso"), ground = answers.number(row, "ground02");
            EXPECT_NEAR(sums[0][i].diffuse_wh, iso, 1e-6 * iso + 0.05001);
            EXPECT_NEAR(sums[0][i].reflected_wh, ground, 1e-6 * ground + 0.05001);
        }
    }
    test::print_accuracy("months of planes against pvlib", off, "of 0.05 % + 2 Wh/m2", 1);
    EXPECT_GT(off.size(), 700U);
    for (const double error : off)
        EXPECT_LE(error, 1);
}

TEST(PlanesOutside, HorizonsHideWhatCountingFinds) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::filesystem::path dir = data / "sun" / "outside" / "planes";
    const Answers heights(dir / "horizon" / "horizons.csv");
    const Answers answers(dir / "horizon" / "hours.csv");
    const Site site(dir, "WD100");
    std::vector<double> lit_s, beam;
    for (const char* name : {"wall", "ring", "notch"}) {
        FileHorizon horizon;
        for (const auto& row : heights.csv.rows)
            horizon.directions.push_back(
                {heights.number(row, "azimuth"), heights.number(row, name)});
        const DirectLight over(*site.table.place, horizon.skyline(), name, center_without_air());
        for (const int tilt : {0, 30, 90}) {
            const std::vector<PlaneHour> hours =
                site.hours(plane_of(tilt, 180), SkyModel::Isotropic, &over);
            std::map<std::array<int, 3>, const PlaneHour*> by_time;
            for (const PlaneHour& hour : hours) {
                const sun::CivilTime wall = site.table.clock.local(hour.span.begin).wall;
                by_time[{wall.date.month, wall.date.day, wall.hour + 1}] = &hour;
            }
            for (const auto& row : answers.csv.rows) {
                if (answers.text(row, "case") != "WD100" || answers.text(row, "horizon") != name)
                    continue;
                const auto whole = [&](const char* column) {
                    return static_cast<int>(answers.number(row, column));
                };
                const PlaneHour& hour = *by_time.at({whole("month"), whole("day"), whole("hour")});
                lit_s.push_back(std::abs(hour.lit_s - answers.number(row, "lit_s")));
                const double expected = answers.number(row, fmt::format("beam_{}", tilt));
                const bool part = whole("lit_s") > 0 && whole("lit_s") < whole("up_s");
                beam.push_back(std::abs(hour.beam - expected) /
                               (0.002 * expected + 0.3 + (part ? hour.dni * 20 / 3600 : 0)));
                const double iso = answers.number(row, fmt::format("iso_{}", tilt));
                EXPECT_NEAR(hour.diffuse, iso, 0.001 * iso + 1e-4);
            }
        }
    }
    test::print_accuracy("lit seconds of hours under three horizons", lit_s, "s", 20);
    test::print_accuracy("beams of these hours", beam, "of 0.2 % + 0.3 W/m2", 1);
    for (const double error : lit_s)
        EXPECT_LE(error, 20);
    for (const double error : beam)
        EXPECT_LE(error, 1);
}

}  // namespace
}  // namespace relevo::light::test_planes_outside
