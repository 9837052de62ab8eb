#include "dem/piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/nodata.h"
#include "dem/remote.h"

namespace relevo::dem {
namespace {

/// @param height_m  may be where the stored numbers are
template <typename T>
void to_metres(const BandScale& band_scale, const T* stored, std::size_t n, float* height_m) {
    constexpr T kInfinity = std::numeric_limits<T>::infinity();
    // The largest finite float is written to many lengths ("-3.4e38", "3.40282e+38"), so a nodata
    // value near it is seldom equal, to the last bit, to the cells that it means.
    constexpr double kHuge = 3.39e38;
    const bool huge = band_scale.nodata && std::abs(*band_scale.nodata) > kHuge;
    const double beyond = huge ? std::min(kHuge, band_scale.beyond) : band_scale.beyond;
    const T limit = static_cast<T>(std::min(beyond, double(std::numeric_limits<T>::max())));
    const bool all = beyond == std::numeric_limits<double>::infinity();
    const T hole = band_scale.nodata && !huge ? static_cast<T>(*band_scale.nodata) : kInfinity;
    const bool plain = band_scale.scale == 1 && band_scale.offset_m == 0;
    for (std::size_t i = 0; i < n; ++i) {
        const T value = stored[i];
        const bool is_height = all ? std::abs(value) < kInfinity : std::abs(value) < limit;
        const float height =
            plain ? static_cast<float>(value)
                  : static_cast<float>(value * band_scale.scale + band_scale.offset_m);
        height_m[i] = !is_height || value == hole ? kHole : height;
    }
}

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

std::optional<double> declared_nodata(GDALRasterBandH band) {
    int found = 0;
    const GDALDataType type = GDALGetRasterDataType(band);
    const double value =
        type == GDT_Int64    ? static_cast<double>(GDALGetRasterNoDataValueAsInt64(band, &found))
        : type == GDT_UInt64 ? static_cast<double>(GDALGetRasterNoDataValueAsUInt64(band, &found))
                             : GDALGetRasterNoDataValue(band, &found);
    return found ? std::optional(value) : std::nullopt;
}

/// Stored numbers of `pieces` squared pieces from all over a band, corners included, or of all of
/// it where it is small. Overviews would mix heights with what marks holes.
std::vector<double> sample_of(GDALRasterBandH band, int pieces) {
    constexpr int kSmall = 1024;
    constexpr int kSide = 128;
    const int columns = GDALGetRasterBandXSize(band), rows = GDALGetRasterBandYSize(band);
    if (columns <= kSmall && rows <= kSmall) pieces = 1;
    int block_columns = 1, block_rows = 1;
    GDALGetBlockSize(band, &block_columns, &block_rows);
    const int width = pieces == 1 ? columns : std::min(kSide, columns);
    const int height = pieces == 1 ? rows : std::min(kSide, rows);
    // From the beginning of a block, so that few have to be decoded.
    const auto first = [&](int posts, int side, int block, int index) {
        if (pieces == 1) return 0;
        const int at = static_cast<int>(std::int64_t{posts - side} * index / (pieces - 1));
        return index == pieces - 1 ? at : at / block * block;
    };
    const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<double> stored(n * static_cast<std::size_t>(pieces * pieces));
    double* to = stored.data();
    for (int j = 0; j < pieces; ++j)
        for (int i = 0; i < pieces; ++i, to += n)
            // A damaged file is told of when its heights are read.
            if (GDALRasterIO(band, GF_Read, first(columns, width, block_columns, i),
                             first(rows, height, block_rows, j), width, height, to, width, height,
                             GDT_Float64, 0, 0) != CE_None)
                return {};
    return stored;
}

/// Reports numbers that are no heights where others are declared to be voids. Not of files on the
/// net, where a sample takes requests, or of marks that programs make of the largest floats.
void report_impossible(GDALRasterBandH band, int sampled_pieces, Piece& piece) {
    constexpr double kMarks = 1e38;
    const GDALDataType type = GDALGetRasterDataType(band);
    if (is_remote(piece.path.text()) || (fits_float(type) && type != GDT_Float32)) return;
    Description& about = piece.about;
    for (const double stored : sample_of(band, sampled_pieces))
        if (std::abs(stored) > piece.band_scale.beyond && std::abs(stored) < kMarks &&
            stored != about.nodata) {
            guess(about, fmt::format("{:g} is taken as a void, as the declared {} is: no height is "
                                     "beyond 10 000 km; --nodata none keeps both",
                                     stored, about.nodata_text()));
            return;
        }
}

/// Which stored numbers are holes: given, else declared, else found out.
void settle_nodata(GDALRasterBandH band, const LoadOptions& options, int sampled_pieces,
                   Piece& piece) {
    Description& about = piece.about;
    BandScale& band_scale = piece.band_scale;
    band_scale.beyond = no_height_beyond(band_scale.scale);
    if (piece.encoding != Encoding::None) {
        about.nodata = black_m(piece.encoding);
        piece.knows_holes = false;  // means of colours are no heights
    } else {
        about.nodata = declared_nodata(band);
    }
    const bool declared = about.nodata.has_value();
    const auto holes_by = [&about](const char* what) { about.holes_by.emplace_back(what); };
    about.alpha_band = piece.alpha_band;
    if (piece.has_mask) holes_by("mask");
    if (piece.alpha_band > 0) holes_by("alpha");
    if (options.no_nodata) {
        if (declared)
            about.assumptions.push_back(
                fmt::format("{} marks no void, as given", about.nodata_text()));
        about.nodata.reset();
        band_scale.beyond = std::numeric_limits<double>::infinity();
    } else if (options.nodata) {
        if (declared && about.nodata != options.nodata)
            about.warnings.push_back(
                fmt::format("--nodata {} replaces the declared {}: posts of {} are heights now",
                            *options.nodata, about.nodata_text(), about.nodata_text()));
        about.nodata = options.nodata;
        about.assumptions.push_back(fmt::format("{} marks voids, as given", *options.nodata));
        piece.knows_holes = piece.knows_holes && declared;
        holes_by("option");
    } else if (declared) {
        holes_by(piece.encoding != Encoding::None ? "encoding" : "nodata");
        if (piece.encoding == Encoding::None) report_impossible(band, sampled_pieces, piece);
    } else if (!piece.has_mask && piece.alpha_band == 0) {
        const Undeclared found = find_undeclared(sample_of(band, sampled_pieces), band_scale.scale);
        if (found.beyond)
            guess(about,
                  "numbers too large for heights are taken as voids (not declared); --nodata none "
                  "keeps them");
        about.nodata = found.nodata;
        if (found.nodata)
            guess(about, fmt::format("{:g} is taken as a void (not declared, far from all "
                                     "heights); --nodata none keeps it",
                                     *found.nodata));
        piece.knows_holes = !found.nodata && !found.beyond;
        if (!piece.knows_holes) holes_by("found");
    }
    if (piece.alpha_band > 0) piece.knows_holes = false;
    band_scale.nodata = about.nodata;
}

constexpr double kMiB = 1 << 20;

/// GDAL reads a whole block for any post of it.
/// @param memory  allowed for heights [bytes]
void refuse_huge_blocks(const std::string& path, GDALRasterBandH band, double memory) {
    constexpr double kFine = 64 * kMiB;  // whatever is allowed
    int columns = 1, rows = 1;
    GDALGetBlockSize(band, &columns, &rows);
    const double bytes =
        double(columns) * rows * GDALGetDataTypeSizeBytes(GDALGetRasterDataType(band));
    if (bytes > std::max(kFine, memory))
        refuse(path,
               fmt::format("is stored in blocks of {} x {} posts, {:.0f} MiB each, expected at "
                           "most {:.0f} MiB; pass --memory {}, or make tiles of them with "
                           "gdal_translate -co TILED=YES",
                           columns, rows, bytes / kMiB, std::max(kFine, memory) / kMiB,
                           MemoryBudget::mib_for_posts(static_cast<std::int64_t>(bytes / 4))));
    // Windows lie on two of them or, of tiles, on four.
    hold_blocks(static_cast<std::int64_t>(2 * bytes));
}

/// Bytes of all files that a dataset is made of.
std::uint64_t bytes_behind(const AllowedName& name, GDALDatasetH dataset) {
    std::uint64_t bytes = refuse_unsafe_vrt(name);
    char** const files = GDALGetFileList(dataset);
    for (char** file = files; file && *file; ++file)
        if (name.allows(*file)) bytes += size_by_vsi(name.derived(*file)).value_or(0);
    CSLDestroy(files);
    return bytes;
}

/// Finds out what a huge raster's file does not store, and refuses one whose file cannot store what
/// it promises: to read it would take for ever and give nothing.
void settle_sparse(GDALDatasetH dataset, GDALRasterBandH band, Piece& piece) {
    constexpr double kManyPosts = 1 << 28;   // read in seconds
    constexpr double kBelievable = 1 << 30;  // read in some ten
    constexpr double kMaxInAByte = 1 << 20;  // a thousand times what deflate can do
    const double posts = double(piece.grid.columns()) * piece.grid.rows();
    if (posts < kManyPosts || piece.path.asks_net()) return;
    const std::uint64_t bytes = bytes_behind(piece.path, dataset);
    const GDALRasterBandH mask = piece.has_mask ? GDALGetMaskBand(band) : nullptr;
    const GDALRasterBandH alpha =
        piece.alpha_band > 0 ? GDALGetRasterBand(dataset, piece.alpha_band) : nullptr;
    if (piece.encoding == Encoding::None)
        piece.sparse = SparseMap::of(dataset, band, mask, alpha, bytes);
    if (piece.sparse) {
        const glm::ivec2 at = *piece.sparse->empty_post();
        const SparseMap map = *std::exchange(piece.sparse, std::nullopt);
        piece.read(dataset, piece.levels.front(), {at.x, at.y, 1, 1}, &piece.unstored_m);
        piece.sparse = map;
    }
    const double stored = posts * (piece.sparse ? piece.sparse->stored_share() : 1);
    if (posts > kBelievable && stored > kMaxInAByte * static_cast<double>(bytes))
        refuse(piece.about.path, fmt::format("claims {} x {} posts, too many for {} bytes of files",
                                             piece.grid.columns(), piece.grid.rows(), bytes));
}

std::vector<Resolution> levels_of(GDALRasterBandH band) {
    std::vector<Resolution> levels{
        {-1, GDALGetRasterBandXSize(band), GDALGetRasterBandYSize(band)}};
    const int count = GDALGetOverviewCount(band);
    for (int i = 0; i < count; ++i)
        if (const GDALRasterBandH overview = GDALGetOverview(band, i))
            levels.push_back(
                {i, GDALGetRasterBandXSize(overview), GDALGetRasterBandYSize(overview)});
    return levels;
}

/// Notes what the file calls itself, and the band that is read.
void describe_file(const std::string& given, GDALDatasetH dataset, const LoadOptions& options,
                   Description& about) {
    about.path = given;
    about.files = {given};
    about.driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset));
    about.band = chosen_band(given, dataset, options, about);
    const GDALDataType type = GDALGetRasterDataType(GDALGetRasterBand(dataset, about.band));
    about.data_type = GDALGetDataTypeName(type);
    if (GDALDataTypeIsComplex(type))
        refuse(given, fmt::format("complex numbers ({}), expected heights", about.data_type));
}

