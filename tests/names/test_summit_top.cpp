#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "dem/load.h"
#include "names/summit_list.h"
#include "names/summit_top.h"

// Summits on the tops of a DEM, and where they stay as they are.
namespace relevo::names {
namespace {

using geo::geodetic_deg;

/// Cones on a plain: height = that of the highest cone at a place.
struct Cone {
    double east_m, north_m, height_m, slope;
};

class Land {
  public:
    Land(double spacing_m, std::vector<Cone> cones, const char* crs = "EPSG:32632")
        : grid_(kPosts, kPosts,
                {500e3 - spacing_m * (kPosts / 2), spacing_m, 0, 5.2e6 + spacing_m * (kPosts / 2),
                 0, -spacing_m},
                geo::Crs::parse(crs, "test")),
          spacing_m_(spacing_m),
          cones_(std::move(cones)) {}

    Summit top(const Entry& entry) const {
        return on_top(entry, grid_, [this](int column, int row) { return height_m(column, row); });
    }
    std::vector<Summit> summits(const Gazetteer& list) const {
        return summits_on(
            list, grid_, [this](int column, int row) { return height_m(column, row); },
            around(grid_));
    }
    /// An entry so far from the middle.
    Entry entry(double east_m, double north_m, char source, std::optional<int> height_m) const {
        const glm::dvec2 post = glm::dvec2(kPosts / 2) + glm::dvec2(east_m, -north_m) / spacing_m_;
        return {Kind::Summit, "A", "", "", grid_.place(post.x, post.y), height_m, source};
    }
    /// Metres east and north of the middle.
    glm::dvec2 at_m(const geo::Geodetic& place) const {
        const glm::dvec2 post = grid_.post(place) - glm::dvec2(kPosts / 2);
        return glm::dvec2(post.x, -post.y) * spacing_m_;
    }
    std::optional<glm::ivec2> no_height;  ///< a void

  private:
    static constexpr int kPosts = 200;
    double height_m(int column, int row) const {
        if (column < 0 || row < 0 || column >= kPosts || row >= kPosts) return std::nan("");
        if (no_height && glm::ivec2(column, row) == *no_height) return std::nan("");
        const glm::dvec2 at = glm::dvec2(column - kPosts / 2, kPosts / 2 - row) * spacing_m_;
        double height_m = 0;
        for (const Cone& cone : cones_)
            height_m =
                std::max(height_m, cone.height_m -
                                       cone.slope * glm::distance(at, {cone.east_m, cone.north_m}));
        return height_m;
    }

