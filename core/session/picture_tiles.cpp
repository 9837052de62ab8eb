#include "session/picture_tiles.h"

#include <algorithm>
#include <cassert>

#include <glm/common.hpp>

namespace relevo::session {
namespace {

/// Begins of tiles along an axis, and the end.
std::vector<int> cuts(int length_px, int side_px) {
    std::vector<int> at;
    for (int begin = 0; begin < length_px; begin += side_px)
        at.push_back(begin);
    at.push_back(length_px);
    return at;
}

/// The bits of a whole number mirrored at the point, base 2.
double radical_inverse(int number) {
    double inverse = 0;
    for (double digit = 0.5; number > 0; number /= 2, digit /= 2)
        inverse += digit * (number % 2);
    return inverse;
}

}  // namespace

std::vector<PictureTile> tiles_of(const glm::ivec2& picture_px, int side_px, int margin_px) {
    assert(side_px % kTileStep_px == 0 && margin_px % kTileStep_px == 0);
    const std::vector<int> columns = cuts(picture_px.x, side_px);
    const std::vector<int> rows = cuts(picture_px.y, side_px);
    std::vector<PictureTile> tiles;
    for (std::size_t y = rows.size() - 1; y-- > 0;)
        for (std::size_t x = 0; x + 1 < columns.size(); ++x) {
            const glm::ivec2 low(columns[x], rows[y]), high(columns[x + 1], rows[y + 1]);
            const glm::ivec2 frame_low = glm::max(low - margin_px, glm::ivec2(0));
            const glm::ivec2 frame_high = glm::min(high + margin_px, picture_px);
            tiles.push_back({{low, high - low}, {frame_low, frame_high - frame_low}});
        }
    return tiles;
}

std::vector<glm::dvec2> sample_offsets(int samples) {
    std::vector<glm::dvec2> offsets;
    glm::dvec2 mean(0);
    for (int i = 0; i < samples; ++i) {
        offsets.emplace_back((i + 0.5) / samples, radical_inverse(i));
        mean += offsets.back() / double(samples);
    }
    for (glm::dvec2& offset : offsets)
        offset -= mean;
    return offsets;
}

}  // namespace relevo::session
