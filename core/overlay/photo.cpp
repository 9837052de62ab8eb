#include "overlay/photo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "overlay/band_over.h"
#include "overlay/photo_pixels.h"

namespace relevo::overlay {
namespace {

/// Samples along a side of the image and of the DEM.
constexpr int kExtentSamples = 32;

PhotoKind kind_of(GDALDatasetH dataset) {
    const int bands = GDALGetRasterCount(dataset);
    bool bytes = bands > 0, red = false, green = false, blue = false;
    for (int i = 1; i <= bands; ++i) {
        const GDALRasterBandH band = GDALGetRasterBand(dataset, i);
        bytes = bytes && GDALGetRasterDataType(band) == GDT_Byte;
        const GDALColorInterp meaning = GDALGetRasterColorInterpretation(band);
        red = red || meaning == GCI_RedBand;
        green = green || meaning == GCI_GreenBand;
        blue = blue || meaning == GCI_BlueBand;
    }
    const bool named = red && green && blue;
    if (bytes && bands == 1 && GDALGetRasterColorTable(GDALGetRasterBand(dataset, 1)))
        return PhotoKind::Palette;
    if (bytes && (bands == 3 || bands == 4 || named)) return PhotoKind::Colours;
    return named ? PhotoKind::Deep : PhotoKind::None;
}

bool is_in(const dem::Grid& grid, const glm::dvec2& at) {
    return at.x >= -0.5 && at.y >= -0.5 && at.x <= grid.columns() - 0.5 &&
           at.y <= grid.rows() - 0.5;
}

/// Calls back for places all over a part of a grid, its edges included.
template <typename Take>
void each_sample(const glm::dvec2& first, const glm::dvec2& last, const Take& take) {
    for (int j = 0; j <= kExtentSamples; ++j)
        for (int i = 0; i <= kExtentSamples; ++i)
            take(glm::mix(first, last, glm::dvec2(i, j) / double{kExtentSamples}));
}

/// Linear between pixels; alpha at the outermost ones is not blended with what is outside.
std::uint32_t between(const Array2d<std::uint32_t>& rgba, const glm::dvec2& at) {
    const glm::dvec2 base = glm::floor(at);
    const glm::dvec2 t = at - base;
    std::array<double, 4> sums{};
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int column = std::clamp(static_cast<int>(base.x) + i, 0, rgba.width() - 1);
            const int row = std::clamp(static_cast<int>(base.y) + j, 0, rgba.height() - 1);
            const std::uint32_t texel = rgba.at(column, row);
            const double weight = (i ? t.x : 1 - t.x) * (j ? t.y : 1 - t.y);
            for (unsigned k = 0; k < 4; ++k)
                sums[k] += weight * static_cast<double>(texel >> 8 * k & 255);
        }
    std::uint32_t result = 0;
    for (unsigned k = 0; k < 4; ++k)
        result |= static_cast<std::uint32_t>(std::lround(sums[k])) << 8 * k;
    return result;
}

/// The band of a raster of classes.
GDALRasterBandH band_of_classes(const std::string& path, GDALDatasetH dataset) {
    const GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (!band || GDALGetRasterDataType(band) != GDT_Byte)
        dem::refuse(path,
                    "the raster's classes are no bytes; convert it with gdal_translate -ot Byte");
    return band;
}

}  // namespace

struct Photo::Impl {
    Impl(const std::string& path, dem::Dataset opened, const dem::Grid& of_raster,
         const dem::Grid& of_dem, std::vector<std::uint32_t> palette)
        : dem(of_dem),
          raster(of_raster),
          dataset(std::move(opened)),
          pixels(path, dataset.get(), std::move(palette)) {}

    /// @param palette  of the first band; empty: as the file says
    static std::unique_ptr<Impl> open(const std::string& path, const std::string& opened,
                                      dem::Dataset dataset, const dem::Grid& dem,
                                      std::vector<std::uint32_t> palette);

    dem::Grid dem, raster;
    dem::Dataset dataset;
    PhotoPixels pixels;
    std::mutex one_reader;
    glm::dvec2 first_post{0}, last_post{0}, pixels_per_post{1};

    void find_extent(const std::string& path);
    void find_density();
    glm::dvec2 pixel(const glm::dvec2& post) const {
        return raster.post(dem.place(post.x, post.y));
    }
    void read(const dem::PlacesOver& places, const Window& part, Array2d<std::uint32_t>& rgba);
};

