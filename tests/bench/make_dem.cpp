// make_dem IN COLUMNS ROWS OUT.tif|OUT.raw [--overviews]
//
// A DEM of any size from a small real one: mirrored copies side by side, so that the ground goes on
// without a step and is as rough as the original everywhere. Benches are run on these. A .raw file
// holds the bare heights as 32-bit floats, first row first, for programs that read no GeoTIFF.

#include <array>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gdal.h>

#include "dem/load.h"

namespace {

/// Index into a row of `count` posts that is walked to and fro.
int mirrored(int index, int count) {
    const int period = 2 * (count - 1);
    const int at = index % period;
    return at < count ? at : period - at;
}

}  // namespace

int main(int argc, char** argv) {
    const bool has_overviews = argc == 6 && std::string_view(argv[5]) == "--overviews";
    if (argc != 5 && !has_overviews) {
        fmt::print(stderr, "usage: make_dem IN COLUMNS ROWS OUT.tif|OUT.raw [--overviews]\n");
        return 2;
    }
    const relevo::dem::Heightfield source = relevo::dem::load(std::string(argv[1]));
    const int columns = std::atoi(argv[2]), rows = std::atoi(argv[3]);
    if (std::string_view(argv[4]).ends_with(".raw")) {
        std::ofstream raw(argv[4], std::ios::binary);
        std::vector<float> line(static_cast<std::size_t>(columns));
        for (int row = 0; row < rows; ++row) {
            const int from = mirrored(row, source.height_m.height());
            for (int column = 0; column < columns; ++column)
                line[static_cast<std::size_t>(column)] =
                    source.height_m.at(mirrored(column, source.height_m.width()), from);
            raw.write(reinterpret_cast<const char*>(line.data()),
                      static_cast<std::streamsize>(line.size() * sizeof(float)));
        }
        return raw.flush() ? 0 : 1;
    }
    const relevo::dem::Affine& post = source.grid.affine();
    double geotransform[6] = {
        post.x0 - 0.5 * post.x_column, post.x_column, 0, post.y0 - 0.5 * post.y_row, 0, post.y_row};
    GDALAllRegister();
    const char* options[] = {"TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=2", nullptr};
    GDALDatasetH out = GDALCreate(GDALGetDriverByName("GTiff"), argv[4], columns, rows, 1,
                                  GDT_Int16, const_cast<char**>(options));
    if (!out) return 1;
    GDALSetGeoTransform(out, geotransform);
    GDALSetProjection(out, source.grid.crs().wkt().c_str());
    std::vector<short> line(static_cast<std::size_t>(columns));
    for (int row = 0; row < rows; ++row) {
        const int from = mirrored(row, source.height_m.height());
        for (int column = 0; column < columns; ++column)
            line[static_cast<std::size_t>(column)] = static_cast<short>(
                source.height_m.at(mirrored(column, source.height_m.width()), from));
        if (GDALRasterIO(GDALGetRasterBand(out, 1), GF_Write, 0, row, columns, 1, line.data(),
                         columns, 1, GDT_Int16, 0, 0) != CE_None)
            return 1;
    }
    const std::array<int, 5> factors{2, 4, 8, 16, 32};
    if (has_overviews &&
        GDALBuildOverviews(out, "AVERAGE", static_cast<int>(factors.size()), factors.data(), 0,
                           nullptr, nullptr, nullptr) != CE_None)
        return 1;
    GDALClose(out);
    return 0;
}
