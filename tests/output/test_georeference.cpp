#include <array>
#include <fstream>

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <ogr_spatialref.h>

#include "output/georeference.h"
#include "support/support.h"

namespace relevo::output {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

const Georeference kWhere{{400000, 15, 0, 5300000, 0, -10}, "EPSG:32632"};

TEST(Georeference, FilesAreNamedAsGdalLooksForThem) {
    EXPECT_THAT(georeference_files("a/map.png"),
                ElementsAre(fs::path("a/map.pgw"), fs::path("a/map.png.aux.xml")));
    EXPECT_THAT(georeference_files("map.jpeg"),
                ElementsAre(fs::path("map.jgw"), fs::path("map.jpeg.aux.xml")));
    EXPECT_THAT(georeference_files("map.webp"),
                ElementsAre(fs::path("map.wpw"), fs::path("map.webp.aux.xml")));
    EXPECT_THAT(georeference_files("map.PNG"),
                ElementsAre(fs::path("map.PGW"), fs::path("map.PNG.aux.xml")));
    EXPECT_THAT(georeference_files("map.TIF"), ElementsAre());
}

TEST(Georeference, AWorldFileHasTheCentreOfTheFirstPixel) {
    EXPECT_EQ(georeference_texts(kWhere)[0], "15\n0\n0\n-10\n400007.5\n5299995\n");
}

/// A grey PNG of 2 x 1 pixels, by GDAL.
void make_png(const fs::path& path) {
    GDALAllRegister();
    GDALDriverManager& drivers = *GetGDALDriverManager();
    GDALDataset* const memory =
        drivers.GetDriverByName("MEM")->Create("", 2, 1, 1, GDT_Byte, nullptr);
    GDALClose(drivers.GetDriverByName("PNG")->CreateCopy(path.c_str(), memory, 0, nullptr, nullptr,
                                                         nullptr));
    GDALClose(memory);
}

TEST(Georeference, GdalReadsPlaceAndCrsOfFilesBeside) {
    for (const char* crs : {"EPSG:32632", "EPSG:4326", "EPSG:27700"}) {
        const fs::path png = test::scratch_dir() / "map.png";
        make_png(png);
        const Georeference where{kWhere.geotransform, crs};
        const auto files = georeference_files(png);
        const auto texts = georeference_texts(where);
        for (std::size_t i = 0; i < files.size(); ++i)
            std::ofstream(files[i]) << texts[i];
        GDALDataset* const dataset =
            GDALDataset::Open(png.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR);
        ASSERT_TRUE(dataset);
        std::array<double, 6> found{};
        EXPECT_EQ(dataset->GetGeoTransform(found.data()), CE_None);
        EXPECT_EQ(found, where.geotransform);
        OGRSpatialReference expected;
        expected.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        expected.SetFromUserInput(crs);
        ASSERT_TRUE(dataset->GetSpatialRef());
        EXPECT_TRUE(dataset->GetSpatialRef()->IsSame(&expected)) << crs;
        EXPECT_EQ(dataset->GetSpatialRef()->GetDataAxisToSRSAxisMapping(),
                  expected.GetDataAxisToSRSAxisMapping());
        GDALClose(dataset);
    }
}

TEST(Georeference, RefusesACrsThatGdalDoesNotKnow) {
    EXPECT_EQ(test::error_of([] {
                  georeference_texts({kWhere.geotransform, "EPSG:1"});
              }),
              "exit 1: georeference: EPSG:1: GDAL does not know this CRS");
}

TEST(Georeference, RefusesWhatIsNoTiff) {
    const fs::path path = test::scratch_dir() / "map.tif";
    OutputFile file(path, false, "image");
    const std::array<std::byte, 4> bytes{};
    EXPECT_THAT(test::error_of([&] { write_geotiff(file, bytes, kWhere); }),
                testing::StartsWith("exit 1: image: " + path.string() + ": cannot be written, "));
    EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace relevo::output