/// Says how the middle gets to WGS 84. @throws Error (BadInput) where it is nowhere
void settle_place(const std::string& given, const glm::dvec2& middle, const geo::Crs& crs,
                  Description& about) {
    if (!std::isfinite(crs.to_geodetic(middle.x, middle.y).lat_rad))
        refuse(given, fmt::format("its middle is at {:.10g}, {:.10g}, which is not on the Earth in "
                                  "{}; pass the right one with --crs EPSG:n",
                                  middle.x, middle.y, crs.name()));
    if (const std::optional<geo::DatumShift> shift = crs.datum_shift(middle.x, middle.y))
        about.assumptions.push_back(
            fmt::format("converted to WGS 84 by {}, {}", shift->name,
                        shift->accuracy_m ? fmt::format("good to {:g} m", *shift->accuracy_m)
                                          : std::string("whose accuracy is not known")));
}

/// @returns metres of a unit of the band, downwards where heights are depths
double settle_scale(const std::string& given, GDALRasterBandH band, const geo::Crs& crs,
                    Description& about) {
    about.scale = GDALGetRasterScale(band, nullptr);
    about.offset = GDALGetRasterOffset(band, nullptr);
    if (!std::isfinite(about.scale) || about.scale == 0 ||
        !(std::abs(about.offset * about.unit.metres) < no_height_beyond(1)))
        refuse(given,
               fmt::format("a scale of {:g} and an offset of {:g}, which make no heights; the "
                           "file is damaged",
                           about.scale, about.offset));
    const bool depths = crs.vertical() && crs.vertical()->down;
    // Bathymetric Attributed Grid standard (OGC 25-018): elevations are positive upwards, always.
    const bool is_bag = about.driver == "BAG";
    if (depths && is_bag)
        about.assumptions.push_back(
            "heights are positive upwards, as in all BAG files, though the vertical CRS has "
            "depths");
    const bool down = depths && !is_bag;
    if (down)
        about.assumptions.push_back("depths, positive downwards, are taken as heights below 0");
    return down ? -about.unit.metres : about.unit.metres;
}

