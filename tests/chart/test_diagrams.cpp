#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <variant>

#include <glm/geometric.hpp>

#include "base/text.h"
#include "base/units.h"
#include "chart/carpet_chart.h"
#include "chart/panorama.h"
#include "chart/sun_path_diagram.h"
#include "light/fields.h"
#include "sun/position.h"

namespace relevo::chart {
namespace {

using sun::Date;
using sun::Zone;

struct Box {
    double left, top, right, bottom;
    std::string words;
};

/// Where the upright words of a drawing stand.
std::vector<Box> words_of(const Drawing& drawing) {
    std::vector<Box> boxes;
    for (const Drawing::Item& item : drawing.items()) {
        const auto* text = std::get_if<Drawing::Text>(&item);
        if (!text || text->lettering.turn_deg != 0) continue;
        const Lettering& l = text->lettering;
        const double width = text_width(text->words, l.size, l.bold);
        const double left = text->at.x - (l.anchor == Anchor::Start    ? 0
                                          : l.anchor == Anchor::Middle ? 0.5
                                                                       : 1) *
                                             width;
        boxes.push_back({left, text->at.y - 0.72 * l.size, left + width, text->at.y + 0.2 * l.size,
                         text->words});
    }
    return boxes;
}

/// Words stand within the drawing and never on each other.
void expect_readable(const Drawing& drawing, double margin = 10) {
    const std::vector<Box> boxes = words_of(drawing);
    EXPECT_GT(boxes.size(), 20U);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box& a = boxes[i];
        EXPECT_GE(a.left, margin) << a.words;
        EXPECT_GE(a.top, margin) << a.words;
        EXPECT_LE(a.right, drawing.width() - margin) << a.words;
        EXPECT_LE(a.bottom, drawing.height() - margin) << a.words;
        for (std::size_t k = i + 1; k < boxes.size(); ++k) {
            const Box& b = boxes[k];
            EXPECT_FALSE(a.left < b.right && b.left < a.right && a.top < b.bottom &&
                         b.top < a.bottom)
                << drawing.title() << ": " << a.words << " | " << b.words;
        }
    }
}

bool says(const Drawing& drawing, const std::string& words) {
    const std::vector<Box> boxes = words_of(drawing);
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Box& box) { return box.words.find(words) != std::string::npos; });
}

template <typename T>
std::vector<T> all_of(const Drawing& drawing) {
    std::vector<T> found;
    for (const Drawing::Item& item : drawing.items())
        if (const T* one = std::get_if<T>(&item)) found.push_back(*one);
    return found;
}

/// A valley between two ridges, with a notch, at a latitude.
dem::Heightfield valley_at(double lat_deg) {
    const double column_deg = 0.001 / std::cos(radians(lat_deg));
    return test::field_of(
        161, 161, {10, column_deg, 0, lat_deg + 0.08, 0, -0.001}, "EPSG:4326",
        [](int column, int row) {
            const double x = column - 80, y = row - 80;
            const double ridge = 900 * std::exp(-std::pow((std::abs(y) - 45) / 18, 2));
            return 500 + ridge * (1 - 0.7 * std::exp(-std::pow((x - 25) / 6, 2))) +
                   60 * std::sin(x / 5) * std::sin(y / 7);
        });
}

struct Place {
    double lat_deg;
    const char* zone;
    Date date;
};
const std::vector<Place>& places() {
    static const std::vector<Place> all{{80.0, "+01:00", {2026, 4, 25}},
                                        {69.0, "Europe/Oslo", {2026, 12, 10}},
                                        {47.0, "Europe/Vienna", {2026, 2, 10}},
                                        {0.3, "Africa/Libreville", {2026, 3, 20}},
                                        {-43.0, "Pacific/Auckland", {2026, 6, 21}}};
    return all;
}

/// What the diagrams of one place are drawn from.
struct Scene {
    explicit Scene(const Place& place)
        : of(place),
          field(valley_at(place.lat_deg)),
          horizon(field, field.grid.place(80, 80)),
          direct(horizon),
          zone(Zone::named(place.zone)),
          profile(horizon.profile(720)) {}

