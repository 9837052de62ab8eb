#include "render/water_field.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>

#include "base/parallel_for.h"
#include "dem/fill_holes.h"
#include "render/pages.h"

namespace relevo::render {
namespace {

using dem::WaterKind;

/// Least distance of a post to the shore, in post spacings.
constexpr double kLeastShore = 0.1;

std::uint8_t unorm8(double value) {
    return static_cast<std::uint8_t>(std::lrint(std::clamp(value, 0.0, 1.0) * 255));
}

/// Kinds of water, with posts without a height set to the kind of the nearest post with one,
/// counted in steps along rows and columns. Empty if all posts have heights.
Array2d<WaterKind> with_kind_in_voids(const Array2d<WaterKind>& kind, const Array2d<float>& h) {
    const auto is_void = [](float height_m) { return std::isnan(height_m); };
    if (kind.empty() || std::ranges::none_of(h, is_void)) return {};
    Array2d<WaterKind> result = kind;
    constexpr int kFar = 1 << 30;
    Array2d<int> steps(kind.width(), kind.height(), 0);
    for (std::size_t i = 0; i < h.size(); ++i)
        if (is_void(h.data()[i])) steps.data()[i] = kFar;
    const auto take = [&](int column, int row, int from_column, int from_row) {
        if (from_column < 0 || from_row < 0 || from_column >= kind.width() ||
            from_row >= kind.height())
            return;
        const int away = steps.at(from_column, from_row) + 1;
        if (away >= steps.at(column, row)) return;
        steps.at(column, row) = away;
        result.at(column, row) = result.at(from_column, from_row);
    };
    for (int row = 0; row < kind.height(); ++row)
        for (int column = 0; column < kind.width(); ++column) {
            take(column, row, column - 1, row);
            take(column, row, column, row - 1);
        }
    for (int row = kind.height() - 1; row >= 0; --row)
        for (int column = kind.width() - 1; column >= 0; --column) {
            take(column, row, column + 1, row);
            take(column, row, column, row + 1);
        }
    return result;
}

bool uniform(const WaterTexel* const* rows) {
    const WaterTexel& own = rows[1][0];
    for (int r = 0; r < 3; ++r)
        if (rows[r][-1] != own || rows[r][0] != own || rows[r][1] != own) return false;
    return true;
}

/// Weighted mean of texels. Kinds of water are weighted by amount of water.
class TexelMean {
  public:
    void add(double weight, const WaterTexel& texel) {
        const double wet = weight * texel[0];
        whole_ += weight;
        wet_ += wet;
        sea_ += wet * texel[1];
        floor_ += wet * texel[2];
        filled_ += weight * texel[3];
    }
    WaterTexel mean() const {
        const double wet = 255 * std::max(wet_, 1e-9);
        return {unorm8(wet_ / (255 * whole_)), unorm8(sea_ / wet), unorm8(floor_ / wet),
                unorm8(filled_ / (255 * whole_))};
    }

  private:
    double whole_ = 0, wet_ = 0, sea_ = 0, floor_ = 0, filled_ = 0;
};

/// A node as the mean of finer ones. The last nodes are on the last posts, as in dem::Pyramid.
/// @param finer  rows of the finer level from row `top`, with all columns
/// @param fine   columns and rows of the finer level
WaterTexel coarser(const Array2d<WaterTexel>& finer, glm::ivec2 node, glm::ivec2 fine, int top) {
    const glm::ivec2 middle = glm::min(2 * node, fine - 1);
    if (middle == glm::clamp(middle, glm::ivec2(1), fine - 2)) {
        const WaterTexel* const rows[3] = {&finer.at(middle.x, middle.y - 1 - top),
                                           &finer.at(middle.x, middle.y - top),
                                           &finer.at(middle.x, middle.y + 1 - top)};
        if (uniform(rows)) return *rows[1];
    }
    TexelMean mean;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 at = middle + glm::ivec2(dx, dy);
            if (at != glm::clamp(at, glm::ivec2(0), fine - 1)) continue;
            mean.add((2 - std::abs(dx)) * (2 - std::abs(dy)), finer.at(at.x, at.y - top));
        }
    return mean.mean();
}

}  // namespace

