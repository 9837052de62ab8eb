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

/// Gives voids the heights of a coarser level.
void fill_voids(Array2d<float>& height_m, const Array2d<float>& coarser_m) {
    parallel_for(0, height_m.height(), 64, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < height_m.width(); ++column) {
                float& height = height_m.at(column, row);
                if (std::isnan(height))
                    height = coarser_m.at(std::min(column / 2, coarser_m.width() - 1),
                                          std::min(row / 2, coarser_m.height() - 1));
            }
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
        fill_voids(levels[level - 1], levels[level]);
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
