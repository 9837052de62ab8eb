#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include <cpl_vsi.h>
#include <gtest/gtest.h>

#include "dem/file_state.h"
#include "dem/level_cache.h"
#include "dem/load.h"
#include "fixture.h"
#include "support/support.h"

namespace relevo::dem::test_level_cache {
namespace {

namespace fs = std::filesystem;
using test::folder;
using test::Raster;

/// What is written from now on has a later time of change than what was written before.
void wait_for_a_tick() {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

/// Hills with a lake, a sea and voids.
std::string hills(const std::string& name = "hills.tif") {
    Raster raster;
    raster.columns = 400;
    raster.rows = 300;
    raster.nodata = -9999;
    raster.value = [](int column, int row, int) {
        if (column > 380 && row < 30) return -9999.0;
        if (row > 250) return -2.0;
        if (std::hypot(column - 100, row - 100) < 30) return 500.0;
        return 600 + 80 * std::sin(column / 17.0) * std::cos(row / 13.0);
    };
    return test::write_raster(folder() / name, raster);
}

LoadOptions options_of(std::int64_t posts = 12000) {
    LoadOptions options;
    options.memory = MemoryBudget::of_posts(posts);
    options.cached = true;
    return options;
}

/// A DEM as pictures have it.
struct Drawn {
    std::vector<std::string> paths;
    LoadOptions options;
    Source source;
    Heightfield field;
    Water water;
    Pyramid pyramid;

    Drawn(const std::string& path, const LoadOptions& given)
        : paths{path},
          options(given),
          source(opened(path, given)),
          field(load(source, given.memory)),
          water(find_water(field.height_m, field.grid)),
          pyramid(Pyramid::of(field, &source, given.memory)) {}

    static Source opened(const std::string& path, const LoadOptions& options) {
        wait_for_a_tick();
        return Source::open(path, options);
    }
    LevelCache cache() const {
        return {source.opened_files(), paths, options, Holes::Fill, place()};
    }
    void keep() const { cache().write(field, pyramid, water); }
    bool is_kept() const { return cache().read(source.grid(), field.reduction).has_value(); }
    static CacheFolder place() { return {folder() / "cache", std::int64_t{1} << 26}; }
};

bool same(const Pyramid::Bounds& a, const Pyramid::Bounds& b) {
    return a.lowest_m == b.lowest_m && a.highest_m == b.highest_m && a.error_m == b.error_m &&
           a.rms_m == b.rms_m;
}

void expect_same(const Pyramid& a, const Pyramid& b) {
    ASSERT_EQ(a.levels(), b.levels());
    for (int level = 0; level < a.levels(); ++level) {
        for (int y = 0; y < a.tiles(level).y; ++y)
            for (int x = 0; x < a.tiles(level).x; ++x)
                EXPECT_TRUE(same(a.bounds(level, {x, y}), b.bounds(level, {x, y})))
                    << level << " " << x << " " << y;
        if (level < a.first_in_memory()) continue;
        for (int y = 0; y < a.size(level).y; ++y)
            for (int x = 0; x < a.size(level).x; ++x) {
                const float one = a.height(level, x, y), other = b.height(level, x, y);
                EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other)));
                EXPECT_EQ(a.coverage(level, x, y), b.coverage(level, x, y));
            }
    }
}

TEST(LevelCache, GivesBackWhatPicturesAreMadeOf) {
    const Drawn drawn(hills(), options_of());
    ASSERT_EQ(drawn.field.reduction, 4);
    ASSERT_GT(drawn.water.lakes, 0);
    ASSERT_GT(drawn.water.sea_posts, 0);
    ASSERT_GT(drawn.field.about.statistics.holes, 0);
    EXPECT_FALSE(drawn.cache().read(drawn.source.grid(), 4));
    drawn.cache().write(drawn.field, drawn.pyramid, drawn.water);
    std::optional<Levels> levels = drawn.cache().read(drawn.source.grid(), 4);
    ASSERT_TRUE(levels);
    const Heightfield again = load(drawn.source, drawn.options.memory, std::move(levels->height_m));
    ASSERT_EQ(again.height_m.size(), drawn.field.height_m.size());
    EXPECT_EQ(
        std::memcmp(again.height_m.data(), drawn.field.height_m.data(), 4 * again.height_m.size()),
        0);
    EXPECT_EQ(again.about.statistics, drawn.field.about.statistics);
    EXPECT_EQ(again.about.assumptions, drawn.field.about.assumptions);
    EXPECT_EQ(again.reduction, 4);
    expect_same(Pyramid::of(again, &drawn.source, drawn.options.memory, Pyramid::Voids::Kept,
                            &levels->bounds),
                drawn.pyramid);
    const Water& water = levels->water;
    EXPECT_EQ(water.kind, drawn.water.kind);
    EXPECT_EQ(water.lakes, drawn.water.lakes);
    EXPECT_EQ(water.sea_posts, drawn.water.sea_posts);
    EXPECT_EQ(water.lake_posts, drawn.water.lake_posts);
    EXPECT_EQ(water.lowest_sea_m, drawn.water.lowest_sea_m);
    EXPECT_EQ(water.has_sea_floor, drawn.water.has_sea_floor);
    EXPECT_EQ(water.assumptions, drawn.water.assumptions);
    const std::vector<CachedDem> list = cached_dems(Drawn::place());
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].file, fs::canonical(drawn.paths[0]));
}

