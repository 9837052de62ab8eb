#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <proj.h>

#include "base/units.h"
#include "geo/crs.h"
#include "support/support.h"

namespace relevo::geo {
namespace {

double dms(double degrees, double minutes, double seconds) {
    return degrees + minutes / 60 + seconds / 3600;
}

/// PROJ itself, asked for the same through its C interface, one point at a time.
class ProjItself {
  public:
    explicit ProjItself(const char* crs)
        : pj_(proj_create_crs_to_crs(context_, crs, "EPSG:4326", nullptr)) {}
    ~ProjItself() {
        proj_destroy(pj_);
        proj_context_destroy(context_);
    }
    ProjItself(const ProjItself&) = delete;
    ProjItself& operator=(const ProjItself&) = delete;

    /// @param x,y  in the order of the authority; EPSG:4326 answers latitude first
    Geodetic place(double x, double y) const {
        const PJ_COORD out = proj_trans(pj_, PJ_FWD, proj_coord(x, y, 0, HUGE_VAL));
        return geodetic_deg(out.v[0], out.v[1]);
    }

  private:
    PJ_CONTEXT* context_ = proj_context_create();
    PJ* pj_ = nullptr;
};

double distance_mm(const Geodetic& a, const Geodetic& b) {
    return geodesic(a, b).distance_m * 1000;
}

Crs crs(const char* text) {
    return Crs::parse(text, "test");
}

TEST(Crs, DefaultIsWgs84) {
    const Crs wgs84;
    EXPECT_EQ(wgs84.code(), "EPSG:4326");
    EXPECT_EQ(wgs84.name(), "WGS 84");
    EXPECT_TRUE(wgs84.is_geographic());
    EXPECT_EQ(wgs84.unit_name(), "degree");
    EXPECT_EQ(wgs84.to_geodetic(11.4, 47.3), geodetic_deg(47.3, 11.4));
    EXPECT_EQ(Crs::parse(wgs84.wkt(), "test").code(), "EPSG:4326");
}

// Worked examples of IOGP publication 373-7-2 (Geomatics guidance note 7, part 2) of projections on
// WGS 84. Metres are printed to 1 cm.
TEST(Crs, PseudoMercatorExampleOfGuidanceNote7) {
    const Geodetic place = crs("EPSG:3857").to_geodetic(-11169055.58, 2800000.00);
    EXPECT_LT(distance_mm(place, geodetic_deg(dms(24, 22, 54.433), -dms(100, 20, 0))), 20);
    const glm::dvec2 point =
        crs("EPSG:3857").from_geodetic(geodetic_deg(dms(24, 22, 54.433), -dms(100, 20, 0)));
    EXPECT_NEAR(point.x, -11169055.58, 0.01);
    EXPECT_NEAR(point.y, 2800000.00, 0.02);  // 0.0005" of latitude
}

TEST(Crs, PolarStereographicExamplesOfGuidanceNote7) {
    // Variant A, WGS 84 / UPS North (E,N).
    EXPECT_LT(
        distance_mm(crs("EPSG:5041").to_geodetic(3320416.75, 632668.43), geodetic_deg(73, 44)), 10);
    // Variant B, WGS 84 / Australian Antarctic Polar Stereographic.
    EXPECT_LT(
        distance_mm(crs("EPSG:3032").to_geodetic(7255380.79, 7053389.56), geodetic_deg(-75, 120)),
        10);
}

TEST(Crs, TransverseMercatorExampleOfGuidanceNote7) {
    // British National Grid, 50°30'N 0°30'E: E 577274.99, N 69740.50. The note's coordinates are on
    // OSGB36; the null grid keeps latitude and longitude as they are, so the projection is seen
    // alone.
    const Crs grid =
        crs("+proj=tmerc +lat_0=49 +lon_0=-2 +k=0.9996012717 +x_0=400000 +y_0=-100000 +ellps=airy "
            "+nadgrids=@null");
    EXPECT_LT(distance_mm(grid.to_geodetic(577274.99, 69740.50), geodetic_deg(50.5, 0.5)), 10);
}

TEST(Crs, GeocentricTranslationExampleOfGuidanceNote7) {
    // "Geocentric translations", WGS 84 to ED50 in the North Sea: the place 53°48'36.565"N
    // 2°07'51.477"E on ED50 is 53°48'33.820"N 2°07'46.380"E on WGS 84, printed to 0.001" (3 cm).
    const Crs ed50 = crs("+proj=longlat +ellps=intl +towgs84=-84.87,-96.49,-116.95");
    const Geodetic place = ed50.to_geodetic(dms(2, 7, 51.477), dms(53, 48, 36.565));
    EXPECT_LT(distance_mm(place, geodetic_deg(dms(53, 48, 33.820), dms(2, 7, 46.380))), 35);
}

TEST(Crs, AgreesWithProjItself) {
    const struct {
        const char* code;
        bool swapped;  // the authority's order is north first
        double x0, x1, y0, y1;
    } cases[] = {
        {"EPSG:32611", false, 200000, 800000, 0, 9300000},
        {"EPSG:32733", false, 200000, 800000, 1200000, 9990000},
        {"EPSG:31287", true, 110000, 690000, 280000, 580000},
        {"EPSG:27700", false, 10000, 650000, 10000, 1200000},
        {"EPSG:26710", false, 200000, 800000, 3500000, 6000000},
        {"EPSG:31467", true, 3400000, 3600000, 5200000, 6100000},
        {"EPSG:2056", false, 2490000, 2830000, 1080000, 1290000},
        {"EPSG:3035", true, 2700000, 6500000, 1500000, 5400000},
        {"EPSG:3031", false, -3000000, 3000000, -3000000, 3000000},
        {"EPSG:2229", false, 5600000, 6800000, 1500000, 2300000},  // US survey feet
        {"EPSG:4267", true, -124, -68, 26, 48},
        {"ESRI:54009", false, -9000000, 9000000, -8000000, 8000000},
    };
    std::mt19937 random(4);
    std::vector<double> errors_mm;
    std::vector<double> back_mm;
    for (const auto& c : cases) {
        const ProjItself proj(c.code);
        const Crs ours = crs(c.code);
        std::uniform_real_distribution<double> x(c.x0, c.x1);
        std::uniform_real_distribution<double> y(c.y0, c.y1);
        for (int i = 0; i < 300; ++i) {
            const glm::dvec2 p(x(random), y(random));
            const Geodetic expected = c.swapped ? proj.place(p.y, p.x) : proj.place(p.x, p.y);
            const Geodetic place = ours.to_geodetic(p.x, p.y);
            if (!std::isfinite(expected.lat_rad)) {
                EXPECT_TRUE(std::isnan(place.lat_rad)) << c.code;
                continue;
            }
            errors_mm.push_back(distance_mm(place, expected));
            EXPECT_LT(errors_mm.back(), 1) << c.code << fmt::format(" {} {}", p.x, p.y);
            const glm::dvec2 back = ours.from_geodetic(place);
            back_mm.push_back(distance_mm(ours.to_geodetic(back.x, back.y), place));
            EXPECT_LT(back_mm.back(), 1) << c.code << fmt::format(" {} {}", p.x, p.y);
        }
    }
    EXPECT_GT(errors_mm.size(), 3300u);
    test::print_accuracy("CRS to WGS 84 against PROJ", errors_mm, "mm", 1);
    test::print_accuracy("CRS there and back", back_mm, "mm", 1);
}

TEST(Crs, XIsEastwardWhateverTheAuthoritySays) {
    // EPSG gives northing first for 31287 and 3035, latitude first for 4326.
    EXPECT_GT(crs("EPSG:31287").to_geodetic(500000, 400000).lon_rad,
              crs("EPSG:31287").to_geodetic(400000, 400000).lon_rad);
    EXPECT_NEAR(degrees(crs("EPSG:3035").to_geodetic(4321000, 3210000).lon_rad), 10, 1e-9);
    EXPECT_NEAR(degrees(crs("EPSG:4326").to_geodetic(11, 47).lat_rad), 47, 1e-12);
}

TEST(Crs, KnowsItsNameCodeAndUnit) {
    const Crs utm = crs("EPSG:32611");
    EXPECT_EQ(utm.name(), "WGS 84 / UTM zone 11N");
    EXPECT_EQ(utm.code(), "EPSG:32611");
    EXPECT_EQ(utm.text(), "EPSG:32611");
    EXPECT_FALSE(utm.is_geographic());
    EXPECT_EQ(utm.unit_name(), "metre");
    EXPECT_EQ(utm.unit_si(), 1);
    EXPECT_FALSE(utm.vertical());

    const Crs feet = crs("EPSG:2229");
    EXPECT_EQ(feet.unit_name(), "US survey foot");
    EXPECT_NEAR(feet.unit_si(), kUsSurveyFoot_m, 1e-15);

    const Crs degrees = crs("EPSG:4269");
    EXPECT_TRUE(degrees.is_geographic());
    EXPECT_NEAR(degrees.unit_si(), kDegree_rad, 1e-15);
    const Crs grads = crs("EPSG:4807");  // NTF (Paris), in grads
    EXPECT_EQ(grads.unit_name(), "grad");
    EXPECT_NEAR(grads.unit_si(), kPi / 200, 1e-15);
}

TEST(Crs, GradsAndParisMeridianBecomeDegreesFromGreenwich) {
    // The Paris meridian is 2°20'14.025" east of Greenwich (EPSG:8903).
    const Geodetic place = crs("EPSG:4807").to_geodetic(0, 54);
    EXPECT_NEAR(degrees(place.lon_rad), dms(2, 20, 14.025), 0.002);  // NTF is 100 m off WGS 84
    EXPECT_NEAR(degrees(place.lat_rad), 54 * 0.9, 0.002);
}

TEST(Crs, WithoutACodeTheTextIsWktThatMeansTheSame) {
    const Crs custom =
        crs("+proj=tmerc +lat_0=0 +lon_0=-64.2063 +k=0.9996 +x_0=500000 +datum=WGS84");
    EXPECT_EQ(custom.code(), "");
    EXPECT_EQ(custom.name(), "Transverse Mercator on World Geodetic System 1984");
    EXPECT_EQ(custom.text(), custom.wkt());
    EXPECT_EQ(custom.wkt().find('\n'), std::string::npos);
    const Crs again = Crs::parse(custom.text(), "test");
    EXPECT_EQ(again.to_geodetic(500000, 8950000), custom.to_geodetic(500000, 8950000));
}

TEST(Crs, CompoundHasAVerticalPart) {
    const Crs pair = crs("EPSG:32632+5773");
    ASSERT_TRUE(pair.vertical());
    EXPECT_EQ(pair.vertical()->name, "EGM96 height");
    EXPECT_EQ(pair.vertical()->code, "EPSG:5773");
    EXPECT_EQ(pair.vertical()->unit_name, "metre");
    EXPECT_EQ(pair.vertical()->unit_m, 1);
    EXPECT_FALSE(pair.vertical()->down);
    EXPECT_EQ(pair.code(), "EPSG:32632+5773");
    EXPECT_EQ(pair.to_geodetic(683000, 5255000), crs("EPSG:32632").to_geodetic(683000, 5255000));

    const Crs feet = crs("EPSG:2229+6360");  // NAVD88 height (ftUS)
    EXPECT_EQ(feet.vertical()->unit_name, "US survey foot");
    EXPECT_NEAR(feet.vertical()->unit_m, kUsSurveyFoot_m, 1e-15);
    EXPECT_TRUE(crs("EPSG:4326+5715").vertical()->down);  // MSL depth
    EXPECT_EQ(crs("EPSG:4979").vertical()->name, "ellipsoidal height");
}

TEST(Crs, WritingsThatPeopleUseAreTaken) {
    for (const char* text : {"epsg:32632", " EPSG:32632\n", "urn:ogc:def:crs:EPSG::32632",
                             "WGS 84 / UTM zone 32N", "wgs 84 / utm zone 32n", "+proj=utm +zone=32",
                             "+proj=utm +zone=32 +type=crs", "proj=utm zone=32"})
        EXPECT_EQ(crs(text).to_geodetic(683000, 5255000),
                  crs("EPSG:32632").to_geodetic(683000, 5255000))
            << text;
    for (const char* text : {"WGS84", "WGS 84", "OGC:CRS84", "EPSG:4326", "EPSG:4979"})
        EXPECT_EQ(crs(text).to_geodetic(11, 47), geodetic_deg(47, 11)) << text;
}

TEST(Crs, UnusableTextsAreErrors) {
    const struct {
        const char* text;
        const char* message;
    } cases[] = {
        {"EPSG:999999",
         "exit 3: --crs: EPSG:999999: not a coordinate reference system that PROJ knows, crs not "
         "found; write EPSG:n, WKT or a PROJ string"},
        {"32632",
         "exit 3: --crs: 32632: not a coordinate reference system that PROJ knows, unrecognized "
         "format / unknown name; perhaps EPSG:32632"},
        {"foo",
         "exit 3: --crs: foo: not a coordinate reference system that PROJ knows, the nearest name "
         "is \"Amersfoort\"; write EPSG:n, WKT or a PROJ string"},
        {"",
         "exit 3: --crs: \"\": not a coordinate reference system that PROJ knows; write EPSG:n, "
         "WKT or a PROJ string"},
        {"LOCAL_CS[\"Arbitrary\",UNIT[\"metre\",1]]",
         "exit 3: --crs: Arbitrary: a local (engineering) coordinate reference system, which "
         "cannot place a raster; give a geographic or projected one of the Earth with --crs "
         "EPSG:n"},
        {"EPSG:5773",
         "exit 3: --crs: EPSG:5773: a vertical coordinate reference system, which cannot place a "
         "raster; give a geographic or projected one of the Earth with --crs EPSG:n"},
        {"EPSG:4978",
         "exit 3: --crs: EPSG:4978: a geocentric coordinate reference system, which cannot place a "
         "raster; give a geographic or projected one of the Earth with --crs EPSG:n"},
        {"IAU_2015:30100",
         "exit 3: --crs: IAU_2015:30100: a coordinate system of the Moon; Relevo draws only the "
         "Earth"},
        {"+proj=longlat +a=3396190 +b=3376200",
         "exit 3: --crs: unknown: a coordinate system of Mars; Relevo draws only the Earth"},
        {"+proj=eqc +R=1000000",
         "exit 3: --crs: +proj=eqc +R=1000000: a coordinate system of a body of 1000 km radius; "
         "Relevo draws only the Earth"},
        {"PROJCS[\"broken\",GEOGCS[",
         "exit 3: --crs: PROJCS[\"broken\",GEOGCS[: not a coordinate reference system that PROJ "
         "knows, missing ]; write EPSG:n, WKT or a PROJ string"},
        {"+proj=nonsense",
         "exit 3: --crs: +proj=nonsense: not a coordinate reference system that PROJ knows, Error "
         "1027 (Invalid value for an argument): Unknown projection; write EPSG:n, WKT or a PROJ "
         "string"},
        {"+proj=pipeline +step +proj=utm +zone=32",
         "exit 3: --crs: +proj=pipeline +step +proj=utm +zone=32: not a coordinate reference "
         "system that PROJ knows, it is an operation; write EPSG:n, WKT or a PROJ string"},
    };
    for (const auto& c : cases)
        EXPECT_EQ(test::error_of([&] { Crs::parse(c.text, "--crs"); }), c.message);
}

TEST(Crs, PointsOffTheMapHaveNoPlace) {
    const struct {
        const char* code;
        double x, y;
    } cases[] = {
        {"EPSG:4326", 500000, 4000000}, {"EPSG:4269", 10, 91},  {"EPSG:32611", 1e9, 1e9},
        {"ESRI:54009", 18e6, 9e6},      {"EPSG:4326", 10, NAN},
    };
    for (const auto& c : cases) {
        EXPECT_TRUE(std::isnan(crs(c.code).to_geodetic(c.x, c.y).lat_rad)) << c.code;
        EXPECT_TRUE(std::isnan(crs(c.code).to_geodetic(c.x, c.y).lon_rad)) << c.code;
    }
    // Gnomonic: the other half of the Earth is not on it.
    EXPECT_TRUE(std::isnan(
        crs("+proj=gnom +lat_0=90 +lon_0=0 +R=6371000").from_geodetic(geodetic_deg(-45, 0)).x));
}

TEST(Crs, PostsOnThePoleMayOvershootByRounding) {
    EXPECT_EQ(degrees(Crs().to_geodetic(0, 90 + 1e-9).lat_rad), 90);
}

TEST(Crs, LongitudesOfTheDateLineAreNormalized) {
    EXPECT_EQ(Crs().to_geodetic(202.5, 21.5), geodetic_deg(21.5, -157.5));
    EXPECT_NEAR(degrees(crs("EPSG:4269").to_geodetic(202.5, 21.5).lon_rad), -157.5, 1e-5);
}

TEST(Crs, DatumShiftIsNamedWithItsAccuracy) {
    EXPECT_FALSE(Crs().datum_shift(11, 47));
    EXPECT_FALSE(crs("EPSG:32611").datum_shift(500000, 4000000));
    const auto austria = crs("EPSG:31287").datum_shift(400000, 400000);
    ASSERT_TRUE(austria);
    EXPECT_EQ(austria->name, "MGI to WGS 84 (3)");
    EXPECT_EQ(austria->accuracy_m, 1.5);
}

TEST(Crs, BatchEqualsSinglePoints) {
    const Crs c = crs("EPSG:31287");
    std::vector<glm::dvec2> points;
    for (int i = 0; i < 100; ++i)
        points.emplace_back(200000 + 4000 * i, 300000 + 2000 * i);
    std::vector<Geodetic> places(points.size());
    c.to_geodetic(points, places);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(places[i], c.to_geodetic(points[i].x, points[i].y));
}

TEST(Crs, OneValueServesManyThreads) {
    // A PROJ object keeps the state of its last point, an error or the datum shift it chose, so
    // neighbours that ask for points off the map and in other areas would show.
    const Crs c = crs("EPSG:26710");
    const std::vector<glm::dvec2> points = {
        {500000, 4000000}, {1e9, 1e9}, {500000, 5500000}, {500000, 5100000}};
    std::vector<Geodetic> expected;
    for (const glm::dvec2& p : points)
        expected.push_back(c.to_geodetic(p.x, p.y));
    ASSERT_TRUE(std::isnan(expected[1].lat_rad));
    const auto same = [](const Geodetic& a, const Geodetic& b) {
        return a == b || (std::isnan(a.lat_rad) && std::isnan(b.lat_rad));
    };
    std::vector<int> wrong(8, 0);
    {
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < wrong.size(); ++t)
            threads.emplace_back([&, t] {
                const std::size_t k = t % points.size();
                for (int i = 0; i < 5000; ++i) {
                    wrong[t] += !same(c.to_geodetic(points[k].x, points[k].y), expected[k]);
                    if (i % 1000 == 0)
                        wrong[t] +=
                            !same(Crs(c).to_geodetic(points[k].x, points[k].y), expected[k]);
                }
            });
    }
    EXPECT_EQ(wrong, std::vector<int>(8, 0));
}

TEST(Crs, CopiesOutliveTheirOriginal) {
    Crs copy;
    {
        const Crs original = crs("EPSG:31287");
        copy = original;
        EXPECT_EQ(copy.to_geodetic(400000, 400000), original.to_geodetic(400000, 400000));
    }
    EXPECT_EQ(copy.name(), "MGI / Austria Lambert");
    EXPECT_NEAR(degrees(copy.to_geodetic(400000, 400000).lat_rad), 47.4995, 1e-4);
    copy = Crs();
    EXPECT_EQ(copy.code(), "EPSG:4326");
}

}  // namespace
}  // namespace relevo::geo