/// Sets the posts between which the image lies.
void Photo::Impl::find_extent(const std::string& path) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const glm::dvec2 dem_end(dem.columns() - 0.5, dem.rows() - 0.5), start(-0.5);
    glm::dvec2 low(kInfinity), high(-kInfinity);
    bool covers = false;
    each_sample(start, {raster.columns() - 0.5, raster.rows() - 0.5}, [&](const glm::dvec2& at) {
        const glm::dvec2 post = dem.post(raster.place(at.x, at.y));
        if (!std::isfinite(post.x) || !std::isfinite(post.y)) return;
        low = glm::min(low, post);
        high = glm::max(high, post);
        covers = covers || is_in(dem, post);
    });
    // Edges are curved between the samples.
    const glm::dvec2 margin = 0.02 * (high - low) + 1.0;
    low = glm::max(low - margin, start);
    high = glm::min(high + margin, dem_end);
    // Longitudes may be counted otherwise, and poles may be inside.
    each_sample(start, dem_end, [&](const glm::dvec2& post) {
        const glm::dvec2 at = pixel(post);
        if (!is_in(raster, at)) return;
        low = glm::min(low, post);
        high = glm::max(high, post);
        covers = true;
    });
    if (low.x < high.x && low.y < high.y && !covers)
        each_sample(low, high,
                    [&](const glm::dvec2& post) { covers = covers || is_in(raster, pixel(post)); });
    if (!covers)
        dem::refuse(path,
                    fmt::format("the raster does not cover this DEM; it is at {}, the DEM at {}",
                                extent_text(raster), extent_text(dem)));
    first_post = glm::max(low, glm::dvec2(0));
    last_post = glm::min(high, glm::dvec2(dem.columns() - 1, dem.rows() - 1));
}

/// Sets the pixels per post.
void Photo::Impl::find_density() {
    constexpr double kStep = 0.25;  // posts
    glm::dvec2 most(0);
    each_sample(first_post, last_post, [&](const glm::dvec2& post) {
        const glm::dvec2 here = pixel(post);
        if (!is_in(raster, here)) return;
        const glm::dvec2 dense(distance(here, pixel(post + glm::dvec2(kStep, 0))),
                               distance(here, pixel(post + glm::dvec2(0, kStep))));
        // Where longitudes begin anew, neighbours are a whole turn apart.
        if (!(std::max(dense.x, dense.y) < 0.25 * std::max(raster.columns(), raster.rows())))
            return;
        most = glm::max(most, dense / kStep);
    });
    if (!(std::min(most.x, most.y) > 0)) most = glm::dvec2(1);
    pixels_per_post = most;
}

/// Fills in a part of the points, which is divided where its places are far apart in the image.
void Photo::Impl::read(const dem::PlacesOver& places, const Window& part,
                       Array2d<std::uint32_t>& rgba) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    glm::dvec2 low(kInfinity), high(-kInfinity);
    Array2d<glm::dvec2> at(part.columns, part.rows);
    for (int row = 0; row < part.rows; ++row)
        for (int column = 0; column < part.columns; ++column) {
            const glm::dvec2 place = places(part.column + column, part.row + row);
            at.at(column, row) = place;
            if (!is_in(raster, place)) continue;
            low = glm::min(low, place);
            high = glm::max(high, place);
        }
    if (low.x > high.x) return;
    const auto [here, right, below] = std::tuple(
        at.at(0, 0), at.at(std::min(1, part.columns - 1), 0), at.at(0, std::min(1, part.rows - 1)));
    double apart = std::min(distance(here, right), distance(here, below));
    if (!std::isfinite(apart)) apart = 1;
    const double most = std::max(1.0, apart * 1.25);  // points a little denser than pixels count
    const glm::dvec2 needed = (high - low) / most;
    const double points = double{1} * part.columns * part.rows;
    if ((needed.x + 2) * (needed.y + 2) > 16 * (points + 256) && points > 64) {
        const bool wide = part.columns >= part.rows;
        const int half = (wide ? part.columns : part.rows) / 2;
        Window first = part, second = part;
        (wide ? first.columns : first.rows) = half;
        (wide ? second.column : second.row) += half;
        (wide ? second.columns : second.rows) -= half;
        read(places, first, rgba);
        return read(places, second, rgba);
    }
    const PhotoPixels::Part pixel_part = [&] {
        const std::lock_guard lock(one_reader);
        return pixels.read(low - most - 1.0, high + most + 2.0, most);
    }();
    for (int row = 0; row < part.rows; ++row)
        for (int column = 0; column < part.columns; ++column) {
            const glm::dvec2 place = at.at(column, row);
            if (!is_in(raster, place)) continue;
            rgba.at(part.column + column, part.row + row) = between(
                pixel_part.rgba, (place + 0.5 - pixel_part.first) / pixel_part.reduced - 0.5);
        }
}