TEST(LevelCache, WhatChangesHeightsIsAnotherEntry) {
    const std::string path = hills();
    const Drawn drawn(path, options_of());
    drawn.cache().write(drawn.field, drawn.pyramid, drawn.water);
    const auto finds = [&](const LoadOptions& options, const std::string& of, int reduction = 4) {
        const std::vector<std::string> paths{of};
        wait_for_a_tick();
        return LevelCache(OpenedFiles(paths), paths, options, Holes::Fill, Drawn::place())
            .read(drawn.source.grid(), reduction)
            .has_value();
    };
    EXPECT_TRUE(finds(options_of(), path));
    EXPECT_TRUE(finds(options_of(9000), path)) << "another memory with the same reduction";
    const auto with = [](auto LoadOptions::*member, auto value) {
        LoadOptions options = options_of();
        options.*member = value;
        return options;
    };
    EXPECT_FALSE(finds(with(&LoadOptions::cached, false), path));
    EXPECT_FALSE(finds(with(&LoadOptions::unit, "ft"), path));
    EXPECT_FALSE(finds(with(&LoadOptions::no_nodata, true), path));
    const LoadOptions one = with(&LoadOptions::nodata, std::optional<double>(-9999));
    const Drawn given(path, one);
    given.cache().write(given.field, given.pyramid, given.water);
    EXPECT_TRUE(finds(one, path));
    EXPECT_FALSE(finds(with(&LoadOptions::nodata, std::optional<double>(500)), path));
    EXPECT_FALSE(finds(with(&LoadOptions::band, 1), path));
    EXPECT_FALSE(finds(with(&LoadOptions::crs, "EPSG:32633"), path));
    EXPECT_FALSE(finds(with(&LoadOptions::crop, "7,46,9,48"), path));
    EXPECT_FALSE(finds(with(&LoadOptions::encoding, Encoding::Terrarium), path));
    EXPECT_FALSE(finds(with(&LoadOptions::bounds, std::optional<Bounds>({1, 2, 3, 4})), path));
    EXPECT_FALSE(finds(options_of(), path, 2));
    fs::copy_file(path, folder() / "copy.tif");
    EXPECT_FALSE(finds(options_of(), (folder() / "copy.tif").string()));
    // An entry of another name than its own: that of the options with the void given.
    const std::vector<CachedDem> entries = cached_dems(Drawn::place());
    ASSERT_EQ(entries.size(), 2U);
    fs::rename(entries[0].entry.path, folder() / "spare");
    fs::rename(entries[1].entry.path, entries[0].entry.path);
    fs::rename(folder() / "spare", entries[1].entry.path);
    EXPECT_FALSE(finds(one, path));
    EXPECT_FALSE(finds(options_of(), path));
}

/// Two DEMs in one archive.
TEST(LevelCache, ADemOfAnArchiveIsNotAnother) {
    const std::string path = hills(), archive = "/vsizip/" + (folder() / "two.zip").string();
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    VSILFILE* const zip = VSIFOpenL(archive.c_str(), "wb");  // open until all members are in
    for (const char* name : {"/x.tif", "/y.tif"}) {
        VSILFILE* const member = VSIFOpenL((archive + name).c_str(), "wb");
        ASSERT_EQ(VSIFWriteL(bytes.data(), 1, bytes.size(), member), bytes.size());
        VSIFCloseL(member);
    }
    VSIFCloseL(zip);
    const std::vector<std::string> first{archive + "/x.tif"}, second{archive + "/y.tif"};
    ASSERT_TRUE(state_of_files(first));
    EXPECT_NE(state_of_files(first), state_of_files(second));
}

TEST(LevelCache, AChangedDemIsReadAgain) {
    const std::string path = hills();
    const Drawn first(path, options_of());
    first.keep();
    ASSERT_TRUE(first.is_kept());
    const auto touch = [&] {  // the same bytes, a nanosecond later
        fs::last_write_time(path, fs::last_write_time(path) + std::chrono::nanoseconds(1));
    };
    touch();
    const Drawn second(path, options_of());
    EXPECT_FALSE(second.is_kept());
    const LevelCache before = second.cache();
    touch();
    Drawn::place().clear();
    before.write(second.field, second.pyramid, second.water);
    EXPECT_TRUE(Drawn::place().entries().empty()) << "it has changed while its cache was made";
    const Drawn third(path, options_of());
    third.keep();
    ASSERT_TRUE(third.is_kept());
    test::add_outer_overviews(path, {2});
    EXPECT_FALSE(Drawn(path, options_of()).is_kept()) << "overviews next to it";
}

