#include <cmath>
#include <fstream>
#include <map>

#include "base/text.h"
#include "base/units.h"
#include "light/fields.h"
#include "light/plane/horizon_file.h"
#include "output/horizon_files.h"

namespace relevo::output {
namespace {

// One metre of degrees, near enough, around a place on the northern and on the southern half.
constexpr int kPosts = 201;
constexpr double kCell_deg = 0.0003;

/// A plain with a wall of 300 m along its eastern edge, seen from the middle of it.
std::vector<light::HorizonPoint> walled_in_the_east(double lat_deg, int count) {
    const dem::Affine affine{.x0 = 10,
                             .x_column = kCell_deg,
                             .y0 = lat_deg + kCell_deg * (kPosts - 1) / 2,
                             .y_row = -kCell_deg};
    const dem::Heightfield field =
        test::field_of(kPosts, kPosts, affine, "EPSG:4326", [](int column, int row) {
            // A step to the north-east is higher still, so that a mirrored file would show too.
            return column >= kPosts - 5 ? (row < 60 ? 500 : 300) : 0;
        });
    const light::TerrainHorizon horizon(
        field, geo::geodetic_deg(lat_deg, 10 + kCell_deg * (kPosts - 1) / 2));
    return horizon.profile(count);
}

/// Heights by azimuth from north, of a file, as its documentation says to read it.
using Heights = std::map<double, double>;

Heights read_pvlib(const std::string& text) {
    const std::vector<std::string> lines = split(text, '\n');
    EXPECT_EQ(lines.front(), "horizon_azimuth,horizon_elevation");
    Heights heights;
    for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
        const std::vector<std::string> fields = split(lines[i], ',');
        heights[*parse_number(fields[0])] = *parse_number(fields[1]);
    }
    return heights;
}

Heights read_pvgis(const std::string& text) {
    const std::vector<std::string> lines = split(text, '\n');
    Heights heights;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i)
        heights[360.0 * double(i) / double(lines.size() - 1)] = *parse_number(lines[i]);
    return heights;
}

/// @param zero_deg  from north, of the file's azimuth 0; @param sense  1 clockwise
Heights read_pvsyst(const std::string& text, double zero_deg, int sense) {
    Heights heights;
    double before = -181;
    for (const std::string& line : split(text, '\n')) {
        if (line.empty() || std::isalpha(static_cast<unsigned char>(line[0]))) continue;
        const std::vector<std::string> fields = split(line, ' ');
        const double azimuth = *parse_number(fields[0]);
        EXPECT_GT(azimuth, before);
        EXPECT_GE(azimuth, -180);
        EXPECT_LT(azimuth, 180);
        before = azimuth;
        heights[std::fmod(zero_deg + sense * azimuth + 720, 360)] = *parse_number(fields[1]);
    }
    return heights;
}

/// That a file has the profile, to its last digit, and so the wall where it stands.
void expect_profile(const Heights& heights, const std::vector<light::HorizonPoint>& profile,
                    bool negative, double rounding_deg) {
    ASSERT_EQ(heights.size(), profile.size());
    for (const light::HorizonPoint& point : profile) {
        const auto found = heights.lower_bound(degrees(point.azimuth_rad) - 1e-6);
        ASSERT_NE(found, heights.end());
        EXPECT_NEAR(found->first, degrees(point.azimuth_rad), 1e-6);
        const double expected_deg = degrees(point.elevation_rad);
        EXPECT_NEAR(found->second, negative ? expected_deg : std::max(0.0, expected_deg),
                    rounding_deg);
    }
    EXPECT_GT(heights.at(90), 5);                // the wall
    EXPECT_GT(heights.at(60), heights.at(120));  // its step
    EXPECT_LT(heights.at(270), 1);
    EXPECT_LT(heights.at(180), 1);
}

TEST(HorizonFiles, AWallInTheEastComesOutInTheEast) {
    for (const double lat_deg : {47.0, -33.0}) {
        SCOPED_TRACE(lat_deg);
        for (const int count : {12, 48, 360}) {
            const std::vector<light::HorizonPoint> profile = walled_in_the_east(lat_deg, count);
            const geo::Geodetic place = geo::geodetic_deg(lat_deg, 10);
            expect_profile(read_pvlib(pvlib_text(profile)), profile, true, 0.00006);
            expect_profile(read_pvgis(pvgis_text(profile)), profile, false, 0.0006);
            // Zero is south on the northern half, west is 90; on the southern half zero is north,
            // and west is 90 too, so that it runs the other way round.
            const Heights pvsyst = lat_deg > 0 ? read_pvsyst(pvsyst_text(profile, place), 180, 1)
                                               : read_pvsyst(pvsyst_text(profile, place), 0, -1);
            expect_profile(pvsyst, profile, false, 0.006);
        }
    }
}

TEST(HorizonFiles, AreReadBack) {
    for (const double lat_deg : {47.0, -33.0}) {
        const std::vector<light::HorizonPoint> profile = walled_in_the_east(lat_deg, 360);
        const geo::Geodetic place = geo::geodetic_deg(lat_deg, 10);
        for (const std::string& text :
             {pvlib_text(profile), pvgis_text(profile), pvsyst_text(profile, place)}) {
            const std::string path = (test::scratch_dir() / "horizon.txt").string();
            std::ofstream(path) << text;
            Heights heights;
            for (const auto& direction :
                 light::read_horizon(path, "--horizon", place.lat_rad < 0).directions)
                heights[direction.azimuth_deg] = direction.elevation_deg;
            expect_profile(heights, profile, text.starts_with("horizon_azimuth"), 0.006);
        }
    }
}

TEST(HorizonFiles, PvsystSaysItsAzimuths) {
    const auto head = [](double lat_deg) {
        const std::vector<std::string> lines = split(
            pvsyst_text(walled_in_the_east(lat_deg, 4), geo::geodetic_deg(lat_deg, 10)), '\n');
        return lines[0] + "|" + lines[1] + "|" + split(lines[2], ' ')[0];
    };
    EXPECT_EQ(head(47),
              "Relevo, Latitude 47.00000, Longitude 10.00000|Azimuth 0 south, clockwise, north "
              "-180, east -90, west 90; height; degrees|-180");
    EXPECT_EQ(head(-33),
              "Relevo, Latitude -33.00000, Longitude 10.00000|Azimuth 0 north, counterclockwise, "
              "east -90, west 90; height; degrees|-180");
}

}  // namespace
}  // namespace relevo::output
