// Whether figures that have been made are those that are wanted.
#include <cmath>
#include <filesystem>
#include <span>

#include <gtest/gtest.h>

#include "base/output_file.h"
#include "dem/fixture.h"
#include "light/fields.h"
#include "overlay/band_over.h"
#include "session/sun_raster.h"
#include "sun/time.h"
#include "support/support.h"

namespace relevo::session::test_sun_raster {
namespace {

/// A wall in the west of a plain at 46 N, 40 m high: at sunset its shadow grows by posts a minute.
const dem::Posts& walled() {
    static const dem::Heightfield field =
        test::field_of(40, 24, {500000, 30, 0, 5100000, 0, -30}, "EPSG:32632",
                       [](int x, int) { return x == 4 ? 140.0 : 100.0; });
    static const dem::Posts posts(field);
    return posts;
}

SunRasterWanted day(SunFigure figure) {
    SunRasterWanted wanted;
    wanted.figure = figure;
    wanted.begin = sun::parse_time("2026-03-20T17:15:00Z").utc;
    wanted.end = wanted.begin + 3600.0;
    return wanted;
}

bool same_values(const SunRasterWanted& a, const SunRasterWanted& b) {
    const SunRaster first = sun_raster(walled(), a), second = sun_raster(walled(), b);
    for (std::size_t i = 0; i < first.values.size(); ++i)
        if (first.values.data()[i] != second.values.data()[i]) return false;
    return true;
}

TEST(SunRasterWanted, FiguresOfOtherAirOrTimeAreNotTheSame) {
    for (const SunFigure figure : {SunFigure::Hours, SunFigure::Shadow}) {
        const SunRasterWanted wanted = day(figure);
        EXPECT_TRUE(same_figures(wanted, day(figure)));
        SunRasterWanted airless = wanted;
        airless.refraction = "none";
        EXPECT_FALSE(same_values(wanted, airless));
        EXPECT_FALSE(same_figures(wanted, airless));
        SunRasterWanted earlier = wanted;
        earlier.begin = wanted.begin + -1800.0;
        EXPECT_FALSE(same_values(wanted, earlier));
        EXPECT_FALSE(same_figures(wanted, earlier));
        SunRasterWanted other = wanted;
        other.figure = SunFigure::SkyView;
        EXPECT_FALSE(same_figures(wanted, other));
    }
    SunRasterWanted shorter = day(SunFigure::Hours);
    shorter.end = shorter.begin + 600.0;
    EXPECT_FALSE(same_values(shorter, day(SunFigure::Hours)));
    EXPECT_FALSE(same_figures(shorter, day(SunFigure::Hours)));
}

TEST(SunRasterWanted, WhatAFigureDoesNotDependOnLeavesItTheSame) {
    SunRasterWanted mask = day(SunFigure::Shadow), sky = day(SunFigure::SkyView);
    mask.end = mask.end + 7200.0;
    sky.begin = sky.begin + 7200.0;
    sky.refraction = "none";
    EXPECT_TRUE(same_figures(mask, day(SunFigure::Shadow)));
    EXPECT_TRUE(same_figures(sky, day(SunFigure::SkyView)));
}

TEST(SunRasterParts, AFileHasTheVoidsOfAllOfItsParts) {
    const auto is_void = [](int column, int row) {
        for (const auto& [x, y] : {std::pair{50, 50}, {500, 100}, {100, 500}})
            if (column >= x && column < x + 5 && row >= y && row < y + 5) return true;
        return false;
    };
    test::Raster raster;
    raster.columns = raster.rows = 600;
    raster.nodata = -9999;
    raster.value = [&](int column, int row, int) {
        return is_void(column, row) ? -9999.0 : 100 + 20 * std::sin(column * 0.1) + 0.1 * row;
    };
    const std::filesystem::path folder = test::scratch_dir("sun_raster");
    const std::string dem = test::write_raster(folder / "dem.tif", raster);
    const dem::Posts posts = dem::Posts::load(
        std::span(&dem, 1), {.memory = MemoryBudget::of_posts(std::int64_t{1} << 16)});
    ASSERT_FALSE(posts.in_memory());
    const std::filesystem::path written = folder / "mask.tif";
    OutputFile file(written, /*overwrite=*/true, "test");
    write_sun_raster(file, posts, day(SunFigure::Shadow), nullptr, 20000, "test");
    file.finish();
    EXPECT_EQ(overlay::band_metadata(written.string(), 1).at("HOLES"), "75");
}

TEST(SunRasterParts, AreWholeBlocksHoweverLittleMemoryThereIs) {
    EXPECT_EQ(figure::raster_parts({0, 0, 1300, 600}, 5000).size(), 6U);
}

TEST(SunRasterParts, HoldEachPostOnceWhateverTheShape) {
    for (const dem::Window& window :
         {dem::Window{0, 0, 2300, 200}, {7, 3, 100, 1500}, {5, 900, 513, 512}, {0, 0, 30, 20}})
        for (const std::int64_t most : {std::int64_t{300000}, std::int64_t{1100000}}) {
            Array2d<std::uint8_t> held(window.columns, window.rows);
            for (const dem::Window& part : figure::raster_parts(window, most)) {
                ASSERT_GE(part.column, window.column);
                ASSERT_GE(part.row, window.row);
                ASSERT_LE(part.column + part.columns, window.column + window.columns);
                ASSERT_LE(part.row + part.rows, window.row + window.rows);
                EXPECT_LE(std::int64_t{part.columns} * part.rows, most);
                for (int row = 0; row < part.rows; ++row)
                    for (int column = 0; column < part.columns; ++column)
                        ++held.at(part.column - window.column + column,
                                  part.row - window.row + row);
            }
            for (const std::uint8_t times : held)
                ASSERT_EQ(times, 1);
        }
}

}  // namespace
}  // namespace relevo::session::test_sun_raster