std::bitset<256> classes_of(const std::string& path) {
    constexpr int kMostSide = 512;
    AllowedName opened(path);
    const dem::Dataset dataset = dem::open_dataset(opened);
    const GDALRasterBandH band = band_of_classes(path, dataset.get());
    const int columns = GDALGetRasterBandXSize(band), rows = GDALGetRasterBandYSize(band);
    const int wide = std::min(columns, kMostSide), high = std::min(rows, kMostSide);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(wide) * static_cast<unsigned>(high));
    const dem::GdalMessages messages;
    if (GDALRasterIO(band, GF_Read, 0, 0, columns, rows, bytes.data(), wide, high, GDT_Byte, 0,
                     0) != CE_None)
        messages.refuse(path, "cannot be read");
    std::vector<std::uint8_t> mask(bytes.size(), 255);
    if (GDALRasterIO(GDALGetMaskBand(band), GF_Read, 0, 0, columns, rows, mask.data(), wide, high,
                     GDT_Byte, 0, 0) != CE_None)
        dem::refuse(path, fmt::format("its mask cannot be read, {}", messages.failure(path)));
    std::bitset<256> found;
    for (std::size_t at = 0; at < bytes.size(); ++at)
        if (mask[at] != 0) found.set(bytes[at]);
    return found;
}

std::unique_ptr<Photo::Impl> Photo::Impl::open(const std::string& path, const std::string& opened,
                                               dem::Dataset dataset, const dem::Grid& dem,
                                               std::vector<std::uint32_t> palette) {
    const dem::Grid raster = grid_of_raster(path, opened, dataset.get());
    auto impl = std::make_unique<Impl>(path, std::move(dataset), raster, dem, std::move(palette));
    impl->find_extent(path);
    impl->find_density();
    return impl;
}

PhotoKind photo_kind(const std::string& path) {
    AllowedName opened(path);
    return kind_of(dem::open_dataset(opened).get());
}

std::shared_ptr<const Photo> Photo::open(const std::string& path, const dem::Grid& dem) {
    AllowedName opened(path);
    dem::Dataset dataset = dem::open_dataset(opened);
    const PhotoKind kind = kind_of(dataset.get());
    if (kind != PhotoKind::Colours && kind != PhotoKind::Palette)
        dem::refuse(path, "the raster is no image of 8 bits");
    return std::shared_ptr<const Photo>(
        new Photo(Impl::open(path, opened.text(), std::move(dataset), dem, {})));
}

std::shared_ptr<const Photo> Photo::open_classes(const std::string& path, const dem::Grid& dem,
                                                 std::vector<std::uint32_t> palette) {
    AllowedName opened(path);
    dem::Dataset dataset = dem::open_dataset(opened);
    band_of_classes(path, dataset.get());
    return std::shared_ptr<const Photo>(
        new Photo(Impl::open(path, opened.text(), std::move(dataset), dem, std::move(palette))));
}

Photo::Photo(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Photo::~Photo() = default;

glm::dvec2 Photo::first_post() const {
    return impl_->first_post;
}

glm::dvec2 Photo::last_post() const {
    return impl_->last_post;
}

glm::dvec2 Photo::pixels_per_post() const {
    return impl_->pixels_per_post;
}

Array2d<std::uint32_t> Photo::read(const dem::PointsOver& points) const {
    Array2d<std::uint32_t> rgba(points.count.x, points.count.y);
    const dem::PlacesOver places(impl_->dem, impl_->raster, points);
    impl_->read(places, {0, 0, points.count.x, points.count.y}, rgba);
    return rgba;
}

}  // namespace relevo::overlay
