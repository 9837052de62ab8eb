#include "dem/fixture.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include "base/error.h"
#include "support/support.h"

namespace relevo::test {
namespace {

void must(bool condition, const char* what) {
    if (!condition) failed(std::string("write_raster: ") + what);
}

}  // namespace

const std::filesystem::path& folder() {
    static std::filesystem::path made;
    static const testing::TestInfo* of = nullptr;
    const testing::TestInfo* const now = testing::UnitTest::GetInstance()->current_test_info();
    if (made.empty() || now != of) made = scratch_dir("rasters");
    of = now;
    return made;
}

std::string small_case(const std::string& name) {
    return (source_dir() / "tests/data/cases" / name).string();
}

std::string write_raster(const std::filesystem::path& path, const Raster& raster) {
    GDALAllRegister();
    // Formats that GDAL only copies into go through memory.
    GDALDriverH driver = GDALGetDriverByName(raster.driver.c_str());
    must(driver, "no such driver");
    const bool direct = GDALGetMetadataItem(driver, GDAL_DCAP_CREATE, nullptr) != nullptr;
    GDALDriverH first = direct ? driver : GDALGetDriverByName("MEM");
    CPLStringList options;
    for (const std::string& option : raster.options)
        options.AddString(option.c_str());
    GDALDatasetH dataset =
        GDALCreate(first, direct ? path.c_str() : "", raster.columns, raster.rows, raster.bands,
                   GDALGetDataTypeByName(raster.type.c_str()), direct ? options.List() : nullptr);
    must(dataset, "cannot be created");
    if (raster.pixel_is_point) {
        // GDAL would shift the tie point by half a cell so that the cells stay where they are.
        CPLSetConfigOption("GTIFF_POINT_GEO_IGNORE", "TRUE");
        GDALSetMetadataItem(dataset, GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT, nullptr);
    }
    if (raster.geotransform) {
        std::array<double, 6> g = *raster.geotransform;
        must(GDALSetGeoTransform(dataset, g.data()) == CE_None, "geotransform");
    }
    if (!raster.crs.empty()) {
        OGRSpatialReferenceH srs = OSRNewSpatialReference(nullptr);
        must(OSRSetFromUserInput(srs, raster.crs.c_str()) == OGRERR_NONE, "crs");
        must(GDALSetSpatialRef(dataset, srs) == CE_None, "crs");
        OSRDestroySpatialReference(srs);
    }
    for (int b = 1; b <= raster.bands; ++b) {
        GDALRasterBandH band = GDALGetRasterBand(dataset, b);
        if (raster.nodata) GDALSetRasterNoDataValue(band, *raster.nodata);
        if (!raster.unit.empty()) GDALSetRasterUnitType(band, raster.unit.c_str());
        for (const auto& [key, value] : raster.about)
            GDALSetMetadataItem(band, key.c_str(), value.c_str(), nullptr);
        if (raster.scale) GDALSetRasterScale(band, *raster.scale);
        if (raster.offset) GDALSetRasterOffset(band, *raster.offset);
        if (raster.pictures)
            GDALSetRasterColorInterpretation(band,
                                             static_cast<GDALColorInterp>(GCI_RedBand + b - 1));
        std::vector<double> row(static_cast<std::size_t>(raster.columns));
        for (int r = 0; r < raster.rows; ++r) {
            for (int c = 0; c < raster.columns; ++c)
                row[static_cast<std::size_t>(c)] = raster.value(c, r, b);
            must(GDALRasterIO(band, GF_Write, 0, r, raster.columns, 1, row.data(), raster.columns,
                              1, GDT_Float64, 0, 0) == CE_None,
                 "values");
        }
    }
    if (raster.mask) {
        must(GDALCreateDatasetMaskBand(dataset, GMF_PER_DATASET) == CE_None, "mask");
        GDALRasterBandH mask = GDALGetMaskBand(GDALGetRasterBand(dataset, 1));
        for (int r = 0; r < raster.rows; ++r)
            for (int c = 0; c < raster.columns; ++c) {
                unsigned char value = raster.mask(c, r) ? 255 : 0;
                must(GDALRasterIO(mask, GF_Write, c, r, 1, 1, &value, 1, 1, GDT_Byte, 0, 0) ==
                         CE_None,
                     "mask");
            }
    }
    if (!direct) {
        GDALDatasetH copy =
            GDALCreateCopy(driver, path.c_str(), dataset, FALSE, options.List(), nullptr, nullptr);
        must(copy, "cannot be copied");
        GDALClose(copy);
    }
    GDALClose(dataset);
    CPLSetConfigOption("GTIFF_POINT_GEO_IGNORE", nullptr);
    return path.string();
}

std::string write_sparse_raster(const std::filesystem::path& path, const Raster& raster,
                                const std::vector<std::array<double, 3>>& posts) {
    CPLStringList options;
    for (const std::string& option : raster.options)
        options.AddString(option.c_str());
    GDALAllRegister();
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName(raster.driver.c_str()), path.c_str(),
                                      raster.columns, raster.rows, raster.bands,
                                      GDALGetDataTypeByName(raster.type.c_str()), options.List());
    must(dataset, "cannot be created");
    std::array<double, 6> g = *raster.geotransform;
    must(GDALSetGeoTransform(dataset, g.data()) == CE_None, "geotransform");
    OGRSpatialReferenceH srs = OSRNewSpatialReference(nullptr);
    must(OSRSetFromUserInput(srs, raster.crs.c_str()) == OGRERR_NONE, "crs");
    must(GDALSetSpatialRef(dataset, srs) == CE_None, "crs");
    OSRDestroySpatialReference(srs);
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (raster.nodata) GDALSetRasterNoDataValue(band, *raster.nodata);
    for (std::array<double, 3> post : posts)
        must(GDALRasterIO(band, GF_Write, static_cast<int>(post[0]), static_cast<int>(post[1]), 1,
                          1, &post[2], 1, 1, GDT_Float64, 0, 0) == CE_None,
             "values");
    GDALClose(dataset);
    return path.string();
}

namespace {

void build_overviews(const std::string& path, std::vector<int> factors, GDALAccess access) {
    GDALDatasetH dataset = GDALOpen(path.c_str(), access);
    must(dataset, "cannot be opened");
    must(GDALBuildOverviews(dataset, "AVERAGE", static_cast<int>(factors.size()), factors.data(), 0,
                            nullptr, GDALDummyProgress, nullptr) == CE_None,
         "overviews");
    GDALClose(dataset);
}

}  // namespace

void add_overviews(const std::string& path, std::vector<int> factors) {
    build_overviews(path, std::move(factors), GA_Update);
}

void add_outer_overviews(const std::string& path, std::vector<int> factors) {
    build_overviews(path, std::move(factors), GA_ReadOnly);
}

void cut_short(const std::string& path, std::uintmax_t bytes) {
    std::filesystem::resize_file(path, bytes);
}

}  // namespace relevo::test