    SunPathDiagram diagram(bool with_day) const {
        SunPathDiagram d;
        d.place = horizon.place();
        d.place_name = "Somewhere";
        d.zone = zone;
        d.year = of.date.year;
        d.refraction = direct.refraction();
        d.terrain = &direct.skyline();
        d.terrain_definition = horizon.description();
        if (with_day) {
            d.light = direct.day(of.date, zone);
            d.day = d.light->flat;
            d.light_definition = direct.definition();
        }
        return d;
    }
    HorizonPanorama panorama(bool with_day) const {
        HorizonPanorama p;
        p.horizon = &horizon;
        p.profile = &profile;
        p.year = of.date.year;
        p.zone = zone;
        p.refraction = direct.refraction();
        if (with_day) {
            p.day = direct.day(of.date, zone);
            p.light_definition = direct.definition();
        }
        return p;
    }

    Place of;
    dem::Heightfield field;
    light::TerrainHorizon horizon;
    light::DirectLight direct;
    Zone zone;
    std::vector<light::HorizonPoint> profile;
};

TEST(Diagrams, WordsNeverStandOnEachOtherOrOverTheEdge) {
    for (const Place& place : places()) {
        SCOPED_TRACE(place.lat_deg);
        const Scene scene(place);
        for (const bool with_day : {false, true}) {
            expect_readable(scene.diagram(with_day).draw());
            expect_readable(scene.panorama(with_day).draw());
        }
        const light::Carpet c = carpet(scene.direct, 2026, scene.zone, 1800);
        expect_readable(
            CarpetChart{&c, scene.horizon.place(), "", scene.horizon.description(), {}}.draw());
    }
}

TEST(Diagrams, APanelHasTheSizeThatIsAskedForAndNoLettersOnEachOther) {
    for (const Place& place : places()) {
        SCOPED_TRACE(place.lat_deg);
        const Scene scene(place);
        HorizonPanorama panorama = scene.panorama(true);
        panorama.panel = PanelSize{760, 260};
        HorizonPanorama::Axes axes;
        const Drawing horizon = panorama.draw(&axes);
        EXPECT_EQ(glm::dvec2(horizon.width(), horizon.height()), glm::dvec2(760, 260));
        expect_readable(horizon, 3);
        // The edges of the light lie where the axes say.
        for (const light::LitInterval& lit : panorama.day->lit) {
            if (lit.begin.midnight) continue;
            const glm::dvec2 at = axes.at(lit.begin.azimuth_rad, lit.begin.elevation_rad);
            double least = 1e9;
            for (const auto& circle : all_of<Drawing::Circle>(horizon))
                least = std::min(least, glm::distance(circle.center, at));
            EXPECT_LT(least, 1e-6);
        }
        const light::Carpet c = carpet(scene.direct, 2026, scene.zone, 1800);
        CarpetChart chart{&c, scene.horizon.place(), "", "", PanelSize{760, 90}};
        for (const double height : {90, 118, 160}) {  // of low windows
            chart.panel->height = height;
            expect_readable(chart.draw(), 3);
        }
        chart.panel->height = 260;
        const Drawing year = chart.draw();
        expect_readable(year, 3);
        double lit = 0;
        for (const auto& path : all_of<Drawing::Path>(year)) {
            if (!path.closed || !path.pen.crisp || path.pen.fill->rgb != 0xffd24a) continue;
            lit += std::abs(path.points[2].x - path.points[0].x) *
                   std::abs(path.points[2].y - path.points[0].y);
        }
        const Rect plot = chart.plot();
        EXPECT_NEAR(lit / (plot.width / 365) / (plot.height / 24) * 3600 / (c.lit_s + 1), 1, 0.02);
    }
}

TEST(Diagrams, NamesOfSummitsHaveRoom) {
    const Scene scene(places()[2]);
    HorizonPanorama panorama = scene.panorama(true);
    for (int i = 0; i < 1000; ++i) {
        const double azimuth_rad = 2 * kPi * i / 1000;
        panorama.names.push_back({azimuth_rad, scene.horizon.elevation_rad(azimuth_rad), 1000,
                                  fmt::format("Summit {} ~1400 m", i)});
    }
    const auto count = [&] {
        const std::vector<Box> words = words_of(panorama.draw());
        return std::ranges::count_if(
            words, [](const Box& box) { return box.words.starts_with("Summit "); });
    };
    expect_readable(panorama.draw());
    EXPECT_EQ(count(), 14);
    panorama.panel = PanelSize{760, 260};
    expect_readable(panorama.draw(), 3);
    EXPECT_GE(count(), 5);
}