/// Gets the name of another one after it was opened, and before its state is asked for.
TEST(LevelCache, AReplacedDemGetsNoEntryOfTheOneBefore) {
    const std::string path = hills(), other = hills("other.tif");
    fs::last_write_time(other, fs::last_write_time(path));
    const Drawn drawn(path, options_of());
    fs::rename(other, path);
    drawn.keep();
    EXPECT_TRUE(Drawn::place().entries().empty()) << "renamed";

    fs::create_directory(folder() / "old");
    fs::create_directory(folder() / "new");
    fs::copy_file(path, folder() / "old/dem.tif");
    fs::copy_file(path, folder() / "new/dem.tif");
    const fs::path link = folder() / "dem.tif", folder_link = folder() / "now";
    const auto link_to = [](const fs::path& target, const fs::path& at) {
        fs::remove(at);
        fs::create_symlink(target, at);
    };
    link_to("old/dem.tif", link);
    link_to("old", folder_link);
    for (const fs::path& name : {link, folder_link / "dem.tif"}) {
        const Drawn of_old(name.string(), options_of());
        link_to("new/dem.tif", link);
        link_to("new", folder_link);
        of_old.keep();
        EXPECT_TRUE(Drawn::place().entries().empty()) << name;
        link_to("old", folder_link);
    }
    const Drawn later(link.string(), options_of());
    later.keep();
    EXPECT_TRUE(later.is_kept());
}

TEST(LevelCache, DamageIsFound) {
    const Drawn drawn(hills(), options_of());
    drawn.cache().write(drawn.field, drawn.pyramid, drawn.water);
    const fs::path entry = cached_dems(Drawn::place()).at(0).entry.path;
    const auto size = fs::file_size(entry);
    for (std::uintmax_t at = 0; at < size; at += 1 + size / 97) {
        std::fstream bytes(entry, std::ios::in | std::ios::out | std::ios::binary);
        bytes.seekg(static_cast<std::streamoff>(at));
        const auto before = static_cast<char>(bytes.get());
        bytes.seekp(static_cast<std::streamoff>(at));
        bytes.put(static_cast<char>(~before));
        bytes.flush();
        EXPECT_FALSE(drawn.cache().read(drawn.source.grid(), 4)) << "byte " << at;
        bytes.seekp(static_cast<std::streamoff>(at));
        bytes.put(before);
    }
    EXPECT_TRUE(drawn.cache().read(drawn.source.grid(), 4));
    fs::resize_file(entry, size - 1);
    EXPECT_FALSE(drawn.cache().read(drawn.source.grid(), 4));
    // It is replaced.
    drawn.cache().write(drawn.field, drawn.pyramid, drawn.water);
    EXPECT_TRUE(drawn.cache().read(drawn.source.grid(), 4));
}

TEST(LevelCache, OfManyFilesSizesAndTimesAreCompared) {
    std::vector<std::string> tiles;
    for (int i = 0; i < 20; ++i) {
        Raster raster;
        raster.geotransform = {{500000.0 + 180 * i, 30, 0, 5200000, 0, -30}};
        tiles.push_back(
            test::write_raster(folder() / ("tile" + std::to_string(i) + ".tif"), raster));
    }
    const std::optional<std::string> before = state_of_files(tiles);
    ASSERT_TRUE(before);
    EXPECT_EQ(state_of_files(tiles), before);
    fs::last_write_time(tiles[13], fs::last_write_time(tiles[13]) + std::chrono::nanoseconds(1));
    const std::optional<std::string> touched = state_of_files(tiles);
    EXPECT_NE(touched, before);
    std::ofstream(tiles[7] + ".aux.xml") << "<PAMDataset/>";
    EXPECT_NE(state_of_files(tiles), touched);
}

TEST(LevelCache, WhatIsNoFileOfThisMachineIsNotCached) {
    const std::vector<std::string> paths{"/vsicurl/http://127.0.0.1:9/a.tif"};
    EXPECT_FALSE(state_of_files(paths));
    const std::string path = hills();
    const std::string vrt = (folder() / "far.vrt").string();
    std::ofstream(vrt) << "<VRTDataset rasterXSize=\"400\" rasterYSize=\"300\"><VRTRasterBand "
                          "dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
                          "relativeToVRT=\"0\">/vsicurl/http://127.0.0.1:9/a.tif</SourceFilename>"
                          "</SimpleSource></VRTRasterBand></VRTDataset>";
    EXPECT_FALSE(state_of_files(std::vector<std::string>{vrt}));
    EXPECT_TRUE(state_of_files(std::vector<std::string>{path}));
}

}  // namespace
}  // namespace relevo::dem::test_level_cache