WaterField::WaterField(const Array2d<float>& heights_m, const dem::Water& water,
                       const Array2d<std::uint8_t>* filled, int reduction)
    : heights_m_(heights_m),
      kind_in_voids_(with_kind_in_voids(water.kind, heights_m)),
      kind_(kind_in_voids_.empty() ? water.kind : kind_in_voids_),
      filled_(filled),
      reduction_(reduction) {
    make_levels();
}

/// Signed distance to the shore, -1 to 1, positive where wet.
double WaterField::shore(int column, int row, bool wet) const {
    const Array2d<WaterKind>& kind = kind_;
    const auto kind_at = [&](int c, int r) {
        return kind.at(std::clamp(c, 0, kind.width() - 1), std::clamp(r, 0, kind.height() - 1));
    };
    // With a known floor: the nearest zero crossings along the row and the column.
    double nearer = 0;  // sum of their inverse squared distances
    for (const glm::ivec2 axis : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
        double nearest = 1e9;
        for (const int way : {-1, 1}) {
            const int c = std::clamp(column + way * axis.x, 0, kind.width() - 1);
            const int r = std::clamp(row + way * axis.y, 0, kind.height() - 1);
            const WaterKind other = kind.at(c, r), here = kind.at(column, row);
            if ((other != WaterKind::None) == wet) continue;
            if ((wet ? here : other) != WaterKind::SeaFloor) continue;
            const double own_m = std::abs(double{heights_m_.at(column, row)});
            const double other_m = std::abs(double{heights_m_.at(c, r)});
            if (std::isnan(own_m + other_m)) continue;
            nearest = std::min(nearest, own_m / std::max(own_m + other_m, 1e-6));
        }
        nearer += 1 / std::max(nearest * nearest, 1e-6);
    }
    if (nearer > 1e-3)
        return (wet ? 1 : -1) * std::clamp(1 / std::sqrt(nearer), 0.5 * kLeastShore, 1.0);
    double sum = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            sum += (2 - std::abs(dx)) * (2 - std::abs(dy)) *
                   (kind_at(column + dx, row + dy) != WaterKind::None ? 1 : -1);
    const double blurred = sum / 16;
    return wet ? std::max(blurred, kLeastShore) : std::min(blurred, -kLeastShore);
}

/// The kind of a post if its neighbours have the same, as is usual.
std::optional<WaterKind> WaterField::kind_around(int column, int row) const {
    const Array2d<WaterKind>& kind = kind_;
    if (column < 1 || row < 1 || column + 1 >= kind.width() || row + 1 >= kind.height())
        return std::nullopt;
    const WaterKind own = kind.at(column, row);
    for (int r = row - 1; r <= row + 1; ++r) {
        const WaterKind* const k = &kind.at(column, r);
        if (k[-1] != own || k[0] != own || k[1] != own) return std::nullopt;
    }
    return own;
}

/// Covered voids in water need no cover.
std::uint8_t WaterField::filled_texel(int column, int row) const {
    const std::uint8_t filled = filled_ ? filled_->at(column, row) : std::uint8_t{0};
    if (filled == 0) return 0;
    const bool wet = !kind_.empty() && kind_.at(column, row) != WaterKind::None;
    return filled == dem::kCovered && !wet ? 255 : 128;
}

