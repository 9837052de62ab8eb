#include "output/raster_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "output/scratch_files.h"

namespace relevo::output {
namespace {

using dem::Dataset;

GDALDriverH driver(const char* name) {
    GDALDriverH const found = GDALGetDriverByName(name);
    if (!found) failed(fmt::format("raster: GDAL has no driver {}", name));
    return found;
}

GDALDataType type_of(RasterType type) {
    return type == RasterType::Float ? GDT_Float32 : GDT_Byte;
}

void describe(GDALDatasetH dataset, const dem::Grid& grid, RasterType type,
              const std::vector<RasterBand>& bands) {
    std::array<double, 6> transform = grid.affine().geotransform();
    GDALSetGeoTransform(dataset, transform.data());
    const dem::GdalCrs crs(grid.crs().text());
    if (crs.known()) GDALSetSpatialRef(dataset, crs.handle());
    for (std::size_t k = 0; k < bands.size(); ++k) {
        GDALRasterBandH to = GDALGetRasterBand(dataset, static_cast<int>(k) + 1);
        GDALSetDescription(to, printable(bands[k].name).c_str());
        GDALSetRasterUnitType(to, bands[k].unit.c_str());
        GDALSetRasterNoDataValue(
            to, type == RasterType::Byte ? 255 : std::numeric_limits<double>::quiet_NaN());
        for (const auto& [key, value] : bands[k].metadata)
            GDALSetMetadataItem(to, key.c_str(), value.c_str(), nullptr);
    }
}

/// Options that change neither the values of the posts nor their grid. A list of what is allowed,
/// and not of what is refused: GDAL's next version may have more that changes either.
constexpr std::array kHarmless{"COMPRESS",
                               "LEVEL",
                               "PREDICTOR",
                               "BLOCKSIZE",
                               "BIGTIFF",
                               "NUM_THREADS",
                               "GEOTIFF_VERSION",
                               "SPARSE_OK",
                               "OVERVIEWS",
                               "OVERVIEW_COUNT",
                               "OVERVIEW_COMPRESS",
                               "OVERVIEW_PREDICTOR",
                               "OVERVIEW_RESAMPLING"};
/// LERC and JPEG XL can be lossless, too, but LERC has no NaN and JPEG XL no readers.
constexpr std::array kLossless{"NONE", "DEFLATE", "LZW", "LZMA", "ZSTD"};

template <typename Words>
bool is_one_of(const std::string& word, const Words& words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* each) { return EQUAL(each, word.c_str()); });
}

/// @throws Error (Usage) for an option that would change the raster's values or grid
void check_harmless(const std::string& name, const std::string& value) {
    if (!is_one_of(name, kHarmless))
        bad_usage(
            fmt::format("--co: {}: would change the result's values or grid, or is no option of "
                        "GDAL's COG driver; expected {}",
                        printable(name), fmt::join(kHarmless, ", ")));
    const bool is_codec =
        EQUAL(name.c_str(), "COMPRESS") || EQUAL(name.c_str(), "OVERVIEW_COMPRESS");
    if (is_codec && !is_one_of(value, kLossless))
        bad_usage(fmt::format("--co: {}={}: would change the result's values; expected {}",
                              printable(name), printable(value), fmt::join(kLossless, ", ")));
}

/// The driver's options: ours, and over them the user's.
dem::GdalStrings creation_options(const std::vector<std::string>& given, GDALDataType type) {
    dem::GdalStrings options;
    options.set("COMPRESS", "DEFLATE");
    options.set("PREDICTOR", "YES");
    options.set("OVERVIEW_RESAMPLING", type == GDT_Byte ? "NEAREST" : "AVERAGE");
    options.set("BIGTIFF", "IF_SAFER");
    options.set("NUM_THREADS", std::to_string(thread_count()));
    for (const std::string& option : given) {
        const std::size_t equals = option.find('=');
        if (equals == std::string::npos || equals == 0)
            bad_usage(fmt::format("--co: {}: expected NAME=VALUE, such as COMPRESS=ZSTD",
                                  printable(option)));
        check_harmless(option.substr(0, equals), option.substr(equals + 1));
        options.set(option.substr(0, equals), option.substr(equals + 1));
    }
    // The digits of measured numbers hardly get shorter by looking longer: half a percent, for a
    // fifth of the time that a file of 36 bands takes.
    if (type == GDT_Float32 && EQUAL(options.find("COMPRESS"), "DEFLATE") && !options.find("LEVEL"))
        options.set("LEVEL", "4");
    return options;
}

}  // namespace

