// make_dem IN COLUMNS ROWS OUT.tif|OUT.raw [--overviews] [--layout strips1|strips64|tiles256]
// make_dem IN COLUMNS ROWS FOLDER --files SIDE [--layout ...]
//
// A DEM of any size from a small real one: mirrored copies side by side, so that the ground goes on
// without a step and is as rough as the original everywhere. Benches are run on these. A .raw file
// holds the bare heights as 32-bit floats, first row first, for programs that read no GeoTIFF.
// A layout is of LZW: strips of 1 or 64 rows, or tiles of 256 x 256. Without one it is deflated
// tiles. With --files the DEM is cut into files of SIDE x SIDE posts, FOLDER/ROW_COLUMN.tif.

#include <algorithm>
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
    int file_side = 0;  ///< posts; 0: one file
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
        else if (word == "--files" && i + 1 < argc)
            arguments.file_side = std::atoi(argv[++i]);
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

/// Mirrored copies of a DEM.
class Copies {
  public:
    explicit Copies(const std::string& path) : source_(relevo::dem::load(path)) {}

    template <typename T>
    void read(int row, int column, std::vector<T>& line) const {
        const int from = mirrored(row, source_.height_m.height());
        for (T& height : line)
            height = static_cast<T>(
                source_.height_m.at(mirrored(column++, source_.height_m.width()), from));
    }

    bool write_raw(const char* path, int columns, int rows) const {
        std::ofstream raw(path, std::ios::binary);
        std::vector<float> line(static_cast<std::size_t>(columns));
        for (int row = 0; row < rows; ++row) {
            read(row, 0, line);
            raw.write(reinterpret_cast<const char*>(line.data()),
                      static_cast<std::streamsize>(line.size() * sizeof(float)));
        }
        return static_cast<bool>(raw.flush());
    }

    bool write_tiff(const std::string& path, const relevo::dem::Window& window,
                    const std::vector<std::string>& words, bool overviews) const {
        std::vector<const char*> options;
        for (const std::string& word : words)
            options.push_back(word.c_str());
        options.push_back(nullptr);
        GDALDatasetH out =
            GDALCreate(GDALGetDriverByName("GTiff"), path.c_str(), window.columns, window.rows, 1,
                       GDT_Int16, const_cast<char**>(options.data()));
        if (!out) return false;
        const relevo::dem::Affine& post = source_.grid.affine();
        double geotransform[6] = {post.x0 + (window.column - 0.5) * post.x_column,
                                  post.x_column,
                                  0,
                                  post.y0 + (window.row - 0.5) * post.y_row,
                                  0,
                                  post.y_row};
        GDALSetGeoTransform(out, geotransform);
        GDALSetProjection(out, source_.grid.crs().wkt().c_str());
        std::vector<short> line(static_cast<std::size_t>(window.columns));
        bool fine = true;
        for (int row = 0; row < window.rows && fine; ++row) {
            read(window.row + row, window.column, line);
            fine = GDALRasterIO(GDALGetRasterBand(out, 1), GF_Write, 0, row, window.columns, 1,
                                line.data(), window.columns, 1, GDT_Int16, 0, 0) == CE_None;
        }
        const std::array<int, 5> factors{2, 4, 8, 16, 32};
        fine = fine && (!overviews || GDALBuildOverviews(
                                          out, "AVERAGE", static_cast<int>(factors.size()),
                                          factors.data(), 0, nullptr, nullptr, nullptr) == CE_None);
        GDALClose(out);
        return fine;
    }

  private:
    relevo::dem::Heightfield source_;
};

}  // namespace

int main(int argc, char** argv) {
    const Arguments arguments = parse(argc, argv);
    const std::vector<std::string> words = creation_options(arguments.layout);
    if (!arguments.valid || words.empty()) {
        fmt::print(stderr,
                   "usage: make_dem IN COLUMNS ROWS OUT.tif|OUT.raw [--overviews] "
                   "[--layout strips1|strips64|tiles256]\n"
                   "       make_dem IN COLUMNS ROWS FOLDER --files SIDE [--layout ...]\n");
        return 2;
    }
    const Copies copies(argv[1]);
    const int columns = std::atoi(argv[2]), rows = std::atoi(argv[3]);
    const std::string out = argv[4];
    if (out.ends_with(".raw")) return copies.write_raw(argv[4], columns, rows) ? 0 : 1;
    GDALAllRegister();
    const int side = arguments.file_side;
    if (side == 0)
        return copies.write_tiff(out, {0, 0, columns, rows}, words, arguments.overviews) ? 0 : 1;
    for (int row = 0; row < rows; row += side)
        for (int column = 0; column < columns; column += side)
            if (!copies.write_tiff(
                    fmt::format("{}/{}_{}.tif", out, row / side, column / side),
                    {column, row, std::min(side, columns - column), std::min(side, rows - row)},
                    words, arguments.overviews))
                return 1;
    return 0;
}