TEST(Diagrams, ALongNameLeavesTheRestOfTheTitle) {
    const Scene scene(places()[2]);
    const std::string name = std::string(2000, 'n') + "\x1b";
    SunPathDiagram diagram = scene.diagram(true);
    HorizonPanorama panorama = scene.panorama(true);
    const light::Carpet light = carpet(scene.direct, 2026, scene.zone, 1800);
    CarpetChart chart{&light, scene.horizon.place(), name, scene.horizon.description(), {}};
    diagram.place_name = panorama.place_name = name;
    const std::pair<Drawing, std::string> drawings[] = {
        {diagram.draw(), "\u2026: path of the sun, 10 February 2026"},
        {panorama.draw(), "\u2026: horizon and path of the sun, 10 February 2026"},
        {chart.draw(), "\u2026: direct sun through 2026"}};
    for (const auto& [drawing, end] : drawings) {
        expect_readable(drawing);
        EXPECT_TRUE(says(drawing, "nnn" + end));
        // For those who do not see it, the whole of it.
        EXPECT_TRUE(drawing.title().starts_with(std::string(2000, 'n') + "\\x1b: "));
    }
}

TEST(Diagrams, SayPlaceDateZoneAndDefinitions) {
    const Scene scene(places()[2]);
    const Drawing diagram = scene.diagram(true).draw();
    EXPECT_EQ(diagram.title(), "Somewhere: path of the sun, 10 February 2026");
    const Drawing panorama = scene.panorama(true).draw();
    EXPECT_EQ(panorama.title(), "Horizon and path of the sun, 10 February 2026");
    for (const Drawing* drawing : {&diagram, &panorama}) {
        EXPECT_TRUE(says(*drawing, "47.00000 N 10.11730 E"));
        EXPECT_TRUE(says(*drawing, "Europe/Vienna"));
        EXPECT_TRUE(says(*drawing, "Direct sun "));
        EXPECT_TRUE(says(*drawing, "50 arc-minutes below the horizon"));
        EXPECT_TRUE(says(*drawing, "k = 0.13"));
        EXPECT_TRUE(says(*drawing, "in summer time add 1 h"));
    }
    EXPECT_TRUE(says(Scene(places()[0]).diagram(true).draw(), "polar day"));
    EXPECT_TRUE(says(Scene(places()[1]).diagram(true).draw(), "polar night"));
}

TEST(SunPathDiagram, HoursStandWhereTheSunDoes) {
    const Scene scene(places()[2]);
    const SunPathDiagram of = scene.diagram(true);
    const Drawing drawing = of.draw();
    // The rim is the largest circle, the zenith its middle.
    const auto circles = all_of<Drawing::Circle>(drawing);
    const auto rim =
        std::max_element(circles.begin(), circles.end(),
                         [](const auto& a, const auto& b) { return a.radius < b.radius; });
    int found = 0;
    for (int hour = 8; hour <= 17; ++hour) {
        const sun::Position p =
            sun::position(scene.zone.resolve({scene.of.date, hour}).utc, scene.horizon.place());
        const double r =
            rim->radius * std::tan((kPi / 2 - of.refraction.apparent_rad(p.elevation_rad)) / 2);
        const glm::dvec2 wanted =
            rim->center + r * glm::dvec2(std::sin(p.azimuth_rad), -std::cos(p.azimuth_rad));
        found += std::any_of(circles.begin(), circles.end(), [&](const auto& c) {
            return glm::length(c.center - wanted) < 0.01 && c.radius < 5;
        });
    }
    EXPECT_EQ(found, 10);
}