void check_creation_options(const std::vector<std::string>& given) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    CPLErrorReset();
    if (GDALValidateCreationOptions(driver("COG"), creation_options(given, GDT_Byte).list()))
        return;
    // GDAL says why as a warning.
    std::string reason = CPLGetLastErrorMsg();
    if (reason.empty()) reason = "it gives no reason";
    bad_usage(fmt::format("--co: GDAL's COG driver says: {}", reason));
}

struct RasterWriter::Impl {
    OutputFile& file;
    RasterType type;
    std::vector<std::string> options;
    ScratchFiles scratch;
    Dataset plain;

    Impl(OutputFile& to, RasterType of, std::vector<std::string> given)
        : file(to),
          type(of),
          options(std::move(given)),
          scratch([&to] { return to.open_scratch(); }) {}

    [[noreturn]] void refuse(const dem::GdalMessages& messages) const {
        const std::string path = file.path().string();
        failed(fmt::format(
            "{}: {}: cannot be written, {}", file.who(), printable(path),
            scratch.error() != 0 ? std::strerror(scratch.error()) : messages.failure(path)));
    }

    void put(std::size_t band, const dem::Window& where, const void* values) {
        const dem::GdalMessages messages;
        if (GDALRasterIO(GDALGetRasterBand(plain.get(), static_cast<int>(band) + 1), GF_Write,
                         where.column, where.row, where.columns, where.rows,
                         const_cast<void*>(values), where.columns, where.rows, type_of(type), 0,
                         0) != CE_None)
            refuse(messages);
    }
};

RasterWriter::RasterWriter(OutputFile& file, const dem::Grid& grid, RasterType type,
                           const std::vector<RasterBand>& bands, std::vector<std::string> options) {
    dem::prepare_gdal();
    creation_options(options, type_of(type));  // what is wrong with them is said before any work
    impl_ = std::make_unique<Impl>(file, type, std::move(options));
    const dem::GdalMessages messages;
    dem::GdalStrings plain;
    plain.set("TILED", "YES");
    plain.set("BLOCKXSIZE", "512");  // those of the result
    plain.set("BLOCKYSIZE", "512");
    plain.set("INTERLEAVE", "BAND");
    plain.set("PHOTOMETRIC", "MINISBLACK");  // three bands are no colours
    plain.set("BIGTIFF", "IF_SAFER");
    impl_->plain.reset(GDALCreate(driver("GTiff"), impl_->scratch.path("plain.tif").c_str(),
                                  grid.columns(), grid.rows(), static_cast<int>(bands.size()),
                                  type_of(type), plain.list()));
    if (!impl_->plain) impl_->refuse(messages);
    describe(impl_->plain.get(), grid, type, bands);
}

RasterWriter::~RasterWriter() {
    const dem::GdalMessages messages;  // of what is given up, nobody wants to know
    impl_.reset();
}

void RasterWriter::put(std::size_t band, int column, int row, const Array2d<float>& values) {
    const dem::Window window{column, row, values.width(), values.height()};
    if (impl_->type == RasterType::Float) return impl_->put(band, window, values.data());
    std::vector<std::uint8_t> mask(values.size());
    std::ranges::transform(values, mask.begin(), [](float value) -> std::uint8_t {
        return std::isnan(value) ? 255 : value > 0;
    });
    impl_->put(band, window, mask.data());
}

void RasterWriter::finish(const RasterMetadata& metadata) {
    const dem::GdalMessages messages;
    for (const auto& [key, value] : metadata)
        GDALSetMetadataItem(impl_->plain.get(), key.c_str(), value.c_str(), nullptr);
    GDALFlushCache(impl_->plain.get());
    if (impl_->scratch.error() != 0) impl_->refuse(messages);
    {
        dem::GdalStrings wanted = creation_options(impl_->options, type_of(impl_->type));
        // GDAL would wait for threads that it does not get.
        const std::optional<double> threads = parse_number(wanted.find("NUM_THREADS"));
        if (!can_start_threads(threads ? static_cast<int>(*threads) : thread_count()))
            wanted.set("NUM_THREADS", "1");
        const Dataset whole(GDALCreateCopy(driver("COG"), impl_->scratch.path("whole.tif").c_str(),
                                           impl_->plain.get(), FALSE, wanted.list(), nullptr,
                                           nullptr));
        if (!whole) impl_->refuse(messages);
    }
    // What is written when it is closed may fail, too.
    if (messages.any_failure() || impl_->scratch.error() != 0) impl_->refuse(messages);
    impl_->plain.reset();
    if (!impl_->scratch.read("whole.tif",
                             [&](std::span<const std::byte> bytes) { impl_->file.write(bytes); }))
        impl_->refuse(messages);
    impl_->file.finish();
}

}  // namespace relevo::output
