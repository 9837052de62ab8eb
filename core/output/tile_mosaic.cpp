#include "output/tile_mosaic.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/object_store.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"

namespace relevo::output {
namespace {

namespace fs = std::filesystem;

using dem::Dataset;

std::string escaped_xml(const std::string& text) {
    char* const made = CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML);
    std::string result = made;
    VSIFree(made);
    return result;
}

/// GDAL's documentation of the VRT driver: SimpleSource. With its properties a source is opened
/// only where it is read.
std::string source_text(const std::string& name, const dem::Window& tile, const dem::Window& all,
                        int band, const std::string& type) {
    const std::string size = fmt::format("xSize=\"{}\" ySize=\"{}\"", tile.columns, tile.rows);
    return fmt::format(
        "<SimpleSource><SourceFilename relativeToVRT=\"{}\">{}</SourceFilename>"
        "<SourceBand>{}</SourceBand><SourceProperties RasterXSize=\"{}\" RasterYSize=\"{}\" "
        "DataType=\"{}\" BlockXSize=\"512\" BlockYSize=\"512\"/>"
        "<SrcRect xOff=\"0\" yOff=\"0\" {}/><DstRect xOff=\"{}\" yOff=\"{}\" {}/></SimpleSource>",
        name.starts_with('/') ? 0 : 1, escaped_xml(name), band, tile.columns, tile.rows, type, size,
        tile.column - all.column, tile.row - all.row, size);
}

/// Within which names can be relative: "vsis3" for objects of such stores; empty for files.
fs::path root_of(const fs::path& path) {
    return object_store_of(path.native()) ? *std::next(path.begin()) : fs::path();
}

void copy_metadata(GDALMajorObjectH from, GDALMajorObjectH to) {
    // What is of one tile alone is not of all.
    constexpr std::array kOfOne{"CLIP", "HOLES", "BEYOND_DEM", "AREA_OR_POINT"};
    for (char** item = GDALGetMetadata(from, nullptr); item && *item; ++item) {
        const std::string text = *item;
        const std::string key = text.substr(0, text.find('='));
        if (std::ranges::find(kOfOne, key) == kOfOne.end() && key.size() < text.size())
            GDALSetMetadataItem(to, key.c_str(), text.c_str() + key.size() + 1, nullptr);
    }
}

/// What a band says of itself.
void describe_band(GDALRasterBandH from, GDALRasterBandH to) {
    GDALSetDescription(to, GDALGetDescription(from));
    GDALSetRasterUnitType(to, GDALGetRasterUnitType(from));
    int has_nodata = 0;
    const double nodata = GDALGetRasterNoDataValue(from, &has_nodata);
    if (has_nodata != 0) GDALSetRasterNoDataValue(to, nodata);
    copy_metadata(from, to);
}

}  // namespace

dem::Window window_of(const TilePlan& plan) {
    dem::Window all = plan.tiles.front().window;
    for (const PlannedTile& tile : plan.tiles) {
        const int column = std::min(all.column, tile.window.column),
                  row = std::min(all.row, tile.window.row);
        all = {column, row, std::max(all.end_column(), tile.window.end_column()) - column,
               std::max(all.end_row(), tile.window.end_row()) - row};
    }
    return all;
}

std::string name_from(const fs::path& file, const fs::path& tile) {
    if (root_of(file) != root_of(tile)) return fs::absolute(tile).generic_string();
    std::error_code error;
    const fs::path base = fs::weakly_canonical(fs::absolute(file).parent_path(), error);
    const fs::path full =
        fs::weakly_canonical(fs::absolute(tile).parent_path(), error) / tile.filename();
    return full.lexically_relative(base).generic_string();
}

std::string mosaic_text(const fs::path& path, const fs::path& folder, const TilePlan& plan,
                        const std::vector<PlannedTile>& tiles) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    const auto refuse = [&] {
        failed(fmt::format("merge: {}: cannot be made, {}", printable(path.string()),
                           messages.failure(path.string())));
    };
    const Dataset first =
        dem::open_by_gdal(AllowedName((folder / tiles.front().name).string()), GDAL_OF_RASTER);
    GDALDriverH const driver = GDALGetDriverByName("VRT");
    if (!first || !driver) refuse();
    const dem::Window all = window_of(plan);
    const Dataset mosaic(GDALCreate(driver, "", all.columns, all.rows, 0, GDT_Float32, nullptr));
    if (!mosaic) refuse();
    std::array<double, 6> transform =
        plan.grid.part(all, all.columns, all.rows).affine().geotransform();
    GDALSetGeoTransform(mosaic.get(), transform.data());
    const dem::GdalCrs crs(plan.grid.crs().text());
    if (crs.known()) GDALSetSpatialRef(mosaic.get(), crs.handle());
    copy_metadata(first.get(), mosaic.get());
    // A dataset with a name would write itself.
    const auto name_it = [&](const std::string& name) {
        GDALSetDescription(mosaic.get(), name.c_str());
    };
    const auto is_unnamed = [&](const auto&) { name_it(""); };
    const std::unique_ptr<const fs::path, decltype(is_unnamed)> unname(&path, is_unnamed);
    name_it(fs::absolute(path).string());
    for (int band = 1; band <= GDALGetRasterCount(first.get()); ++band) {
        GDALRasterBandH const from = GDALGetRasterBand(first.get(), band);
        const GDALDataType type = GDALGetRasterDataType(from);
        if (GDALAddBand(mosaic.get(), type, nullptr) != CE_None) refuse();
        GDALRasterBandH const to = GDALGetRasterBand(mosaic.get(), band);
        describe_band(from, to);
        for (const PlannedTile& tile : tiles)
            if (GDALSetMetadataItem(to, "source_0",
                                    source_text(name_from(path, folder / tile.name), tile.window,
                                                all, band, GDALGetDataTypeName(type))
                                        .c_str(),
                                    "new_vrt_sources") != CE_None)
                refuse();
    }
    char** const text = GDALGetMetadata(mosaic.get(), "xml:VRT");
    const std::string xml = text && *text ? *text : "";
    if (xml.empty()) refuse();
    return xml;
}

}  // namespace relevo::output
