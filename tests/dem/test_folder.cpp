#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "base/log.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "support/support.h"

namespace relevo::dem::test_folder {
namespace {

using test::Raster;
using test::write_raster;
using testing::ElementsAre;
using testing::IsEmpty;

std::filesystem::path made(const char* name) {
    static const std::filesystem::path all = test::scratch_dir("dem_folder");
    std::filesystem::create_directories(all / name);
    return all / name;
}

Raster tile(int column) {
    Raster raster;
    raster.geotransform = {{500000 + 180.0 * column, 30, 0, 5200000, 0, -30}};
    return raster;
}

/// What is said while a folder is opened, and the files it becomes.
struct Opened {
    std::vector<std::string> said, files;
    explicit Opened(const std::filesystem::path& folder) {
        log::set_sink([&](log::Level, std::string_view text) { said.emplace_back(text); });
        for (const std::string& file : load(folder.string()).about.files)
            files.push_back(std::filesystem::path(file).filename());
        log::set_sink({});
    }
};

TEST(Folder, ItsRastersAreOneDemInTheOrderOfTheirNames) {
    const std::filesystem::path dir = made("tiles");
    for (const int i : {2, 0, 1})
        write_raster(dir / ("t" + std::to_string(i) + ".tif"), tile(i));
    const Heightfield f = load(dir.string());
    EXPECT_EQ(f.grid.columns(), 18);
    EXPECT_EQ(f.about.statistics.holes, 0);
    EXPECT_EQ(f.about.path, (dir / "t0.tif").string() + " and 2 more");
    EXPECT_THAT(Opened(dir).files, ElementsAre("t0.tif", "t1.tif", "t2.tif"));
    EXPECT_EQ(load(dir.string() + "/").grid.columns(), 18);
    // Beside other names.
    const std::string far = write_raster(made("more") / "t3.tif", tile(3));
    const std::vector<std::string> paths{dir.string(), far};
    EXPECT_EQ(load(paths).grid.columns(), 24);
}

TEST(Folder, AVirtualRasterStandsForItsTiles) {
    const std::filesystem::path dir = made("virtual");
    write_raster(dir / "a.tif", tile(0));
    write_raster(dir / "b.tif", tile(1));
    std::ofstream(dir / "all.vrt")
        << "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><SRS>EPSG:32632</SRS>"
           "<GeoTransform>500000,30,0,5200000,0,-30</GeoTransform>"
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
           "<SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename>"
           "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    EXPECT_THAT(Opened(dir).files, ElementsAre("all.vrt", "b.tif"));
}

TEST(Folder, WhatIsLeftOutIsSaid) {
    const std::filesystem::path dir = made("mixed");
    write_raster(dir / "a.tif", tile(0));
    for (const char* name : {"LICENSE", "index.html", "notes.txt", "z.csv"})
        std::ofstream(dir / name) << "Heights of the Alps, to be measured.\n";
    EXPECT_THAT(
        Opened(dir).said,
        ElementsAre(
            dir.string() +
            ": 4 of its files are no rasters and skipped: LICENSE, index.html, notes.txt, ..."));
}

TEST(Folder, WhatBelongsToARasterIsNone) {
    const std::filesystem::path dir = made("beside");
    const auto text = [&](const std::string& name, const std::string& content) {
        std::ofstream(dir / name) << content;
    };
    for (const int i : {0, 1, 2}) {
        const std::string name = "t" + std::to_string(i);
        Raster raster = tile(i);
        raster.columns = raster.rows = 300;
        raster.geotransform = {{500000 + 9000.0 * i, 30, 0, 5200000, 0, -30}};
        // Overviews beside it, as gdaladdo -ro and as other programs name them.
        const std::string path = write_raster(dir / (name + ".tif"), raster);
        test::add_outer_overviews(path, {2, 4});
        std::filesystem::copy_file(path + ".ovr", dir / (name + ".ovr"));
        text(name + ".tfw",
             "30\n0\n0\n-30\n" + std::to_string(500015 + 9000 * i) + ".0000001\n5199985\n");
        text(name + ".prj", "PROJCS[\"not read\"]");
        text(name + ".tif.aux.xml",
             "<PAMDataset><PAMRasterBand band=\"1\"><Metadata><MDI key=\"STATISTICS_MAXIMUM\">"
             "9</MDI></Metadata></PAMRasterBand></PAMDataset>");
        text(name + ".aux.xml", "<PAMDataset/>");
        text(name + ".tif.xml", "<metadata/>");
        text(name + ".hdr", "NCOLS 300\nNROWS 300\nNBITS 32\n");
        text(name + ".txt", "flown in June");
        text(name + ".tif.md5", "d41d8cd98f00b204e9800998ecf8427e");
        // A description of it for catalogues, which GDAL has a driver for.
        text(name + ".json",
             "{\"type\": \"Feature\", \"stac_version\": \"1.0.0\", \"stac_extensions\": "
             "[\"https://stac-extensions.github.io/projection/v1.0.0/schema.json\"], "
             "\"properties\": {\"proj:epsg\": 32632, \"proj:transform\": [30, 0, 500000, 0, "
             "-30, 5200000]}, \"assets\": {\"data\": {\"href\": \"" +
                 name + ".tif\"}}}");
    }
    text("README", "Tiles.");
    text("README.md", "Tiles.");
    const Opened opened(dir);
    EXPECT_THAT(opened.files, ElementsAre("t0.tif", "t1.tif", "t2.tif"));
    EXPECT_THAT(opened.said, IsEmpty());
    const Heightfield f = load(dir.string());
    EXPECT_EQ(f.grid.columns(), 900);
    EXPECT_EQ(f.about.statistics.holes, 0);
    EXPECT_THAT(f.about.guesses, IsEmpty());
}

TEST(Folder, WhatCannotBeOneDemHasItsMessage) {
    const auto refusal = [](const std::filesystem::path& dir) {
        return test::error_of([&] { load(dir.string()); });
    };
    const std::filesystem::path empty = made("empty");
    EXPECT_EQ(refusal(empty), "exit 3: " + empty.string() +
                                  ": a folder without a raster in it, expected a raster or a "
                                  "folder of rasters");
    const std::filesystem::path outer = made("outer");
    made("outer/inner");
    EXPECT_EQ(refusal(outer), "exit 3: " + outer.string() +
                                  ": a folder without a raster in it, expected a raster or a "
                                  "folder of rasters; name one of its folders");
    const std::filesystem::path dir = made("with_picture");
    write_raster(dir / "a.tif", tile(0));
    Raster picture = tile(1);
    picture.type = "Byte";
    picture.bands = 3;
    picture.pictures = true;
    picture.value = [](int column, int row, int band) { return column * 40 + row * 9 + band; };
    const std::string name = write_raster(dir / "preview.tif", picture);
    EXPECT_EQ(refusal(dir),
              "exit 3: " + name +
                  ": a picture (red, green and blue bands of 8 bits), expected heights; if its "
                  "colours encode heights pass --encoding terrain-rgb or terrarium, if one band "
                  "holds them --band N; it is one of 2 in " +
                  dir.string() + ", name the right ones");
    // A damaged tile is no missing one.
    const std::filesystem::path cut = made("cut");
    write_raster(cut / "a.tif", tile(0));
    test::cut_short(write_raster(cut / "b.tif", tile(1)), 60);
    EXPECT_THAT(refusal(cut),
                testing::EndsWith("it is one of 2 in " + cut.string() + ", name the right ones"));
}

TEST(Folder, PipesInItAreNotWaitedFor) {
    const std::filesystem::path dir = made("pipes");
    write_raster(dir / "a.tif", tile(0));
    ASSERT_EQ(mkfifo((dir / "b.tif").c_str(), 0600), 0);
    EXPECT_THAT(Opened(dir).said,
                ElementsAre(dir.string() + ": 1 of its files is no raster and skipped: b.tif"));
}

}  // namespace
}  // namespace relevo::dem::test_folder
