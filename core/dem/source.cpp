#include "dem/source.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gdal.h>

#include "base/parallel_for.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// How stored numbers become metres.
struct Encoding {
    std::optional<double> nodata;
    double scale = 1;     // metres in one step of the stored number
    double offset_m = 0;  // height of the stored number 0

    template <typename T>
    void to_metres(const T* stored, std::size_t n, float* height_m) const {
        constexpr T kInfinity = std::numeric_limits<T>::infinity();
        // The largest finite float is written to many lengths ("-3.4e38", "3.40282e+38"), so a
        // nodata value near it is seldom equal, to the last bit, to the cells that it means.
        const bool huge = nodata && std::abs(*nodata) > 3.39e38;
        const T limit = huge ? static_cast<T>(3.39e38) : kInfinity;
        const T hole = nodata && !huge ? static_cast<T>(*nodata) : kInfinity;
        const bool plain = scale == 1 && offset_m == 0;
        for (std::size_t i = 0; i < n; ++i) {
            const T value = stored[i];
            const bool is_hole = !(std::abs(value) < limit) || value == hole;
            const float height =
                plain ? static_cast<float>(value) : static_cast<float>(value * scale + offset_m);
            height_m[i] = is_hole ? kHole : height;
        }
    }
};

/// Whether a float holds every value of the type to its last unit.
bool fits_float(GDALDataType type) {
    switch (type) {
        case GDT_Byte:
        case GDT_UInt16:
        case GDT_Int16:
        case GDT_Float32:
            return true;
        default:
            return false;
    }
}

}  // namespace

struct Source::Impl {
    std::string path;
    std::optional<Grid> grid;
    Description about;
    Encoding encoding;
    bool has_mask = false;     // a mask or an alpha band says where the holes are
    bool wide = false;         // stored numbers need doubles
    bool threads_pay = false;  // the driver decodes blocks one by one, whichever handle asks
    int block_rows = 1;

    // Open handles that no call is using; a GDAL dataset serves one thread at a time.
    mutable std::mutex mutex;
    mutable std::vector<Dataset> idle;

    Dataset reopen() const;
    template <typename Body>
    void borrow(const Body& body) const;
    GDALRasterBandH band_of(const Dataset& dataset, int overview) const;
    void read_rows(GDALRasterBandH band, const Window& window, float* height_m) const;
    Array2d<float> read_stored(const Window& window) const;
    /// One of the file's resolutions.
    struct Level {
        int overview = -1;  // -1: the raster itself
        int columns = 0;
        int rows = 0;
    };
    /// The coarsest level that still has a cell for every post asked for.
    Level coarsest_level(const Window& window, int columns, int rows) const;
    Array2d<float> read_means(const Window& window, int columns, int rows) const;
};

Dataset Source::Impl::reopen() const {
    const std::array<const char*, 2> driver = {about.driver.c_str(), nullptr};
    GdalMessages messages;
    Dataset dataset(GDALOpenEx(path.c_str(),
                               GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                               driver.data(), nullptr, nullptr));
    if (!dataset) refuse(path, fmt::format("cannot be opened again, {}", messages.failure(path)));
    return dataset;
}

template <typename Body>
void Source::Impl::borrow(const Body& body) const {
    Dataset mine;
    {
        const std::lock_guard lock(mutex);
        if (!idle.empty()) {
            mine = std::move(idle.back());
            idle.pop_back();
        }
    }
    if (!mine) mine = reopen();
    body(mine);
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(mine));
}

/// @param overview  -1: the band itself
GDALRasterBandH Source::Impl::band_of(const Dataset& dataset, int overview) const {
    GDALRasterBandH band = GDALGetRasterBand(dataset.get(), about.band);
    return overview < 0 ? band : GDALGetOverview(band, overview);
}

