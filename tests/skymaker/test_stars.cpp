#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "base/units.h"
#include "stars.h"
#include "support/support.h"
#include "textures.h"

namespace relevo::skymaker {
namespace {

const std::vector<Star>& stars() {
    static const std::vector<Star> kStars = read_stars(test::source_dir() / "tools/sky/stars.csv");
    return kStars;
}

glm::dvec3 spherical(double ra_deg, double dec_deg) {
    const double ra = radians(ra_deg), dec = radians(dec_deg);
    return {std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)};
}

const Star& nearest(const glm::dvec3& direction, double faintest = 3.5) {
    const Star* best = nullptr;
    for (const Star& star : stars())
        if (star.magnitude < faintest &&
            (!best || dot(star.direction, direction) > dot(best->direction, direction)))
            best = &star;
    return *best;
}

double apart_arcsec(const glm::dvec3& a, const glm::dvec3& b) {
    return degrees(distance(a, b)) * 3600;
}

TEST(Stars, StandWhereHipparcosMeasuredThem) {
    // ESA, The Hipparcos and Tycho Catalogues (1997): place at J2000 with its yearly motion, V,
    // B-V.
    struct Row {
        const char* name;
        double ra_deg, dec_deg, pm_ra_arcsec, pm_dec_arcsec, v, b_v;
    };
    std::vector<double> errors;
    for (const Row& row : {Row{"Sirius", 101.28716, -16.71612, -0.54601, -1.22308, -1.44, 0.01},
                           Row{"Vega", 279.23473, 38.78369, 0.20102, 0.28746, 0.03, 0.00},
                           Row{"Polaris", 37.95456, 89.26411, 0.04422, -0.01174, 1.97, 0.64},
                           Row{"Betelgeuse", 88.79294, 7.40706, 0.02733, 0.01086, 0.45, 1.50},
                           Row{"Rigel", 78.63447, -8.20164, 0.00187, -0.00056, 0.18, -0.03},
                           Row{"Arcturus", 213.91530, 19.18241, -1.09345, -1.99940, -0.05, 1.24},
                           Row{"Mintaka", 83.00167, -0.29910, 0.00167, 0.00056, 2.25, -0.18},
                           Row{"Alnilam", 84.05339, -1.20192, 0.00149, -0.00106, 1.69, -0.18},
                           Row{"Alnitak", 85.18969, -1.94257, 0.00399, 0.00254, 1.74, -0.20},
                           Row{"Acrux", 186.64956, -63.09909, -0.03537, -0.01473, 1.25, -0.24},
                           Row{"Dubhe", 165.93196, 61.75103, -0.13646, -0.03525, 1.81, 1.06}}) {
        const double years = kStarEpoch - 2000;
        const glm::dvec3 there =
            spherical(row.ra_deg + row.pm_ra_arcsec * years / 3600 / std::cos(radians(row.dec_deg)),
                      row.dec_deg + row.pm_dec_arcsec * years / 3600);
        const Star& star = nearest(there);
        errors.push_back(apart_arcsec(star.direction, there));
        EXPECT_LT(errors.back(), 3) << row.name;
        EXPECT_NEAR(star.magnitude, row.v, 0.35) << row.name;  // Betelgeuse changes, Acrux is two
        ASSERT_TRUE(star.b_v) << row.name;
        EXPECT_NEAR(*star.b_v, row.b_v, 0.36) << row.name;
    }
    test::print_accuracy("places in the catalogue, against Hipparcos", errors, "arcsec", 3);
}

TEST(Stars, AreAllThoseThatTheEyeSeesAndEachOnce) {
    std::set<int> numbers;
    std::array<int, 7> counts{};
    for (const Star& star : stars()) {
        EXPECT_TRUE(numbers.insert(star.hr).second) << star.hr;
        EXPECT_NEAR(length(star.direction), 1, 1e-12);
        EXPECT_GE(star.magnitude, -1.46);
        EXPECT_LE(star.magnitude, 6);
        for (std::size_t m = 0; m < counts.size(); ++m)
            counts[m] += star.magnitude <= static_cast<double>(m);
    }
    // With each magnitude there are about three times as many, and none run out at the faint end.
    EXPECT_EQ(counts[6], static_cast<int>(stars().size()));
    for (std::size_t m = 3; m < counts.size(); ++m)
        EXPECT_NEAR(static_cast<double>(counts[m]) / counts[m - 1], 3, 0.6) << m;
    EXPECT_TRUE(std::is_sorted(stars().begin(), stars().end(), [](const Star& a, const Star& b) {
        return a.magnitude < b.magnitude;
    }));
    // T Coronae Borealis is not the star of the second magnitude that the catalogue has.
    EXPECT_FALSE(numbers.contains(5958));
}

TEST(Stars, AreColouredAsBlackBodies) {
    const glm::dvec3 sun = star_colour(0.653), red = star_colour(1.85), blue = star_colour(-0.03);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sun[c], 1, 1e-12);
    EXPECT_GT(red.r, 1.4);
    EXPECT_LT(red.b, 0.45);
    EXPECT_GT(blue.b, 1.5);
    EXPECT_LT(blue.r, 0.8);
    for (double b_v = -0.35; b_v <= 1.9; b_v += 0.15)
        EXPECT_NEAR(luminance(star_colour(b_v)), 1, 1e-12);
}