    dem::Grid grid_;
    double spacing_m_;
    std::vector<Cone> cones_;
};

TEST(OnTop, ClimbsToTheNearTop) {
    const Land land(30, {{60, 30, 2000, 0.5}});
    for (const char source : {'G', 'D', 'J'}) {
        const Summit summit = land.top(land.entry(0, 0, source, {}));
        ASSERT_TRUE(summit.is_moved) << source;
        EXPECT_LT(glm::distance(land.at_m(summit.place), {60, 30}), 1) << source;
        EXPECT_EQ(label(summit), "A ~2000 m");
    }
    EXPECT_EQ(label(land.top(land.entry(0, 0, 'G', 2013))), "A 2013 m");  // its own height
}

TEST(OnTop, StaysWhereTheTopIsTooFar) {
    const Land land(30, {{240, 0, 2000, 0.5}});
    const Entry entry = land.entry(0, 0, 'G', {});
    const Summit summit = land.top(entry);
    EXPECT_FALSE(summit.is_moved);
    EXPECT_EQ(summit.place, entry.place);
    EXPECT_EQ(label(summit), "A");  // not the height of a slope
    EXPECT_EQ(label(land.top(land.entry(0, 0, 'J', 1990))), "A 1990 m");
    EXPECT_TRUE(land.top(land.entry(0, 0, 'O', 1990)).is_moved);
    // Two posts are 180 m here.
    EXPECT_TRUE(Land(90, {{175, 0, 2000, 0.5}}).top(land.entry(0, 0, 'G', {})).is_moved);
    EXPECT_FALSE(Land(30, {{175, 0, 2000, 0.5}}).top(land.entry(0, 0, 'G', {})).is_moved);
}

TEST(OnTop, LeavesAConeOnAShoulderAlone) {
    // A cinder cone in front of a mountain: the top is the cone's.
    const Land land(30, {{0, 60, 1000, 0.6}, {900, 60, 3000, 2.5}});
    const Summit summit = land.top(land.entry(0, 0, 'G', {}));
    EXPECT_LT(glm::distance(land.at_m(summit.place), {0, 60}), 1);
}

TEST(OnTop, ComparesHeightsOfCoarseEntries) {
    const Land land(30, {{300, 0, 2000, 0.5}});
    for (const char source : {'N', 'O'}) {
        EXPECT_TRUE(land.top(land.entry(0, 0, source, 2059)).is_moved);
        EXPECT_FALSE(land.top(land.entry(0, 0, source, 2060)).is_moved);
        EXPECT_FALSE(land.top(land.entry(0, 0, source, 1940)).is_moved);
        EXPECT_FALSE(land.top(land.entry(0, 0, source, {})).is_moved);
        EXPECT_EQ(label(land.top(land.entry(0, 0, source, {}))), "A");
    }
    EXPECT_FALSE(Land(30, {{630, 0, 2000, 0.5}}).top(land.entry(0, 0, 'O', 2000)).is_moved);
}

TEST(OnTop, NeedsFinePostsAndGroundAround) {
    EXPECT_TRUE(Land(199, {{0, 0, 2000, 0.5}}).top(Land(199, {}).entry(10, 0, 'G', {})).is_moved);
    EXPECT_FALSE(Land(201, {{0, 0, 2000, 0.5}}).top(Land(201, {}).entry(10, 0, 'G', {})).is_moved);
    Land land(30, {{60, 30, 2000, 0.5}});
    land.no_height = glm::ivec2(103, 98);  // next to the top
    EXPECT_FALSE(land.top(land.entry(0, 0, 'G', {})).is_moved);
    const Land edge(30, {{2970, 0, 2000, 0.5}});  // the last column
    EXPECT_FALSE(edge.top(edge.entry(2960, 0, 'G', {})).is_moved);
    const Land plain(30, {});  // level ground is its own top
    EXPECT_TRUE(plain.top(plain.entry(0, 0, 'G', {})).is_moved);
}

struct Table {
    const char* file;
    int fewest;          ///< summits on the DEM
    double least_share;  ///< that are moved
};

/// Prints what data/README.md says of DEMs.
TEST(SummitsOn, MeasuredDems) {
    SKIP_WITHOUT_TEST_DATA(data);
    for (const Table& table :
         {Table{"highlands_srtm3/highlands_srtm3.vrt", 600, 0.95},
          Table{"tyrol_aw3d30_n47e011_1s_cog.tif", 14, 0.5}, Table{"mt_rainier_90m.tif", 220, 0.6},
          Table{"hawaii_rotated20.tif", 80, 0.4}, Table{"rmnp/rmnp-dem.tif", 100, 0},
          Table{"colorado_tut_relief.nc", 3000, 0}}) {
        const dem::Heightfield field = dem::load((data / "dem" / table.file).string());
        const auto summits = summits_on(
            Gazetteer::summits(), field.grid,
            [&](int column, int row) { return field.height_at(column, row); }, around(field.grid));
        std::vector<double> moved_m, differences_m;
        for (const Summit& summit : summits) {
            if (!summit.is_moved) continue;
            moved_m.push_back(geo::geodesic(summit.entry->place, summit.place).distance_m);
            const glm::dvec2 post = field.grid.post(summit.place);
            if (summit.entry->size)
                differences_m.push_back(std::abs(
                    field.height_at(std::round(post.x), std::round(post.y)) - *summit.entry->size));
        }
        const double share =
            static_cast<double>(moved_m.size()) / static_cast<double>(summits.size());
        fmt::print("[ summits  ] {}: {} of {} moved to tops\n", table.file, moved_m.size(),
                   summits.size());
        if (!moved_m.empty()) test::print_accuracy("  moved by", moved_m, "m", 600);
        if (!differences_m.empty()) test::print_accuracy("  DEM's height", differences_m, "m", 200);
        EXPECT_GE(summits.size(), static_cast<std::size_t>(table.fewest)) << table.file;
        EXPECT_GE(share, table.least_share) << table.file;
    }
}

TEST(SummitsOn, ATopHasOneName) {
    const Land land(30, {{60, 30, 2000, 0.5}});
    const auto row = [&](const char* name, double east_m, double north_m, const char* height_m) {
        const geo::Geodetic place = land.entry(east_m, north_m, 'G', {}).place;
        return fmt::format("{}\t\t\t{:.6f}\t{:.6f}\t{}\tG\n", name, degrees(place.lat_rad),
                           degrees(place.lon_rad), height_m);
    };
    const auto labels = [&](const std::string& rows) {
        std::vector<std::string> texts;
        const Gazetteer list = test::summit_list(rows);
        for (const Summit& summit : land.summits(list))
            texts.push_back(label(summit) + (summit.is_moved ? " on top" : ""));
        return texts;
    };
    EXPECT_THAT(labels(row("Far", 0, 0, "") + row("Near", 50, 0, "")),
                testing::ElementsAre("Far", "Near ~2000 m on top"));
    EXPECT_THAT(labels(row("Far", 0, 0, "2010") + row("Near", 50, 0, "")),
                testing::ElementsAre("Far 2010 m on top", "Near"));
}

/// How many summits of the whole list lie on a grid in degrees.
std::int64_t count_on(int columns, int rows, double west_deg, double north_deg, double step_deg) {
    const dem::Grid grid(columns, rows, {west_deg, step_deg, 0, north_deg, 0, -step_deg},
                         geo::Crs::parse("EPSG:4326", "test"));
    return std::ssize(summits_on(
        Gazetteer::shipped(), grid, [](int, int) { return 0.0; }, around(grid)));
}

TEST(SummitsOn, EveryGridOfTheEarth) {
    EXPECT_EQ(count_on(3600, 1800, -179.95, 89.95, 0.1), 46356);
    // Over 180 degrees, counted both ways.
    const auto all = Gazetteer::shipped().within(Kind::Summit, {geodetic_deg(0, 0), 21e6});
    const auto over_180 = std::ranges::count_if(all, [](const Entry* entry) {
        return std::abs(degrees(entry->place.lon_rad)) > 160 &&
               std::abs(degrees(entry->place.lat_rad)) < 70;
    });
    EXPECT_GT(over_180, 20);
    EXPECT_EQ(count_on(400, 1400, 160.05, 69.95, 0.1), over_180);
    EXPECT_EQ(count_on(400, 1400, -199.95, 69.95, 0.1), over_180);
}

TEST(SummitsOn, ADemAroundAPole) {
    const dem::Grid pole(1000, 1000, {-1e6, 2e3, 0, 1e6, 0, -2e3},
                         geo::Crs::parse("EPSG:3413", "test"));
    std::vector<std::string_view> names;
    for (const Summit& summit : summits_on(
             Gazetteer::shipped(), pole, [](int, int) { return 0.0; }, around(pole)))
        names.push_back(summit.entry->name);
    EXPECT_THAT(names, testing::ElementsAre("Barbeau Pk.", "Outlook Pk."));
}

}  // namespace
}  // namespace relevo::names
