#include "render/picture_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace relevo::render {
namespace {

int parts_over(int pixels) {
    return (pixels + PictureParts::kSide_px - 1) / PictureParts::kSide_px;
}

}  // namespace

PictureParts::PictureParts(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      columns_(parts_over(width_px)),
      rows_(parts_over(height_px)),
      whole_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void PictureParts::mark(const glm::dvec2& low_px, const glm::dvec2& high_px) {
    // First to the picture: numbers far beyond it are no integers.
    const glm::dvec2 size(width_px_, height_px_);
    if (high_px.x < 0 || high_px.y < 0 || low_px.x > size.x || low_px.y > size.y) return;
    const glm::ivec2 last(columns_ - 1, rows_ - 1);
    const auto part = [&](const glm::dvec2& px) {
        return glm::min(glm::ivec2(glm::clamp(px, glm::dvec2(0), size)) / kSide_px, last);
    };
    const glm::ivec2 from = part(low_px), to = part(high_px);
    for (int row = from.y; row <= to.y; ++row)
        std::fill_n(whole_.begin() + row * columns_ + from.x, to.x - from.x + 1, true);
}

void PictureParts::mark_all() {
    whole_.assign(whole_.size(), true);
}

bool PictureParts::is_whole(int column, int row) const {
    return whole_[static_cast<std::size_t>(row * columns_ + column)];
}

std::vector<PixelRectangle> PictureParts::rectangles(bool whole) const {
    std::vector<PixelRectangle> all;
    std::size_t below = 0;  // where those begin that end at this row
    for (int row = 0; row < rows_; ++row) {
        const std::size_t first = all.size();
        const int bottom = row * kSide_px, height = std::min(kSide_px, height_px_ - bottom);
        for (int column = 0; column < columns_; ++column) {
            if (is_whole(column, row) != whole) continue;
            const int begin = column;
            while (column + 1 < columns_ && is_whole(column + 1, row) == whole)
                ++column;
            const int left = begin * kSide_px;
            const int width = std::min((column + 1) * kSide_px, width_px_) - left;
            all.push_back({left, bottom, width, height});
        }
        // A row like the one below it makes that higher.
        const bool same = all.size() - first == first - below &&
                          std::equal(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(),
                                     all.begin() + static_cast<std::ptrdiff_t>(below),
                                     [](const PixelRectangle& a, const PixelRectangle& b) {
                                         return a.left == b.left && a.width == b.width;
                                     });
        if (same && first > below) {
            all.resize(first);
            for (std::size_t i = below; i < first; ++i)
                all[i].height += height;
        } else {
            below = first;
        }
    }
    return all;
}

}  // namespace relevo::render