/// Whether a mask, or an alpha band, says which posts are none.
void settle_mask(GDALDatasetH dataset, GDALRasterBandH band, Piece& piece) {
    const int mask = GDALGetMaskFlags(band);
    piece.has_mask = (mask & (GMF_PER_DATASET | GMF_ALPHA)) != 0 && (mask & GMF_NODATA) == 0;
    for (int i = 1; i <= piece.about.bands && !piece.has_mask; ++i)
        if (i != piece.about.band &&
            GDALGetRasterColorInterpretation(GDALGetRasterBand(dataset, i)) == GCI_AlphaBand)
            piece.alpha_band = i;
}

void settle_blocks(GDALDatasetH dataset, GDALRasterBandH band, Piece& piece) {
    GDALGetBlockSize(band, &piece.block_columns, &piece.block_rows);
    // Measured on two processors: a deflated 3600 x 3600 in 0.6 of the time; plain ones and other
    // formats gain nothing or lose, and text must be read from the top by every handle.
    const char* compression = GDALGetMetadataItem(dataset, "COMPRESSION", "IMAGE_STRUCTURE");
    piece.threads_pay = piece.about.driver == "GTiff" && compression != nullptr;
}

}  // namespace

Piece open_piece(const AllowedName& name, const LoadOptions& options, std::size_t files,
                 Dataset& opened) {
    constexpr std::size_t kManyFiles = 16;  // a look at each takes 5 to 30 ms

    const std::string& given = name.text();
    AllowedName path = name;
    const WithoutListing without_listing(files);
    Dataset dataset = open_dataset(path);
    GdalMessages messages;  // what follows asks the file for things that it may not have
    Description about;
    describe_file(given, dataset.get(), options, about);
    const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), about.band);
    const GDALDataType type = GDALGetRasterDataType(band);
    refuse_if_short(path.text(), dataset.get(), about);
    const int columns = GDALGetRasterXSize(dataset.get());
    const int rows = GDALGetRasterYSize(dataset.get());
    if (columns < 2 || rows < 2)
        refuse(given,
               fmt::format("size, expected at least 2 x 2 posts but got {} x {}", columns, rows));
    refuse_huge_blocks(given, band, 4.0 * static_cast<double>(options.memory.posts));
    Georeference where = georeference(given, dataset.get(), options, about);
    settle_unit(given, band, where.crs, options, about);
    settle_vertical_datum(dataset.get(), where.crs, about);
    if (type == GDT_Byte && options.encoding == Encoding::None)
        about.assumptions.push_back("heights are stored in 8 bits: 256 steps at most");
    if (options.encoding != Encoding::None && (about.driver == "JPEG" || about.driver == "WEBP"))
        guess(about,
              "the picture's format may have changed its colours, and with them the heights");
    settle_place(given, where.affine((columns - 1) / 2.0, (rows - 1) / 2.0), where.crs, about);
    const double metres = settle_scale(given, band, where.crs, about);

    Piece piece{.path = path,
                .files = files,
                .grid = Grid(columns, rows, where.affine, std::move(where.crs)),
                .place = {0, 0, columns, rows},
                .encoding = options.encoding,
                .about = std::move(about)};
    piece.band_scale.scale = piece.about.scale * metres;
    piece.band_scale.offset_m = piece.about.offset * metres;
    piece.wide = !fits_float(type);
    settle_mask(dataset.get(), band, piece);
    settle_nodata(band, options, files > kManyFiles ? 3 : 5, piece);
    piece.levels = levels_of(band);
    if (!piece.knows_holes) piece.levels.resize(1);
    settle_sparse(dataset.get(), band, piece);
    settle_blocks(dataset.get(), band, piece);
    opened = std::move(dataset);
    return piece;
}

