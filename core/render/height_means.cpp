#include "render/height_means.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "base/parallel_for.h"
#include "render/block_means.h"

namespace relevo::render {
namespace {

constexpr int kWidest_px = 10922;  // half as wide again is what OpenGL 4.5 guarantees
constexpr int kSlopeTexels = 600;  // along a side, at most: as a picture shows a whole DEM

/// Height between the four texels around a place, linearly [m].
float between(const Array2d<float>& height_m, float column, float row) {
    const auto cell = [](float at, int size, float& share) {
        at = std::clamp(at, 0.0F, static_cast<float>(size - 1));
        const int first = std::min(static_cast<int>(at), std::max(size - 2, 0));
        share = at - static_cast<float>(first);
        return first;
    };
    float x, y;
    const int left = cell(column, height_m.width(), x), top = cell(row, height_m.height(), y);
    const int right = std::min(left + 1, height_m.width() - 1);
    const int bottom = std::min(top + 1, height_m.height() - 1);
    return std::lerp(std::lerp(height_m.at(left, top), height_m.at(right, top), x),
                     std::lerp(height_m.at(left, bottom), height_m.at(right, bottom), x), y);
}

/// As a coarser level has a place of a finer one [m].
float coarser(const Array2d<float>& coarser_m, int column, int row) {
    return between(coarser_m, 0.5F * static_cast<float>(column) - 0.25F,
                   0.5F * static_cast<float>(row) - 0.25F);
}

/// How far heights are from those of a coarser level: root of the mean square; 0 of voids alone.
float roughness_m(const Array2d<float>& height_m, const Array2d<float>& coarser_m) {
    double sum = 0, count = 0;
    for (int row = 0; row < height_m.height(); ++row)
        for (int column = 0; column < height_m.width(); ++column) {
            const float height = height_m.at(column, row);
            if (std::isnan(height)) continue;
            const double apart_m = height - coarser(coarser_m, column, row);
            sum += apart_m * apart_m;
            ++count;
        }
    return count > 0 ? static_cast<float>(std::sqrt(sum / count)) : 0;
}

/// Of mean 0 and variance 1, by the place alone.
float noise_at(int column, int row, std::size_t level) {
    std::uint32_t bits = static_cast<std::uint32_t>(column) * 0x9E3779B1U ^
                         static_cast<std::uint32_t>(row) * 0x85EBCA77U ^
                         static_cast<std::uint32_t>(level) * 0xC2B2AE3DU;
    bits = (bits ^ bits >> 15) * 0x2C1B3C6DU;
    bits = (bits ^ bits >> 12) * 0x297A2D39U;
    bits ^= bits >> 15;
    return std::sqrt(12.0F) * (static_cast<float>(bits >> 8) / 0x1p24F - 0.5F);
}

/// Gives voids the heights of a coarser level, and on them ground as rough as there is around.
void fill_voids(Array2d<float>& height_m, const Array2d<float>& coarser_m, std::size_t level) {
    constexpr int kFew = 8;  // texels, which say nothing of what else there is
    if (std::ranges::none_of(height_m, [](float height) { return std::isnan(height); })) return;
    const bool is_coarse = std::min(coarser_m.width(), coarser_m.height()) < kFew;
    const float rough_m = is_coarse ? 0 : roughness_m(height_m, coarser_m);
    parallel_for(0, height_m.height(), 64, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < height_m.width(); ++column)
                if (float& height = height_m.at(column, row); std::isnan(height))
                    height =
                        coarser(coarser_m, column, row) + rough_m * noise_at(column, row, level);
    });
}

/// Mean slope between the heights of a level, in metres per metre; 0 of a single row or column.
/// @param spacing_m  between them
double mean_slope(const Array2d<float>& height_m, const glm::dvec2& spacing_m) {
    double sum = 0;
    for (int row = 1; row < height_m.height(); ++row)
        for (int column = 1; column < height_m.width(); ++column) {
            const double here = height_m.at(column, row);
            sum += glm::length(glm::dvec2(here - height_m.at(column - 1, row),
                                          here - height_m.at(column, row - 1)) /
                               spacing_m);
        }
    const double count = (height_m.width() - 1.0) * (height_m.height() - 1.0);
    return count > 0 ? sum / count : 0;
}

/// All levels in one: the others on the right of level 0, one below the other.
Array2d<float> side_by_side(const std::vector<Array2d<float>>& levels) {
    const int width = levels[0].width(), height = levels[0].height();
    Array2d<float> sheet(width + width / 2, height);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        const int x = level > 0 ? width : 0, y = level > 0 ? height - (height >> (level - 1)) : 0;
        for (int row = 0; row < levels[level].height(); ++row)
            std::ranges::copy(levels[level].row(row), &sheet.at(x, y + row));
    }
    return sheet;
}

}  // namespace

void HeightMeans::make() {
    const Array2d<float>& posts_m = field_.height_m;
    const auto is_too_large = [&] {
        return std::max(posts_m.width(), posts_m.height()) / reduction_ > kWidest_px ||
               std::int64_t{posts_m.width() / reduction_} * (posts_m.height() / reduction_) >
                   kMaxPosts;
    };
    while (is_too_large())
        reduction_ *= 2;
    std::vector<Array2d<float>> levels;
    levels.push_back(block_means(posts_m, reduction_));
    while (std::min(levels.back().width(), levels.back().height()) > 1)
        levels.push_back(block_means(levels.back(), 2));
    for (float& height_m : levels.back())
        if (std::isnan(height_m)) height_m = field_.about.statistics.min_m;
    for (std::size_t level = levels.size() - 1; level > 0; --level)
        fill_voids(levels[level - 1], levels[level], level);
    std::size_t shown = 0;
    while (shown + 1 < levels.size() &&
           std::max(levels[shown].width(), levels[shown].height()) > kSlopeTexels)
        ++shown;
    mean_slope_ = mean_slope(
        levels[shown], static_cast<double>(reduction_ << shown) * field_.grid.post_spacing_m());
    const Array2d<float> sheet = side_by_side(levels);
    texture_.emplace(gl::TextureKind::D2, gl::Format::R32F,
                     gl::Extent{sheet.width(), sheet.height(), 1}, 1, kHeightMeansTexture);
    texture_->set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
    texture_->write(0, {0, 0, 0}, texture_->extent(),
                    std::as_bytes(std::span(sheet.data(), sheet.size())));
}

void HeightMeans::update(FrameBlock& block) {
    if (!texture_) make();
    block.light_grid.z =
        static_cast<float>(1.0 / (static_cast<double>(field_.reduction) * reduction_));
    block.light_map.y = static_cast<float>(mean_slope_);
}

}  // namespace relevo::render
