// make_dem IN COLUMNS ROWS OUT.tif|OUT.raw [--overviews] [--layout strips1|strips64|tiles256]
//
// A DEM of any size from a small real one: mirrored copies side by side, so that the ground goes on
// without a step and is as rough as the original everywhere. Benches are run on these. A .raw file
// holds the bare heights as 32-bit floats, first row first, for programs that read no GeoTIFF.
// A layout is of LZW: strips of 1 or 64 rows, or tiles of 256 x 256. Without one it is deflated
// tiles.

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
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

struct Arguments {
    bool overviews = false;
    std::string layout;
    bool valid = true;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    arguments.valid = argc >= 5;
    for (int i = 5; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--overviews")
            arguments.overviews = true;
        else if (word == "--layout" && i + 1 < argc)
            arguments.layout = argv[++i];
        else
            arguments.valid = false;
    }
    return arguments;
}

/// Creation options of GDAL's GeoTIFF driver.
std::vector<std::string> creation_options(const std::string& layout) {
    if (layout.empty()) return {"TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=2"};
    std::vector<std::string> options{"COMPRESS=LZW", "BIGTIFF=IF_SAFER"};
    if (layout == "strips1" || layout == "strips64")
        options.push_back("BLOCKYSIZE=" + layout.substr(6));
    else if (layout == "tiles256")
        options.insert(options.end(), {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256"});
    else
        options.clear();
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    const Arguments arguments = parse(argc, argv);
    const std::vector<std::string> words = creation_options(arguments.layout);
    if (!arguments.valid || words.empty()) {
        fmt::print(stderr,
                   "usage: make_dem IN COLUMNS ROWS OUT.tif|OUT.raw [--overviews] "
                   "[--layout strips1|strips64|tiles256]\n");
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
    std::vector<const char*> options;
    for (const std::string& word : words)
        options.push_back(word.c_str());
    options.push_back(nullptr);
    GDALDatasetH out = GDALCreate(GDALGetDriverByName("GTiff"), argv[4], columns, rows, 1,
                                  GDT_Int16, const_cast<char**>(options.data()));
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
    if (arguments.overviews &&
        GDALBuildOverviews(out, "AVERAGE", static_cast<int>(factors.size()), factors.data(), 0,
                           nullptr, nullptr, nullptr) != CE_None)
        return 1;
    GDALClose(out);
    return 0;
}
