#include "dem/index_fixture.h"

#include <fstream>
#include <iterator>

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include "base/error.h"

namespace relevo::test {
namespace {

void must_index(bool condition, const char* what) {
    if (!condition) failed(std::string("write_index: ") + what);
}

void add_row(OGRLayerH layer, const IndexRow& row, const IndexLayer& how) {
    const OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    OGR_F_SetFieldString(feature, 0, row.location.c_str());
    if (!row.crs.empty()) OGR_F_SetFieldString(feature, 1, row.crs.c_str());
    if (how.with_outlines) {
        const auto [west, south, east, north] = row.extent;
        OGRGeometryH ring = OGR_G_CreateGeometry(wkbLinearRing);
        for (const auto& [x, y] :
             {std::pair(west, south), std::pair(east, south), std::pair(east, north),
              std::pair(west, north), std::pair(west, south)})
            OGR_G_AddPoint_2D(ring, x, y);
        OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
        OGR_G_AddGeometryDirectly(polygon, ring);
        OGR_F_SetGeometryDirectly(feature, polygon);
    }
    must_index(OGR_L_CreateFeature(layer, feature) == OGRERR_NONE, "a row");
    OGR_F_Destroy(feature);
}

}  // namespace

std::string write_index(const std::filesystem::path& path, const std::string& driver,
                        const std::vector<IndexRow>& rows, const IndexLayer& how) {
    GDALAllRegister();
    const GDALDatasetH dataset = GDALCreate(GDALGetDriverByName(driver.c_str()), path.c_str(), 0, 0,
                                            0, GDT_Unknown, nullptr);
    must_index(dataset, "cannot be created");
    OGRSpatialReferenceH srs = nullptr;
    if (!how.crs.empty()) {
        srs = OSRNewSpatialReference(nullptr);
        OSRSetAxisMappingStrategy(srs, OAMS_TRADITIONAL_GIS_ORDER);
        must_index(OSRSetFromUserInput(srs, how.crs.c_str()) == OGRERR_NONE, "crs");
    }
    const OGRLayerH layer = GDALDatasetCreateLayer(dataset, "index", srs, wkbPolygon, nullptr);
    must_index(layer, "layer");
    bool any_crs = false;
    for (const IndexRow& row : rows)
        any_crs = any_crs || !row.crs.empty();
    for (const char* name : {how.field.c_str(), any_crs ? "src_srs" : ""}) {
        if (*name == '\0') continue;
        const OGRFieldDefnH field = OGR_Fld_Create(name, OFTString);
        OGR_Fld_SetWidth(field, 200);
        must_index(OGR_L_CreateField(layer, field, TRUE) == OGRERR_NONE, "field");
        OGR_Fld_Destroy(field);
    }
    must_index(OGR_L_StartTransaction(layer) == OGRERR_NONE, "transaction");
    for (const IndexRow& row : rows)
        add_row(layer, row, how);
    must_index(OGR_L_CommitTransaction(layer) == OGRERR_NONE, "transaction");
    GDALClose(dataset);
    if (srs) OSRDestroySpatialReference(srs);
    return path.string();
}

IndexRow row_of(const std::string& raster) {
    GDALAllRegister();
    const GDALDatasetH dataset = GDALOpen(raster.c_str(), GA_ReadOnly);
    must_index(dataset, "no raster");
    std::array<double, 6> g{};
    GDALGetGeoTransform(dataset, g.data());
    IndexRow row{raster,
                 {g[0], g[3] + g[5] * GDALGetRasterYSize(dataset),
                  g[0] + g[1] * GDALGetRasterXSize(dataset), g[3]}};
    GDALClose(dataset);
    return row;
}

std::string packed(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::string name = path + ".gz";
    VSILFILE* const to = VSIFOpenL(("/vsigzip/" + name).c_str(), "wb");
    must_index(to && VSIFWriteL(bytes.data(), 1, bytes.size(), to) == bytes.size(), "packing");
    VSIFCloseL(to);
    return name;
}

void claim_rows(const std::string& geopackage, long long rows) {
    const GDALDatasetH dataset =
        GDALOpenEx(geopackage.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE, nullptr, nullptr, nullptr);
    must_index(dataset, "no GeoPackage");
    GDALDatasetExecuteSQL(
        dataset, fmt::format("UPDATE gpkg_ogr_contents SET feature_count = {}", rows).c_str(),
        nullptr, nullptr);
    GDALClose(dataset);
}

}  // namespace relevo::test