/// Heights of a window of a band or of one of its overviews.
void Source::Impl::read_rows(GDALRasterBandH band, const Window& w, float* height_m) const {
    const std::size_t n = static_cast<std::size_t>(w.columns) * static_cast<std::size_t>(w.rows);
    const auto fetch = [&](GDALRasterBandH from, void* to, GDALDataType type) {
        GdalMessages messages;
        const CPLErr result = GDALRasterIO(from, GF_Read, w.column, w.row, w.columns, w.rows, to,
                                           w.columns, w.rows, type, 0, 0);
        // Some drivers say that a block is broken, fill it and carry on.
        if (result != CE_None || messages.any_failure())
            refuse(path, fmt::format("its heights cannot be read, {}; the file is damaged or "
                                     "incomplete",
                                     messages.failure(path)));
    };
    if (wide) {
        std::vector<double> stored(n);
        fetch(band, stored.data(), GDT_Float64);
        encoding.to_metres(stored.data(), n, height_m);
    } else {
        fetch(band, height_m, GDT_Float32);
        encoding.to_metres(height_m, n, height_m);
    }
    if (has_mask) {
        std::vector<unsigned char> mask(n);
        fetch(GDALGetMaskBand(band), mask.data(), GDT_Byte);
        for (std::size_t i = 0; i < n; ++i)
            if (mask[i] == 0) height_m[i] = kHole;
    }
}

Array2d<float> Source::Impl::read_stored(const Window& window) const {
    Array2d<float> height_m(window.columns, window.rows);
    // Pieces of whole rows of blocks, large enough to be worth a thread.
    constexpr int kPosts = 1 << 17;
    const int wanted_rows = std::max(1, kPosts / window.columns);
    const int piece_rows = (wanted_rows + block_rows - 1) / block_rows * block_rows;
    const int first_piece = window.row / piece_rows;
    const int last_piece = (window.row + window.rows + piece_rows - 1) / piece_rows;
    const auto read_pieces = [&](int first, int last) {
        borrow([&](const Dataset& dataset) {
            for (int piece = first; piece < last; ++piece) {
                const int from = std::max(piece * piece_rows, window.row);
                const int to = std::min((piece + 1) * piece_rows, window.row + window.rows);
                read_rows(band_of(dataset, -1), {window.column, from, window.columns, to - from},
                          &height_m.at(0, from - window.row));
            }
        });
    };
    if (threads_pay)
        parallel_for(first_piece, last_piece, 1, read_pieces);
    else
        read_pieces(first_piece, last_piece);
    return height_m;
}

namespace {

/// One part of a line of cells and how much of each cell lies in it.
struct Part {
    std::size_t first = 0;
    std::vector<double> weights;  // of cells first, first + 1, ...

    std::size_t end() const { return first + weights.size(); }
    double size() const { return std::accumulate(weights.begin(), weights.end(), 0.0); }
};

/// Cuts [begin, end), in cells, into equal parts.
std::vector<Part> parts_of(double begin, double end, int count, int cells) {
    std::vector<Part> parts(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const double from = begin + (end - begin) * i / count;
        const double to = begin + (end - begin) * (i + 1) / count;
        // What is below a millionth of a cell is rounding.
        const int first = std::clamp(static_cast<int>(std::floor(from + 1e-6)), 0, cells - 1);
        const int last = std::clamp(static_cast<int>(std::ceil(to - 1e-6)), first + 1, cells);
        Part& part = parts[static_cast<std::size_t>(i)];
        part.first = static_cast<std::size_t>(first);
        for (int cell = first; cell < last; ++cell)
            part.weights.push_back(std::min(to, cell + 1.0) - std::max(from, double(cell)));
    }
    return parts;
}

}  // namespace

Source::Impl::Level Source::Impl::coarsest_level(const Window& window, int columns,
                                                 int rows) const {
    Level best{-1, grid->columns(), grid->rows()};
    borrow([&](const Dataset& dataset) {
        const int count = GDALGetOverviewCount(band_of(dataset, -1));
        for (int i = 0; i < count; ++i) {
            const GDALRasterBandH band = band_of(dataset, i);
            const Level level{i, GDALGetRasterBandXSize(band), GDALGetRasterBandYSize(band)};
            const double fit_columns = double(window.columns) * level.columns / grid->columns();
            const double fit_rows = double(window.rows) * level.rows / grid->rows();
            if (level.columns < best.columns && fit_columns >= columns && fit_rows >= rows)
                best = level;
        }
    });
    return best;
}