Dataset Piece::open() const {
    const std::array<const char*, 2> driver = {about.driver.c_str(), nullptr};
    GdalMessages messages;
    const WithoutListing without_listing(files);
    const RemoteSiblings siblings(path);
    Dataset dataset = open_by_gdal(path, GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                   driver.data(), siblings.list());
    if (!dataset) {
        refuse_unreadable(path.text());
        messages.refuse(path.text(), "cannot be opened again");
    }
    return dataset;
}

double Piece::stored(void* dataset, int column, int row, float height_m) const {
    if (encoding != Encoding::None || resampling)
        return (static_cast<double>(height_m) - band_scale.offset_m) / band_scale.scale;
    const GdalMessages messages;
    double number = 0;
    if (GDALRasterIO(GDALGetRasterBand(dataset, about.band), GF_Read, column, row, 1, 1, &number, 1,
                     1, GDT_Float64, 0, 0) != CE_None)
        refuse(path.text(),
               fmt::format("its heights cannot be read, {}", messages.failure(path.text())));
    return number;
}

void Piece::read(void* dataset, const Resolution& level, const Window& w, float* height_m) const {
    const std::size_t n = static_cast<std::size_t>(w.columns) * static_cast<std::size_t>(w.rows);
    const auto band_of = [&](int number) {
        const GDALRasterBandH band = GDALGetRasterBand(dataset, number);
        return level.overview < 0 ? band : GDALGetOverview(band, level.overview);
    };
    const auto fetch = [&](GDALRasterBandH from, void* to, GDALDataType type) {
        GdalMessages messages;
        const CPLErr result = GDALRasterIO(from, GF_Read, w.column, w.row, w.columns, w.rows, to,
                                           w.columns, w.rows, type, 0, 0);
        // Some drivers say that a block is broken, fill it and carry on.
        if (result != CE_None || messages.any_failure())
            messages.refuse(path.text(), "its heights cannot be read");
    };
    const GDALRasterBandH band = band_of(about.band);
    if (encoding != Encoding::None) {
        std::array<std::vector<std::uint8_t>, 3> colours;
        for (int i = 0; i < 3; ++i) {
            colours[static_cast<std::size_t>(i)].resize(n);
            fetch(band_of(i + 1), colours[static_cast<std::size_t>(i)].data(), GDT_Byte);
        }
        for (std::size_t i = 0; i < n; ++i)
            height_m[i] = decoded_m(encoding, colours[0][i], colours[1][i], colours[2][i]);
        to_metres(band_scale, height_m, n, height_m);
    } else if (wide) {
        std::vector<double> stored(n);
        fetch(band, stored.data(), GDT_Float64);
        to_metres(band_scale, stored.data(), n, height_m);
    } else {
        fetch(band, height_m, GDT_Float32);
        to_metres(band_scale, height_m, n, height_m);
    }
    if (alpha_band > 0) {
        std::vector<float> alpha(n);
        fetch(band_of(alpha_band), alpha.data(), GDT_Float32);
        for (std::size_t i = 0; i < n; ++i)
            if (alpha[i] == 0) height_m[i] = kHole;
    }
    if (has_mask) {
        std::vector<unsigned char> mask(n);
        fetch(GDALGetMaskBand(band), mask.data(), GDT_Byte);
        for (std::size_t i = 0; i < n; ++i)
            if (mask[i] == 0) height_m[i] = kHole;
    }
}

}  // namespace relevo::dem
