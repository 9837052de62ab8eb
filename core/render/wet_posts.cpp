#include "render/wet_posts.h"

#include <algorithm>

#include <glm/common.hpp>

namespace relevo::render {
namespace {

bool is_wet(const Array2d<dem::WaterKind>& kind, int square, int row) {
    const auto posts = kind.row(row);
    const auto first = posts.begin() + std::ptrdiff_t{square} * WetPosts::kSide;
    const auto last = std::min(first + WetPosts::kSide, posts.end());
    return std::any_of(first, last, [](dem::WaterKind at) { return at != dem::WaterKind::None; });
}

}  // namespace

WetPosts::WetPosts(const Array2d<dem::WaterKind>& kind)
    : squares_((glm::ivec2(kind.width(), kind.height()) + kSide - 1) / kSide),
      below_(squares_.x + 1, squares_.y + 1) {
    for (int y = 0; y < squares_.y; ++y)
        for (int x = 0; x < squares_.x; ++x) {
            const int end = std::min((y + 1) * kSide, kind.height());
            bool wet = false;
            for (int row = y * kSide; row < end && !wet; ++row)
                wet = is_wet(kind, x, row);
            below_.at(x + 1, y + 1) =
                below_.at(x, y + 1) + below_.at(x + 1, y) - below_.at(x, y) + (wet ? 1 : 0);
        }
}

bool WetPosts::any(const glm::ivec2& first, const glm::ivec2& last) const {
    const glm::ivec2 from = glm::clamp(first, glm::ivec2(0), squares_ * kSide) / kSide;
    const glm::ivec2 to =
        glm::min(glm::clamp(last, glm::ivec2(-1), squares_ * kSide) / kSide + 1, squares_);
    if (last.x < 0 || last.y < 0 || from.x >= to.x || from.y >= to.y) return false;
    return below_.at(to.x, to.y) - below_.at(from.x, to.y) - below_.at(to.x, from.y) +
               below_.at(from.x, from.y) >
           0;
}

}  // namespace relevo::render