Array2d<float> Source::Impl::read_means(const Window& window, int columns, int rows) const {
    const Level level = coarsest_level(window, columns, rows);
    const double per_column = level.columns / double(grid->columns());
    const double per_row = level.rows / double(grid->rows());
    const std::vector<Part> across =
        parts_of(window.column * per_column, (window.column + window.columns) * per_column, columns,
                 level.columns);
    const std::vector<Part> down =
        parts_of(window.row * per_row, (window.row + window.rows) * per_row, rows, level.rows);
    const std::size_t first_column = across.front().first;
    const std::size_t width = across.back().end() - first_column;

    // A part of a huge raster without overviews does not fit into memory at once.
    const std::size_t slice_lines = std::max<std::size_t>(1, (std::size_t{1} << 18) / width);

    Array2d<float> result(columns, rows, kHole);
    const auto make_rows = [&](int first, int last) {
        std::vector<float> cells;
        std::vector<double> sums(width);     // of valid cells, down a column of the part
        std::vector<double> weights(width);  // their areas
        borrow([&](const Dataset& dataset) {
            const GDALRasterBandH band = band_of(dataset, level.overview);
            for (int row = first; row < last; ++row) {
                const Part& lines = down[static_cast<std::size_t>(row)];
                std::fill(sums.begin(), sums.end(), 0.0);
                std::fill(weights.begin(), weights.end(), 0.0);
                for (std::size_t k = 0; k < lines.weights.size(); ++k) {
                    const std::size_t in_slice = k % slice_lines;
                    if (in_slice == 0) {
                        const std::size_t n = std::min(slice_lines, lines.weights.size() - k);
                        cells.resize(width * n);
                        read_rows(
                            band,
                            {static_cast<int>(first_column), static_cast<int>(lines.first + k),
                             static_cast<int>(width), static_cast<int>(n)},
                            cells.data());
                    }
                    const float* line = &cells[in_slice * width];
                    for (std::size_t c = 0; c < width; ++c) {
                        const double weight = std::isnan(line[c]) ? 0.0 : lines.weights[k];
                        sums[c] += weight == 0 ? 0.0 : weight * double(line[c]);
                        weights[c] += weight;
                    }
                }
                for (int column = 0; column < columns; ++column) {
                    const Part& part = across[static_cast<std::size_t>(column)];
                    double sum = 0;
                    double weight = 0;
                    for (std::size_t k = 0; k < part.weights.size(); ++k) {
                        sum += part.weights[k] * sums[part.first - first_column + k];
                        weight += part.weights[k] * weights[part.first - first_column + k];
                    }
                    if (weight >= 0.5 * part.size() * lines.size())
                        result.at(column, row) = static_cast<float>(sum / weight);
                }
            }
        });
    };
    if (threads_pay)
        parallel_for(0, rows, std::max(1, (1 << 17) / static_cast<int>(width)), make_rows);
    else
        make_rows(0, rows);
    return result;
}

