#include "overlay/photo_pixels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "base/log.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"

namespace relevo::overlay {
namespace {

/// Of an image without overviews the reduced copy has no more pixels than these.
constexpr double kMostReduced = 1 << 24;
/// Pixels that are read at once, or those of a row of means.
constexpr int kMostAtOnce = 1 << 20;

std::uint32_t premultiplied(std::uint32_t red, std::uint32_t green, std::uint32_t blue,
                            std::uint32_t alpha) {
    const auto times = [&](std::uint32_t value) { return (value * alpha + 127) / 255; };
    return times(red) | times(green) << 8 | times(blue) << 16 | alpha << 24;
}

/// Means of squares of pixels, from rows that come in order.
class Means {
  public:
    Means(int columns, int rows, int times)
        : times_(times),
          columns_(columns),
          rgba_((columns + times - 1) / times, (rows + times - 1) / times),
          sums_(static_cast<std::size_t>(rgba_.width())) {}

    void add_row(const std::uint32_t* row, bool is_last) {
        for (int column = 0; column < columns_; ++column)
            for (unsigned k = 0; k < 4; ++k)
                sums_[static_cast<std::size_t>(column / times_)][k] += row[column] >> 8 * k & 255;
        if (++added_ < times_ && !is_last) return;
        for (int at = 0; at < rgba_.width(); ++at) {
            const int wide = std::min(times_, columns_ - at * times_);
            const auto count = static_cast<std::uint64_t>(wide) * static_cast<unsigned>(added_);
            std::uint32_t& texel = rgba_.at(at, next_);
            for (unsigned k = 0; k < 4; ++k) {
                std::uint64_t& sum = sums_[static_cast<std::size_t>(at)][k];
                texel |= static_cast<std::uint32_t>((sum + count / 2) / count) << 8 * k;
                sum = 0;
            }
        }
        ++next_;
        added_ = 0;
    }

    Array2d<std::uint32_t> take() { return std::move(rgba_); }