WaterTexel WaterField::of_post(int column, int row) const {
    const Array2d<WaterKind>& kind = kind_;
    const std::uint8_t filled = filled_texel(column, row);
    if (kind.empty()) return {0, 0, 0, filled};
    if (const std::optional<WaterKind> alone = kind_around(column, row)) {
        const bool is_sea = *alone == WaterKind::Sea || *alone == WaterKind::SeaFloor;
        const auto all_or_none = [](bool all) { return static_cast<std::uint8_t>(all ? 255 : 0); };
        return {all_or_none(*alone != WaterKind::None), all_or_none(is_sea),
                all_or_none(*alone == WaterKind::SeaFloor), filled};
    }
    int wet = 0, sea = 0, floor = 0;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, kind.height() - 1); ++r) {
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, kind.width() - 1); ++c) {
            const WaterKind k = kind.at(c, r);
            wet += k != WaterKind::None;
            sea += k == WaterKind::Sea || k == WaterKind::SeaFloor;
            floor += k == WaterKind::SeaFloor;
        }
    }
    if (wet == 0) return {0, 0, 0, filled};
    const bool is_wet = kind.at(column, row) != WaterKind::None;
    return {unorm8(0.5 + 0.5 * shore(column, row, is_wet)), unorm8(double(sea) / wet),
            unorm8(double(floor) / wet), filled};
}

WaterTexel WaterField::at(int level, int column, int row) const {
    if (level == 0 || levels_.empty())
        return of_post(std::clamp(column, 0, heights_m_.width() - 1),
                       std::clamp(row, 0, heights_m_.height() - 1));
    const Array2d<WaterTexel>& texels = levels_[static_cast<std::size_t>(
        std::min(level - 1, static_cast<int>(levels_.size()) - 1))];
    return texels.at(std::clamp(column, 0, texels.width() - 1),
                     std::clamp(row, 0, texels.height() - 1));
}

void WaterField::make_levels() {
    if (kind_.empty() && !filled_) return;
    glm::ivec2 fine(heights_m_.width(), heights_m_.height());
    while (std::max(fine.x, fine.y) > 2) {
        const glm::ivec2 size = fine / 2 + 1;
        Array2d<WaterTexel> texels(size.x, size.y);
        const int level = static_cast<int>(levels_.size());
        parallel_for(0, size.y, 16, [&](int first, int last) {
            // Finer nodes of these rows, computed once.
            const int top = std::max(std::min(2 * first, fine.y - 1) - 1, 0),
                      bottom = std::min(2 * last, fine.y);
            Array2d<WaterTexel> finer(fine.x, bottom - top);
            for (int row = top; row < bottom; ++row)
                for (int column = 0; column < fine.x; ++column)
                    finer.at(column, row - top) = at(level, column, row);
            for (int row = first; row < last; ++row)
                for (int column = 0; column < size.x; ++column)
                    texels.at(column, row) = coarser(finer, {column, row}, fine, top);
        });
        levels_.push_back(std::move(texels));
        fine = size;
    }
}

WaterTexel WaterField::between(int level, glm::dvec2 node) const {
    const glm::dvec2 first = glm::floor(node), t = node - first;
    TexelMean mean;
    for (int dy = 0; dy <= 1; ++dy)
        for (int dx = 0; dx <= 1; ++dx)
            mean.add((dx ? t.x : 1 - t.x) * (dy ? t.y : 1 - t.y) + 1e-9,
                     at(level, static_cast<int>(first.x) + dx, static_cast<int>(first.y) + dy));
    return mean.mean();
}

std::vector<WaterTexel> WaterField::page(const dem::Pyramid& pyramid, int level,
                                         glm::ivec2 page) const {
    const glm::ivec2 first = page * kNormalNodes - 1, last = pyramid.size(level) - 1;
    std::vector<WaterTexel> texels;
    texels.reserve(std::size_t{kNormalPage_px} * kNormalPage_px);
    const int means_level = std::bit_width(static_cast<unsigned>(reduction_)) - 1;
    for (int y = 0; y < kNormalPage_px; ++y) {
        for (int x = 0; x < kNormalPage_px; ++x) {
            const glm::ivec2 node = glm::clamp(first + glm::ivec2(x, y), glm::ivec2(0), last);
            if (reduction_ == 1) {
                texels.push_back(at(level, node.x, node.y));
                continue;
            }
            // A mean is at the centre of its posts.
            const glm::dvec2 mean =
                (glm::dvec2(pyramid.post(level, node)) + 0.5) / double(reduction_) - 0.5;
            const int own = std::max(level - means_level, 0);
            texels.push_back(between(own, mean * std::exp2(-own)));
        }
    }
    return texels;
}

}  // namespace relevo::render