Source::Source(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Source::Source(Source&&) noexcept = default;
Source& Source::operator=(Source&&) noexcept = default;
Source::~Source() = default;

Source Source::open(const std::string& path, const LoadOptions& options) {
    auto impl = std::make_unique<Impl>();
    impl->path = path;
    Dataset dataset = open_dataset(path);
    GdalMessages messages;  // what follows asks the file for things that it may not have
    Description& about = impl->about;
    about.path = path;
    about.driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get()));
    about.band = chosen_band(path, dataset.get(), options.band, about);
    const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), about.band);
    const GDALDataType type = GDALGetRasterDataType(band);
    about.data_type = GDALGetDataTypeName(type);
    if (GDALDataTypeIsComplex(type))
        refuse(path, fmt::format("complex numbers ({}), expected heights", about.data_type));

    refuse_if_short(path, dataset.get(), about);

    const int columns = GDALGetRasterXSize(dataset.get());
    const int rows = GDALGetRasterYSize(dataset.get());
    if (columns < 2 || rows < 2)
        refuse(path,
               fmt::format("size, expected at least 2 x 2 posts but got {} x {}", columns, rows));
    const Affine affine = georeference(path, dataset.get());
    geo::Crs crs = crs_of(path, dataset.get(), options.crs, about);
    settle_unit(path, band, crs, options.unit, about);
    settle_vertical_datum(dataset.get(), crs, about);
    if (type == GDT_Byte)
        about.assumptions.push_back("heights are stored in 8 bits: 256 steps at most");

    const glm::dvec2 middle = affine((columns - 1) / 2.0, (rows - 1) / 2.0);
    if (!std::isfinite(crs.to_geodetic(middle.x, middle.y).lat_rad))
        refuse(path, fmt::format("its middle is at {:.10g}, {:.10g}, which is not on the Earth in "
                                 "{}; pass the right one with --crs EPSG:n",
                                 middle.x, middle.y, crs.name()));
    if (const std::optional<geo::DatumShift> shift = crs.datum_shift(middle.x, middle.y))
        about.assumptions.push_back(
            fmt::format("taken to WGS 84 by {}, {}", shift->name,
                        shift->accuracy_m ? fmt::format("good to {:g} m", *shift->accuracy_m)
                                          : std::string("whose accuracy is not known")));
    impl->grid.emplace(columns, rows, affine, std::move(crs));

    about.scale = GDALGetRasterScale(band, nullptr);
    about.offset = GDALGetRasterOffset(band, nullptr);
    const bool down = impl->grid->crs().vertical() && impl->grid->crs().vertical()->down;
    if (down)
        about.assumptions.push_back("depths, positive downwards, are taken as heights below 0");
    const double metres = down ? -about.unit.metres : about.unit.metres;
    impl->encoding = {std::nullopt, about.scale * metres, about.offset * metres};
    impl->wide = !fits_float(type);
    int has_nodata = 0;
    const double declared =
        type == GDT_Int64 ? static_cast<double>(GDALGetRasterNoDataValueAsInt64(band, &has_nodata))
        : type == GDT_UInt64
            ? static_cast<double>(GDALGetRasterNoDataValueAsUInt64(band, &has_nodata))
            : GDALGetRasterNoDataValue(band, &has_nodata);
    if (has_nodata) about.nodata = declared;
    if (options.nodata) {
        about.nodata = options.nodata;
        about.assumptions.push_back(fmt::format("{} marks a hole, as given", *options.nodata));
    }
    impl->encoding.nodata = about.nodata;
    const int mask = GDALGetMaskFlags(band);
    impl->has_mask = (mask & (GMF_PER_DATASET | GMF_ALPHA)) != 0 && (mask & GMF_NODATA) == 0;

    int block_columns = 1;
    GDALGetBlockSize(band, &block_columns, &impl->block_rows);
    // Measured on two processors: a deflated 3600 x 3600 in 0.6 of the time; plain ones and other
    // formats gain nothing or lose, and text must be read from the top by every handle.
    const char* compression = GDALGetMetadataItem(dataset.get(), "COMPRESSION", "IMAGE_STRUCTURE");
    impl->threads_pay = about.driver == "GTiff" && compression != nullptr;
    impl->idle.push_back(std::move(dataset));
    return Source(std::move(impl));
}

const Grid& Source::grid() const {
    return *impl_->grid;
}

const Description& Source::description() const {
    return impl_->about;
}

Array2d<float> Source::read(const Window& window, int columns, int rows) const {
    assert(window.column >= 0 && window.row >= 0 &&
           window.column + window.columns <= grid().columns() &&
           window.row + window.rows <= grid().rows());
    assert(columns > 0 && rows > 0 && columns <= window.columns && rows <= window.rows);
    if (columns == window.columns && rows == window.rows) return impl_->read_stored(window);
    return impl_->read_means(window, columns, rows);
}

Array2d<float> Source::read() const {
    return impl_->read_stored({0, 0, grid().columns(), grid().rows()});
}

}  // namespace relevo::dem