/// The stars of a cell as they are in the texture.
struct Entry {
    glm::dvec3 direction;
    int code;
};
std::vector<Entry> column(const image::TextureData& texture, int x, int y) {
    std::vector<Entry> entries;
    for (int z = 0; z < texture.depth(); ++z) {
        const std::size_t index =
            static_cast<std::size_t>((z * texture.height() + y) * texture.width() + x);
        glm::dvec4 texel;
        for (int c = 0; c < 4; ++c) {
            std::uint16_t half = 0;
            std::memcpy(&half,
                        texture.level(0).data() + 8 * index + 2 * static_cast<std::size_t>(c), 2);
            texel[c] = glm::unpackHalf1x16(half);
        }
        if (texel.a == 0) break;
        entries.push_back(
            {StarLayout::centre_of(x, y) + glm::dvec3(texel), static_cast<int>(texel.a)});
    }
    return entries;
}

TEST(StarTexture, HasInEachCellAllStarsThatReachIntoItAndInTheirPlace) {
    const image::TextureData texture = star_texture(stars());
    ASSERT_EQ(texture.width(), StarLayout::kAcross);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    double worst_arcsec = 0;
    std::size_t seen = 0, fullest = 0;
    for (int i = 0; i < 20000; ++i) {
        // All over the sphere, and about the bright stars.
        const glm::dvec3 aside(normal(random), normal(random), normal(random));
        const glm::dvec3 direction =
            i % 2 ? normalize(aside)
                  : normalize(stars()[static_cast<std::size_t>(i / 2) % stars().size()].direction +
                              0.008 * aside);
        int x = 0, y = 0;
        StarLayout::cell_of(direction, x, y);
        const std::vector<Entry> entries = column(texture, x, y);
        fullest = std::max(fullest, entries.size());
        for (const Star& star : stars()) {
            const double apart_deg = apart_arcsec(star.direction, direction) / 3600;
            if (apart_deg > 0.97 * StarLayout::kReach_deg) continue;
            const auto found = std::min_element(entries.begin(), entries.end(),
                                                [&](const Entry& a, const Entry& b) {
                                                    return distance(a.direction, star.direction) <
                                                           distance(b.direction, star.direction);
                                                });
            ASSERT_NE(found, entries.end()) << star.hr;
            const double off_arcsec = apart_arcsec(found->direction, star.direction);
            ASSERT_LT(off_arcsec, 8) << star.hr;
            worst_arcsec = std::max(worst_arcsec, off_arcsec);
            ++seen;
        }
    }
    EXPECT_GT(seen, 10000u);
    fmt::print("[ accuracy ] places in the texture of stars: worst {:.1f} arcsec; {} slices\n",
               worst_arcsec, texture.depth());
    EXPECT_LE(texture.depth(), 20);
}

TEST(StarLayout, CodesAreExactInAHalfFloatAndGoBackAndForth) {
    for (double magnitude = -1.5; magnitude < 6.4; magnitude += 0.1) {
        for (double b_v = -0.35; b_v < 1.9; b_v += 0.1) {
            const int code = StarLayout::code_of(magnitude, b_v);
            EXPECT_EQ(glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(code))), code);
            EXPECT_NEAR(StarLayout::magnitude_of(code), magnitude, 0.0313);
            EXPECT_NEAR(StarLayout::b_v_of(code), b_v, 0.0751);
        }
    }
    EXPECT_EQ(StarLayout::code_of(-9, -9), 1);
    EXPECT_EQ(StarLayout::code_of(99, 99), 2048);
}

TEST(Stars, OfABrokenTableAreAnErrorThatNamesTheLine) {
    const std::filesystem::path file = test::scratch_dir("stars") / "stars.csv";
    const std::string header = "hr,ra_deg,dec_deg,pm_ra_arcsec,pm_dec_arcsec,v_mag,b_v_mag\n";
    const std::string who = "exit 3: relevo_make_sky: " + file.string();
    const auto error = [&](const std::string& text) {
        std::ofstream(file, std::ios::trunc) << text;
        return test::error_of([&] { read_stars(file); });
    };
    EXPECT_EQ(error(header + "1,2,3,0,0,4,\n"), "no error");
    EXPECT_EQ(error("hr,ra\n"), who +
                                    ":1: expected the columns hr,ra_deg,dec_deg,pm_ra_arcsec,"
                                    "pm_dec_arcsec,v_mag,b_v_mag");
    for (const char* row : {"1,2,3,0,0,4", "1,2,3,0,0,4,5,6", "1,2,3,0,0,x,5", "1,2,3,0,0,4,x", ""})
        EXPECT_EQ(
            error(header + "1,2,3,0,0,4,5\n" + row + "\n"),
            who + ":3: expected 7 numbers, the last of which may be empty, got \"" + row + "\"");
    EXPECT_EQ(error(header + "1,2,93,0,0,4,5\n"), who + ":2: no place in the sky: 2, 93 degrees");
    EXPECT_EQ(test::error_of([&] { read_stars(file.parent_path() / "none.csv"); }),
              "exit 3: relevo_make_sky: " + (file.parent_path() / "none.csv").string() +
                  ": cannot be read");
}

}  // namespace
}  // namespace relevo::skymaker
