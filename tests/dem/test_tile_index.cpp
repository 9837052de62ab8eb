#include <filesystem>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "dem/files_of.h"
#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "dem/tile_index.h"
#include "support/support.h"

namespace relevo::dem::test_tile_index {
namespace {

using test::claim_rows;
using test::error_of;
using test::folder;
using test::IndexLayer;
using test::IndexRow;
using test::packed;
using test::write_index;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> names_of(const TileIndex& index) {
    std::vector<std::string> names;
    for (const IndexedTile& tile : index.tiles)
        names.push_back(tile.name);
    return names;
}

const std::vector<IndexRow> kTwo = {{"tiles/a.tif", {465000, 5896000, 466000, 5897000}},
                                    {"tiles/b.tif", {466000, 5896000, 467000, 5897000}}};

TEST(TileIndex, LayersOfAllFormatsAreTheSame) {
    const std::vector<std::pair<std::string, std::string>> formats = {{"i.gpkg", "GPKG"},
                                                                      {"i.fgb", "FlatGeobuf"},
                                                                      {"i.shp", "ESRI Shapefile"},
                                                                      {"i.geojson", "GeoJSON"}};
    for (const auto& [name, driver] : formats) {
        IndexLayer layer;
        std::vector<IndexRow> rows = kTwo;
        if (driver == "GeoJSON") {  // which has WGS 84 alone
            layer.crs = "EPSG:4326";
            rows[0].extent = {8, 53, 8.25, 53.5};
            rows[1].extent = {8.25, 53, 8.5, 53.5};
        }
        if (driver == "ESRI Shapefile") layer.field = "LOCATION";
        const std::string path = write_index(folder() / name, driver, rows, layer);
        ASSERT_TRUE(is_tile_index(path)) << driver;
        const TileIndex index = read_tile_index(path);
        EXPECT_EQ(index.format, driver);
        ASSERT_EQ(index.tiles.size(), 2u) << driver;
        EXPECT_THAT(names_of(index), testing::UnorderedElementsAre("a", "b"));
        ASSERT_EQ(index.crs.size(), 1u);
        EXPECT_EQ(index.crs.front().text(), layer.crs);
        for (const IndexedTile& tile : index.tiles) {
            const IndexRow& row = rows[tile.name == "a" ? 0 : 1];
            EXPECT_EQ(tile.location, (folder() / row.location).string());
            EXPECT_EQ(tile.extent,
                      (Extent{row.extent[0], row.extent[1], row.extent[2], row.extent[3]}));
            EXPECT_EQ(tile.crs, 0);
            EXPECT_FALSE(tile.posts);
        }
    }
}

TEST(TileIndex, APackedOneIsUnpackedInMemory) {
    const std::string path = packed(write_index(folder() / "i.gpkg", "GPKG", kTwo));
    std::filesystem::remove(folder() / "i.gpkg");
    ASSERT_TRUE(is_tile_index(path));
    const TileIndex index = read_tile_index(path);
    EXPECT_THAT(names_of(index), ElementsAre("a", "b"));
    EXPECT_EQ(index.tiles[0].location, (folder() / "tiles/a.tif").string());
    // Nothing is left beside it.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 1);
    test::cut_short(path, std::filesystem::file_size(path) / 2);
    EXPECT_EQ(error_of([&] { read_tile_index(path); }),
              "exit 3: " + path + ": cannot be unpacked; the file is damaged or incomplete");
}

TEST(TileIndex, ReadsThoseOfRealStates) {
    SKIP_WITHOUT_TEST_DATA(data);
    const TileIndex bremen =
        read_tile_index((data / "tile-index/hb_dom1_tindex_proj.gpkg.gz").string());
    ASSERT_EQ(bremen.tiles.size(), 509u);
    EXPECT_EQ(bremen.crs.front().text(), "EPSG:25832");
    EXPECT_EQ(bremen.tiles[0].name, "dom1_32465_5896_1_hb");
    EXPECT_EQ(bremen.tiles[0].extent, (Extent{465000, 5896000, 466000, 5897000}));
    EXPECT_EQ(bremen.tiles[0].location,
              (data / "tile-index/Gitternetz_DOM1_2017/dom1_32465_5896_1_hb.xyz").string());
    EXPECT_NO_THROW(refuse_remote_tiles(bremen));
    const std::string path = (data / "tile-index/HE_DSM_tindex.gpkg.gz").string();
    const TileIndex hesse = read_tile_index(path);
    EXPECT_EQ(hesse.tiles.size() + hesse.repeated, 32185u);
    EXPECT_EQ(hesse.tiles[0].name, "dom1_32_483_5484_1_he");
    EXPECT_EQ(hesse.tiles[0].extent, (Extent{483000, 5484000, 484000, 5485000}));
    EXPECT_THAT(error_of([&] { refuse_remote_tiles(hesse); }),
                StartsWith("exit 3: " + path + ": its tiles are on the net ('/vsizip/vsicurl/"));
}

TEST(TileIndex, LocationsAreAsGdalOpensThem) {
    const std::vector<std::string> given = {"b/x.tif",
                                            "./y.tif",
                                            "/data/z.tif",
                                            "https://a.org/t.tif?key=1.2",
                                            "s3://bucket/u.tif",
                                            "gs://bucket/v.tif",
                                            "file:///data/w.tif",
                                            "/vsizip/a.zip/q.tif",
                                            "NETCDF:a.nc:topo"};
    std::vector<IndexRow> rows;
    for (const std::string& location : given)
        rows.push_back({location, {0, 0, 1000, 1000}});
    const TileIndex index = read_tile_index(write_index(folder() / "i.gpkg", "GPKG", rows));
    std::vector<std::string> locations;
    for (const IndexedTile& tile : index.tiles)
        locations.push_back(tile.location);
    EXPECT_THAT(locations,
                ElementsAre((folder() / "b/x.tif").string(), (folder() / "y.tif").string(),
                            "/data/z.tif", "/vsicurl/https://a.org/t.tif?key=1.2",
                            "/vsis3/bucket/u.tif", "/vsigs/bucket/v.tif", "/data/w.tif",
                            "/vsizip/a.zip/q.tif", "NETCDF:a.nc:topo"));
    EXPECT_THAT(names_of(index), ElementsAre("x", "y", "z", "t", "u", "v", "w", "q", "NETCDF_a"));
}

// Whoever protects the tiles does not know with which --crs the index is read.
TEST(TileIndex, ItsFilesAreKnownWithoutTheRightCrs) {
    IndexLayer degrees;
    degrees.crs = "EPSG:4326";  // of metres
    std::vector<IndexRow> rows = kTwo;
    rows[1].crs = "EPSG:0";
    const std::string path = write_index(folder() / "i.gpkg", "GPKG", rows, degrees);
    const std::vector<std::string> tiles{(folder() / "tiles/a.tif").string(),
                                         (folder() / "tiles/b.tif").string()};
    EXPECT_THAT(error_of([&] { read_tile_index(path); }), HasSubstr("pass the right one with"));
    EXPECT_EQ(tile_locations(path), tiles);
    std::filesystem::create_directories(folder() / "tiles");
    for (const std::string& tile : tiles)
        std::ofstream(tile) << "here";
    const std::vector<std::filesystem::path> files = files_of(std::vector{path});
    EXPECT_THAT(files, ElementsAre(path, tiles[0], tiles[1]));
    const std::string stac = (folder() / "i.json").string();
    std::ofstream(stac) << R"({"type": "FeatureCollection", "features": [{"type": "Feature", )"
                           R"("stac_version": "1.1.0", "properties": {"proj:code": "EPSG:0", )"
                           R"("proj:bbox": [0, 0, 1, 1]}, "assets": {"a": {"href": )"
                           R"("tiles/a.tif", "roles": ["data"]}}}]})";
    EXPECT_THAT(tile_locations(stac), ElementsAre(tiles[0]));
}

TEST(TileIndex, NamesAreUnique) {
    const std::array<double, 4> at = {0, 0, 1000, 1000};
    const TileIndex index = read_tile_index(write_index(folder() / "i.gpkg", "GPKG",
                                                        {{"a/t.tif", at},
                                                         {"b/t.tif", at},
                                                         {"c/t_2.tif", at},
                                                         {"a/t.tif", at},
                                                         {"d/t.tif", at},
                                                         {"e/new\nline \"q\" é.tif", at},
                                                         {"f/no ending", at},
                                                         {"g/.tif", at}}));
    EXPECT_THAT(names_of(index),
                ElementsAre("t", "t_2", "t_2_2", "t_3", "new_line \"q\" é", "no ending", ".tif"));
    EXPECT_EQ(index.repeated, 1u);
}

TEST(TileIndex, TilesInOtherZonesHaveTheirOwnCrs) {
    const std::string path =
        write_index(folder() / "i.gpkg", "GPKG",
                    {{"a.tif", {500000, 5200000, 510000, 5210000}},
                     {"b.tif", {720000, 5200000, 730000, 5210000}, "EPSG:32633"}});
    const TileIndex index = read_tile_index(path);
    ASSERT_EQ(index.crs.size(), 2u);
    EXPECT_EQ(index.crs[static_cast<std::size_t>(index.tiles[1].crs)].text(), "EPSG:32633");
    // Zone 33 has its middle 6 degrees further east, and turns the other way.
    EXPECT_NEAR(index.tiles[1].extent.west, 263000, 2000);
    EXPECT_GT(index.tiles[1].extent.east - index.tiles[1].extent.west, 10000);
    // What the caller says holds for tiles that have none.
    const geo::Crs zone31 = geo::Crs::parse("EPSG:32631", "test");
    const TileIndex other = read_tile_index(path, "", &zone31);
    EXPECT_EQ(other.crs[static_cast<std::size_t>(other.tiles[0].crs)].text(), "EPSG:32631");
    EXPECT_EQ(other.crs[static_cast<std::size_t>(other.tiles[1].crs)].text(), "EPSG:32633");
    // --crs replaces what the index says.
    const TileIndex given = read_tile_index(path, "EPSG:25832");
    ASSERT_EQ(given.crs.size(), 1u);
    EXPECT_EQ(given.tiles[1].extent, (Extent{720000, 5200000, 730000, 5210000}));
}

std::string refusal(const std::string& name, const std::vector<IndexRow>& rows,
                    const IndexLayer& layer = {}) {
    const std::string path = write_index(folder() / name, "GPKG", rows, layer);
    const std::string message = error_of([&] { read_tile_index(path); });
    const std::string start = "exit 3: " + path + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

TEST(TileIndex, BadRowsAreRefusedByName) {
    const std::array<double, 4> at = {465000, 5896000, 466000, 5897000};
    EXPECT_EQ(refusal("empty.gpkg", {}), "an index without a tile in it");
    EXPECT_EQ(refusal("nameless.gpkg", {{"a.tif", at}, {"", at}}), "tile 2: names no file");
    EXPECT_EQ(refusal("point.gpkg", {{"a.tif", {465000, 5896000, 465000, 5897000}}}),
              "tile 1 ('a.tif'): an outline without an area");
    EXPECT_EQ(refusal("nan.gpkg", {{"a.tif", at}, {"b.tif", {kNaN, 0, 1, 1}}}),
              "tile 2 ('b.tif'): an outline with a coordinate that is not a number");
    IndexLayer bare;
    bare.with_outlines = false;
    EXPECT_EQ(refusal("bare.gpkg", {{"a.tif", at}}, bare),
              "tile 1 ('a.tif'): no outline, its place is unknown");
    IndexLayer degrees;
    degrees.crs = "EPSG:4326";
    EXPECT_EQ(refusal("wrong.gpkg", {{"a.tif", at}}, degrees),
              "tile 1 ('a.tif'): its middle is at 465500, 5896500, which is not on the Earth in "
              "WGS 84; pass the right one with --crs EPSG:n");
    EXPECT_THAT(refusal("unknown.gpkg", {{"a.tif", at, "EPSG:0"}}),
                StartsWith("EPSG:0: not a coordinate reference system"));
    IndexLayer other;
    other.field = "file";
    EXPECT_FALSE(is_tile_index(write_index(folder() / "other.gpkg", "GPKG", kTwo, other)));
}

TEST(TileIndex, MoreRowsThanAnIndexMayHaveAreNotRead) {
    const std::string path = write_index(folder() / "i.gpkg", "GPKG", kTwo);
    claim_rows(path, 10'000'000);
    EXPECT_EQ(error_of([&] { read_tile_index(path); }),
              "exit 3: " + path +
                  ": an index of 10000000 tiles, expected at most 1000000; cut it up, for example "
                  "with ogr2ogr -spat");
}

TEST(TileIndex, WithoutACrsItsTilesHaveNone) {
    IndexLayer none;
    none.crs = "";
    const TileIndex index = read_tile_index(write_index(folder() / "i.gpkg", "GPKG", kTwo, none));
    EXPECT_EQ(index.tiles[0].crs, -1);
    EXPECT_TRUE(index.crs.empty());
}

TEST(TileIndex, CutHalfwayIsRefused) {
    std::vector<IndexRow> rows;
    for (int i = 0; i < 3000; ++i)
        rows.push_back(
            {fmt::format("tile_{}.tif", i), {1000.0 * i, 5896000, 1000.0 * i + 1000, 5897000}});
    for (const auto& [name, driver] :
         {std::pair("i.gpkg", "GPKG"), std::pair("i.fgb", "FlatGeobuf"),
          std::pair("i.geojson", "GeoJSON")}) {
        IndexLayer layer;
        if (driver == std::string("GeoJSON")) {
            layer.crs = "EPSG:4326";
            for (std::size_t i = 0; i < rows.size(); ++i)
                rows[i].extent = {0.01 * double(i), 50, 0.01 * double(i) + 0.01, 51};
        }
        const std::string path = write_index(folder() / name, driver, rows, layer);
        ASSERT_EQ(read_tile_index(path).tiles.size(), 3000u);
        test::cut_short(path, std::filesystem::file_size(path) / 2);
        EXPECT_THAT(error_of([&] { read_tile_index(path); }), StartsWith("exit 3: " + path + ": "))
            << driver;
    }
}

std::string item(const std::string& name, const std::string& properties,
                 const std::string& assets = "") {
    return R"({"type": "Feature", "stac_version": "1.1.0", "id": ")" + name +
           R"(", "geometry": {"type": "Polygon", "coordinates": [[[8.9, 46.9], [9.1, 46.9], [9.1, )"
           R"(47], [8.9, 47], [8.9, 46.9]]]}, "bbox": [8.9, 46.9, 9.1, 47], "properties": {)" +
           properties + R"(}, "assets": {)" +
           (assets.empty() ? R"("data": {"href": "./)" + name +
                                 R"(.tif", "type": "image/tiff", "roles": ["data"]})"
                           : assets) +
           "}}";
}

std::string written(const std::string& name, const std::string& text) {
    std::ofstream(folder() / name) << text;
    return (folder() / name).string();
}

std::string collection(const std::string& items) {
    return R"({"type": "FeatureCollection", "features": [)" + items + "]}";
}

const std::string kPosts =
    R"("proj:code": "EPSG:32632", "proj:shape": [40, 60], "proj:transform": [30, 0, 500000, 0, -30, 5200000, 0, 0, 1])";

/// Items without a place of their own.
std::string without_outlines(std::string items) {
    const std::string begin = R"("geometry": {)", end = R"("properties")";
    for (std::size_t at = items.find(begin); at != items.npos; at = items.find(begin))
        items.erase(at, items.find(end, at) - at);
    return items;
}

TEST(TileIndex, StacItemsStateTheirPosts) {
    const std::string path =
        written("items.json",
                collection(without_outlines(
                    item("a", kPosts) + "," +
                    item("b", R"("proj:epsg": 32632, "proj:shape": [4, 6], "proj:transform": [30, )"
                              R"(0, 501800, 0, -30, 5200000])"))));
    ASSERT_TRUE(is_tile_index(path));
    const TileIndex index = read_tile_index(path);
    EXPECT_EQ(index.format, "STAC");
    EXPECT_THAT(names_of(index), ElementsAre("a", "b"));
    const IndexedTile& a = index.tiles[0];
    EXPECT_EQ(a.location, (folder() / "a.tif").string());
    ASSERT_TRUE(a.posts);
    EXPECT_EQ(a.posts->columns, 60);
    EXPECT_EQ(a.posts->rows, 40);
    EXPECT_EQ(a.posts->affine, (Affine{500015, 30, 0, 5199985, 0, -30}));
    EXPECT_EQ(a.extent, (Extent{500000, 5198800, 501800, 5200000}));
    EXPECT_EQ(index.crs.front().text(), "EPSG:32632");
    EXPECT_EQ(index.crs.size(), 1u);
}

TEST(TileIndex, AStacItemAloneIsOne) {
    const std::string path = written("item.json", item("a", kPosts));
    EXPECT_TRUE(is_tile_index(path));
    EXPECT_THAT(names_of(read_tile_index(path)), ElementsAre("a"));
}

TEST(TileIndex, StacItemsWithoutPostsLieWhereTheirOutlineIs) {
    const TileIndex plain = read_tile_index(written("plain.json", collection(item("a", ""))));
    EXPECT_EQ(plain.crs.front().text(), "EPSG:4326");
    EXPECT_EQ(plain.tiles[0].extent, (Extent{8.9, 46.9, 9.1, 47}));
    const TileIndex coded =
        read_tile_index(written("coded.json", collection(item("a", R"("proj:epsg": 32632)"))));
    EXPECT_EQ(coded.crs.front().text(), "EPSG:32632");
    EXPECT_NEAR(coded.tiles[0].extent.west, 492400, 200);
    const TileIndex boxed = read_tile_index(written(
        "boxed.json",
        collection(
            item("a", R"("proj:epsg": 32632, "proj:bbox": [500000, 5198800, 501800, 5200000])"))));
    EXPECT_EQ(boxed.tiles[0].extent, (Extent{500000, 5198800, 501800, 5200000}));
}

TEST(TileIndex, OutlinesAcrossTheAntimeridianAreOnePiece) {
    const auto extent = [](const std::string& coordinates, const std::string& properties = "") {
        std::string text = item("a", properties);
        const std::size_t from = text.find(R"("Polygon")"), to = text.find(R"(, "bbox")");
        text.replace(from, to - from, R"("MultiPolygon", "coordinates": [)" + coordinates + "]}");
        return read_tile_index(written("cut.json", collection(text))).tiles[0].extent;
    };
    const std::string east = "[[[179, 50], [180, 50], [180, 52], [179, 52], [179, 50]]]";
    const std::string west = "[[[-180, 50], [-177, 50], [-177, 51], [-180, 51], [-180, 50]]]";
    EXPECT_EQ(extent(east + ", " + west), (Extent{179, 50, 183, 52}));
    EXPECT_EQ(extent(west + ", " + east), (Extent{179, 50, 183, 52}));
    // In another CRS in degrees, and in metres.
    const Extent nad83 = extent(east + ", " + west, R"("proj:epsg": 4269)");
    EXPECT_NEAR(nad83.west, 179, 1e-3);
    EXPECT_NEAR(nad83.east, 183, 1e-3);
    const Extent zone1 = extent(east + ", " + west, R"("proj:epsg": 32601)");
    EXPECT_LT(zone1.east - zone1.west, 300e3);
    // Not across it: western ones, which rounding may make narrower a turn further on.
    for (double at = -179.7; at < 0; at += 0.8333333) {
        const double end = at + 0.8333333;
        const Extent found = extent(
            fmt::format("[[[{0}, 50], [{1}, 50], [{1}, 52], [{0}, 52], [{0}, 50]]]", at, end));
        ASSERT_EQ(found, (Extent{at, 50, end, 52}));
    }
    // Two islands, and the whole Earth.
    const std::string left = "[[[-20, 50], [-10, 50], [-10, 52], [-20, 50]]]";
    const std::string right = "[[[10, 50], [20, 50], [20, 52], [10, 50]]]";
    EXPECT_EQ(extent(left + ", " + right), (Extent{-20, 50, 20, 52}));
    EXPECT_EQ(extent("[[[-180, -90], [0, -90], [0, 90], [-180, -90]]], [[[0, -90], [180, -90], "
                     "[180, 90], [0, -90]]]"),
              (Extent{-180, -90, 180, 90}));
}

TEST(TileIndex, HrefsOfStacAreUris) {
    const auto location = [](const std::string& href) {
        const std::string path =
            written("uris.json",
                    collection(item("a", kPosts,
                                    R"("d": {"href": ")" + href + R"(", "roles": ["data"]})")));
        return read_tile_index(path).tiles[0].location;
    };
    const std::string here = folder().string();
    EXPECT_EQ(location("./my%20tiles/%C3%BC%23%3F.tif"), here + "/my tiles/\xc3\xbc#?.tif");
    EXPECT_EQ(location("my tiles/50%.tif"), here + "/my tiles/50%.tif");
    EXPECT_EQ(location("a%3Ab.tif"), here + "/a:b.tif");
    EXPECT_EQ(location("/data/a%20b.tif"), "/data/a b.tif");
    EXPECT_EQ(location("file:///data/a%20b.tif"), "/data/a b.tif");
    EXPECT_EQ(location("file://localhost/data/a%20b.tif"), "/data/a b.tif");
    EXPECT_EQ(location("file://server/a.tif"), "file://server/a.tif") << "of another computer";
    // Of the net, addresses stay, and so do keys of buckets.
    EXPECT_EQ(location("https://a.org/a%20b.tif"), "/vsicurl/https://a.org/a%20b.tif");
    EXPECT_EQ(location("s3://bucket/a%20b.tif"), "/vsis3/bucket/a%20b.tif");
    // An index of rows has names.
    const TileIndex rows = read_tile_index(
        write_index(folder() / "i.gpkg", "GPKG", {{"a%20b.tif", {0, 0, 1000, 1000}}}));
    EXPECT_EQ(rows.tiles[0].location, here + "/a%20b.tif");
}

TEST(TileIndex, OfStacAssetsTheHeightsAreTaken) {
    const auto location = [](const std::string& assets) {
        const TileIndex index =
            read_tile_index(written("assets.json", collection(item("a", kPosts, assets))));
        return std::filesystem::path(index.tiles[0].location).filename().string();
    };
    const std::string picture =
        R"("a_thumb": {"href": "t.png", "type": "image/png", "roles": ["thumbnail"]})";
    EXPECT_EQ(location(picture + R"(, "b": {"href": "b.tif"}, "c": {"href": "c.tif", "type": )"
                                 R"("image/tiff; application=geotiff", "roles": ["data"]})"),
              "c.tif");
    EXPECT_EQ(location(picture + R"(, "b": {"href": "b.tif"}, "c": {"href": "c.TIFF"})"), "b.tif");
    EXPECT_EQ(location(R"("z": {"href": "z.img", "roles": ["data"]})"), "z.img");
}

TEST(TileIndex, LiesOfStacAreRefusedByName) {
    const auto refusal = [](const std::string& text) {
        const std::string path = written("lies.json", text);
        const std::string message = error_of([&] { read_tile_index(path); });
        const std::string start = "exit 3: " + path + ": ";
        return message.starts_with(start) ? message.substr(start.size()) : message;
    };
    const auto lie = [&](const std::string& properties, const std::string& assets = "") {
        return refusal(collection(item("a", properties, assets)));
    };
    const std::string crs = R"("proj:code": "EPSG:32632", )";
    EXPECT_EQ(lie(crs + R"("proj:shape": [0, 6], "proj:transform": [30, 0, 5, 0, -30, 5])"),
              "Item 1 ('a'): proj:shape, expected [rows, columns] but got [0,6]");
    EXPECT_EQ(lie(crs + R"("proj:shape": [4e12, 6], "proj:transform": [30, 0, 5, 0, -30, 5])"),
              "Item 1 ('a'): proj:shape, expected [rows, columns] but got [4000000000000.0,6]");
    EXPECT_EQ(lie(crs + R"("proj:shape": [4, 6], "proj:transform": [30, 0, 5, 30, 0, 5])"),
              "Item 1 ('a'): proj:transform, expected six numbers of cells with an area but got "
              "[30,0,5,30,0,5]");
    EXPECT_THAT(lie(crs + R"("proj:shape": [4, 6], "proj:transform": ["x", 0, 5, 0, -30, 5])"),
                HasSubstr("proj:transform, expected six numbers"));
    EXPECT_EQ(lie(R"("proj:shape": [4, 6], "proj:transform": [30, 0, 5, 0, -30, 5])"),
              "Item 1 ('a'): proj:transform without proj:code");
    EXPECT_THAT(lie(R"("proj:code": "EPSG:1")"), StartsWith("EPSG:1: not a coordinate reference"));
    EXPECT_EQ(lie(kPosts, R"("a": {"href": 7, "roles": ["data"]}, "b": 3)"),
              "Item 1 ('a'): no asset that is a GeoTIFF or has the role \"data\"");
    EXPECT_EQ(refusal(R"({"type": "FeatureCollection", "stac_version": "1.0.0", "features": []})"),
              "an index without a tile in it");
    const std::string two = collection(item("a", kPosts) + "," + item("b", kPosts));
    EXPECT_THAT(refusal(two.substr(0, two.size() - 40)),
                StartsWith("no well-formed JSON at byte "));
    EXPECT_THAT(lie(crs + R"("proj:bbox": [1, 2, 3])"), HasSubstr("no outline"));
    EXPECT_THAT(lie(R"("deep": )" + std::string(5000, '[') + std::string(5000, ']')),
                testing::Eq("no error"));
}

}  // namespace
}  // namespace relevo::dem::test_tile_index