TEST(Panorama, HoursStandWhereTheSunDoesUnlessTerrainHidesIt) {
    const Scene scene(places()[2]);
    const Drawing drawing = scene.panorama(true).draw();
    // South in the middle of a plot 1392 wide; elevations by the labels' own axis.
    double y0 = 0, y10 = 0;
    for (const auto& text : all_of<Drawing::Text>(drawing)) {
        if (text.lettering.anchor != Anchor::End) continue;
        if (text.words == "0°") y0 = text.at.y - 4;
        if (text.words == "10°") y10 = text.at.y - 4;
    }
    ASSERT_NE(y10, 0);
    const auto circles = all_of<Drawing::Circle>(drawing);
    int seen = 0, hidden = 0;
    for (int hour = 7; hour <= 18; ++hour) {
        const sun::Position p =
            sun::position(scene.zone.resolve({scene.of.date, hour}).utc, scene.horizon.place());
        const double apparent_rad = scene.direct.refraction().apparent_rad(p.elevation_rad);
        const glm::dvec2 wanted(74 + 1392 * p.azimuth_rad / (2 * kPi),
                                y0 + degrees(apparent_rad) / 10 * (y10 - y0));
        const bool drawn = std::any_of(circles.begin(), circles.end(), [&](const auto& c) {
            return glm::length(c.center - wanted) < 0.5 && c.radius < 4;
        });
        const bool visible = apparent_rad > scene.horizon.elevation_rad(p.azimuth_rad);
        EXPECT_EQ(drawn, visible) << hour;
        ++(visible ? seen : hidden);
    }
    EXPECT_GT(seen, 3);
    EXPECT_GE(hidden, 3);
}

TEST(CarpetChart, AreasAreTheHours) {
    const Scene scene(places()[2]);
    const light::Carpet c = carpet(scene.direct, 2026, scene.zone, 180);
    const Drawing drawing =
        CarpetChart{&c, scene.horizon.place(), "Valley", scene.horizon.description(), {}}.draw();
    EXPECT_EQ(drawing.title(), "Valley: direct sun through 2026");
    double lit = 0;
    for (const auto& path : all_of<Drawing::Path>(drawing)) {
        if (!path.closed || !path.pen.crisp || path.pen.fill->rgb != 0xffd24a) continue;
        lit += std::abs(path.points[2].x - path.points[0].x) *
               std::abs(path.points[2].y - path.points[0].y);
    }
    // 2.8 units a day and 20 an hour.
    EXPECT_NEAR(lit / 2.8 / 20 / (c.lit_s / 3600), 1, 0.002);
}

TEST(CarpetChart, MonthsHaveTheirHoursOfSunAboveThoseOfALevelHorizon) {
    const Scene scene(places()[2]);
    const light::Carpet c = carpet(scene.direct, 2026, scene.zone, 180);
    const Drawing drawing =
        CarpetChart{&c, scene.horizon.place(), "Valley", scene.horizon.description(), {}}.draw();
    std::map<double, std::vector<double>> rows;  // by their heights, downwards
    for (const auto& text : all_of<Drawing::Text>(drawing)) {
        const std::string& words = text.words;
        if (!words.ends_with(" h")) continue;
        if (const auto hours = parse_number(words.substr(0, words.size() - 2)))
            rows[text.at.y].push_back(*hours);
    }
    ASSERT_EQ(rows.size(), 2u);
    const std::vector<double>&sun = rows.begin()->second, &level = rows.rbegin()->second;
    ASSERT_EQ(sun.size(), 12u);
    ASSERT_EQ(level.size(), 12u);
    // Each is told to the hour.
    EXPECT_NEAR(std::accumulate(sun.begin(), sun.end(), 0.0), c.lit_s / 3600, 6);
    EXPECT_NEAR(std::accumulate(level.begin(), level.end(), 0.0), c.level_s / 3600, 6);
    EXPECT_GT(std::abs(c.lit_s - c.level_s), 50 * 3600.0);
    for (std::size_t month = 0; month < 12; ++month)
        EXPECT_NEAR(sun[month], c.month_lit_s[month] / 3600, 0.51);
}

TEST(TerrainHorizon, WithinADistanceIsTheHorizonOfTheGroundThatNear) {
    const dem::Heightfield field = valley_at(47);
    const light::TerrainHorizon horizon(field, field.grid.place(80, 80));
    for (int i = 0; i < 36; ++i) {
        const double azimuth_rad = radians(10.0 * i);
        const light::HorizonPoint whole = horizon.at(azimuth_rad);
        EXPECT_EQ(horizon.elevation_within_rad(azimuth_rad, 1e6), whole.elevation_rad);
        EXPECT_NEAR(horizon.elevation_within_rad(azimuth_rad, whole.distance_m + 0.01),
                    whole.elevation_rad, 1e-12);
        EXPECT_LT(horizon.elevation_within_rad(azimuth_rad, whole.distance_m - 1),
                  whole.elevation_rad);
        EXPECT_EQ(horizon.elevation_within_rad(azimuth_rad, 0.01), -kPi / 2);
    }
}

}  // namespace
}  // namespace relevo::chart