  private:
    int times_, columns_;
    Array2d<std::uint32_t> rgba_;
    std::vector<std::array<std::uint64_t, 4>> sums_;
    int added_ = 0, next_ = 0;
};

/// Pixels of a level that a part needs, from a multiple of `times` on.
Window window_of(const glm::dvec2& first, const glm::dvec2& end, int columns, int rows, int times) {
    const auto from = [&](double at, int most) {
        const int first_pixel =
            static_cast<int>(std::floor(std::clamp(at, 0.0, std::max(most - 1.0, 0.0))));
        return first_pixel / times * times;
    };
    const auto to = [&](double at, int least, int most) {
        return static_cast<int>(std::ceil(std::clamp(at, least + 1.0, double(most))));
    };
    Window window{from(first.x, columns), from(first.y, rows), 0, 0};
    window.columns = to(end.x, window.column, columns) - window.column;
    window.rows = to(end.y, window.row, rows) - window.row;
    return window;
}

}  // namespace

PhotoPixels::PhotoPixels(const std::string& path, void* dataset, std::vector<std::uint32_t> palette)
    : path_(path),
      dataset_(dataset),
      columns_(GDALGetRasterXSize(dataset)),
      rows_(GDALGetRasterYSize(dataset)),
      palette_(std::move(palette)),
      is_classes_(!palette_.empty()) {
    const int bands = is_classes_ ? 1 : GDALGetRasterCount(dataset);
    if (is_classes_) numbers_ = {1, 1, 1};
    for (int i = 1; i <= bands; ++i) {
        const GDALColorInterp meaning =
            GDALGetRasterColorInterpretation(GDALGetRasterBand(dataset, i));
        if (meaning == GCI_RedBand) numbers_[0] = i;
        if (meaning == GCI_GreenBand) numbers_[1] = i;
        if (meaning == GCI_BlueBand) numbers_[2] = i;
        if (meaning == GCI_AlphaBand) alpha_ = i;
    }
    const GDALRasterBandH first = GDALGetRasterBand(dataset, numbers_[0]);
    has_mask_ = alpha_ == 0 && (GDALGetMaskFlags(first) & (GMF_PER_DATASET | GMF_ALPHA)) != 0;
    const bool may_have_table = bands < 3 && !is_classes_;
    if (const GDALColorTableH table = may_have_table ? GDALGetRasterColorTable(first) : nullptr) {
        for (int k = 0; k < std::min(GDALGetColorEntryCount(table), 256); ++k) {
            GDALColorEntry entry{};
            GDALGetColorEntryAsRGB(table, k, &entry);
            const auto byte = [](short value) { return static_cast<std::uint32_t>(value & 255); };
            palette_.push_back(
                premultiplied(byte(entry.c1), byte(entry.c2), byte(entry.c3), byte(entry.c4)));
        }
        numbers_ = {1, 1, 1};
    }
    for (std::size_t k = 0; k < 3; ++k) {
        int has = 0;
        const double nodata =
            GDALGetRasterNoDataValue(GDALGetRasterBand(dataset, numbers_[k]), &has);
        if (has && nodata >= 0 && nodata <= 255 && nodata == std::floor(nodata))
            nodata_[k] = static_cast<int>(nodata);
    }
    levels_.push_back(level_of(-1));
    for (int i = 0; i < GDALGetOverviewCount(first); ++i)
        if (Level level = level_of(i); level.bands[0]) levels_.push_back(level);
    std::ranges::sort(levels_, std::greater<>(), &Level::columns);
}

/// @param overview  -1: the image itself
PhotoPixels::Level PhotoPixels::level_of(int overview) const {
    const auto at = [&](int number) -> GDALRasterBandH {
        const GDALRasterBandH band = GDALGetRasterBand(dataset_, number);
        if (overview < 0) return band;
        return overview < GDALGetOverviewCount(band) ? GDALGetOverview(band, overview) : nullptr;
    };
    Level level;
    for (std::size_t k = 0; k < 3; ++k)
        level.bands[k] = at(numbers_[k]);
    if (!level.bands[0] || !level.bands[1] || !level.bands[2]) return {};
    if (alpha_ > 0) level.mask = at(alpha_);
    if (has_mask_) level.mask = GDALGetMaskBand(level.bands[0]);
    if ((alpha_ > 0 || has_mask_) && !level.mask) return {};
    level.columns = GDALGetRasterBandXSize(level.bands[0]);
    level.rows = GDALGetRasterBandYSize(level.bands[0]);
    return level;
}

const PhotoPixels::Level& PhotoPixels::level_for(double most) const {
    const Level* coarsest = &levels_.front();
    for (const Level& level : levels_)
        if (columns_ <= most * level.columns && rows_ <= most * level.rows) coarsest = &level;
    return *coarsest;
}

void PhotoPixels::read_bytes(void* band, const Window& rows, std::uint8_t* bytes) {
    const dem::GdalMessages messages;
    if (GDALRasterIO(band, GF_Read, rows.column, rows.row, rows.columns, rows.rows, bytes,
                     rows.columns, rows.rows, GDT_Byte, 0, 0) != CE_None)
        messages.refuse(path_, "cannot be read");
}

std::uint32_t PhotoPixels::texel(const std::uint8_t* bytes, std::size_t at, std::size_t count,
                                 bool masked) const {
    const std::uint32_t alpha = masked ? bytes[3 * count + at] : 255;
    if (!palette_.empty()) {
        const std::uint8_t index = bytes[at];
        const bool is_none = alpha == 0 || index == nodata_[0] || index >= palette_.size();
        return is_none ? 0 : palette_[index];
    }
    const std::array<std::uint8_t, 3> color{bytes[at], bytes[count + at], bytes[2 * count + at]};
    if (color[0] == nodata_[0] && color[1] == nodata_[1] && color[2] == nodata_[2]) return 0;
    return premultiplied(color[0], color[1], color[2], alpha);
}

void PhotoPixels::read_rows(const Level& level, const Window& rows,
                            std::vector<std::uint32_t>& rgba) {
    const std::size_t count =
        static_cast<std::size_t>(rows.columns) * static_cast<std::size_t>(rows.rows);
    std::vector<std::uint8_t> bytes(4 * count);
    for (std::size_t k = 0; k < (palette_.empty() ? 3u : 1u); ++k)
        read_bytes(level.bands[k], rows, &bytes[k * count]);
    if (level.mask) read_bytes(level.mask, rows, &bytes[3 * count]);
    rgba.resize(count);
    for (std::size_t at = 0; at < count; ++at)
        rgba[at] = texel(bytes.data(), at, count, level.mask != nullptr);
}

PhotoPixels::Part PhotoPixels::read_level(const Level& level, const Window& window, int times) {
    Means means(window.columns, window.rows, times);
    std::vector<std::uint32_t> rgba;
    const int at_once = std::max(1, kMostAtOnce / window.columns);
    for (int row = 0; row < window.rows; row += at_once) {
        const int rows = std::min(at_once, window.rows - row);
        read_rows(level, {window.column, window.row + row, window.columns, rows}, rgba);
        for (int i = 0; i < rows; ++i)
            means.add_row(
                &rgba[static_cast<std::size_t>(i) * static_cast<unsigned>(window.columns)],
                row + i + 1 == window.rows);
    }
    const glm::dvec2 factor = glm::dvec2(columns_, rows_) / glm::dvec2(level.columns, level.rows);
    return {means.take(), factor * glm::dvec2(window.column, window.row), factor * double(times)};
}

void PhotoPixels::keep_reduced() {
    int times = 2;
    while (double{1} * columns_ * rows_ > kMostReduced * times * times)
        times *= 2;
    constexpr double kMany = 4e8;  // some seconds
    if (const double pixels = double{1} * columns_ * rows_; pixels > kMany)
        log::info(
            fmt::format("{}: it has no overviews, so all of its {:.0f} million pixels are read "
                        "first; gdaladdo -r {} makes some",
                        path_, pixels / 1e6, is_classes_ ? "mode" : "average"));
    reduced_ = read_level(levels_.front(), {0, 0, columns_, rows_}, times);
}

PhotoPixels::Part PhotoPixels::read(const glm::dvec2& first, const glm::dvec2& end, double most) {
    const bool is_large = double{1} * columns_ * rows_ > kMostReduced;
    const Level& level = level_for(most);
    const double factor = double(columns_) / level.columns;
    const bool reads_many = most >= 8 * factor && is_large;
    if (reads_many && !reduced_) keep_reduced();
    if (reads_many && most >= reduced_->reduced.x) {
        const Array2d<std::uint32_t>& all = reduced_->rgba;
        const double own = reduced_->reduced.x;
        const int times = std::max(1, static_cast<int>(most / own));
        const Window window = window_of(first / own, end / own, all.width(), all.height(), times);
        Means means(window.columns, window.rows, times);
        for (int row = 0; row < window.rows; ++row)
            means.add_row(&all.at(window.column, window.row + row), row + 1 == window.rows);
        return {means.take(), own * glm::dvec2(window.column, window.row), glm::dvec2(own * times)};
    }
    const glm::dvec2 shrunk = glm::dvec2(columns_, rows_) / glm::dvec2(level.columns, level.rows);
    const int times = std::max(1, static_cast<int>(most / std::max(shrunk.x, shrunk.y)));
    return read_level(
        level, window_of(first / shrunk, end / shrunk, level.columns, level.rows, times), times);
}

}  // namespace relevo::overlay
