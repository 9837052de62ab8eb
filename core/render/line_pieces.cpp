#include "render/line_pieces.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace relevo::render {
namespace {

/// Around a DEM, in posts.
constexpr double kMargin = 64;
/// Vertices that are simplified together: the time grows with their square at worst.
constexpr std::uint32_t kTogether = 1024;

double distance_to(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 along = b - a;
    const double squared = dot(along, along);
    const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
    return distance(p, a + t * along);
}

}  // namespace

std::optional<std::pair<double, double>> clipped(const glm::dvec2& a, const glm::dvec2& b,
                                                 const LineBox& box) {
    // Most segments are outside.
    if (std::max(a.x, b.x) < box.low.x || std::min(a.x, b.x) > box.high.x ||
        std::max(a.y, b.y) < box.low.y || std::min(a.y, b.y) > box.high.y)
        return std::nullopt;
    double from = 0, to = 1;
    for (int i = 0; i < 2; ++i) {
        const double step = b[i] - a[i];
        if (step == 0) continue;
        const double at_low = (box.low[i] - a[i]) / step, at_high = (box.high[i] - a[i]) / step;
        from = std::max(from, std::min(at_low, at_high));
        to = std::min(to, std::max(at_low, at_high));
    }
    if (from > to) return std::nullopt;
    return std::pair(from, to);
}

LinePieces::LinePieces(const std::vector<dem::PlacedLine>& lines, const glm::ivec2& size_posts)
    : lines_(lines) {
    const LineBox near{glm::dvec2(-kMargin), glm::dvec2(size_posts - 1) + kMargin};
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
        const std::vector<glm::dvec2>& posts = lines[i].posts;
        const auto count = static_cast<std::uint32_t>(posts.size());
        std::uint32_t begin = 0;
        for (std::uint32_t k = 0; k + 1 < count; ++k) {
            if (clipped(posts[k], posts[k + 1], near)) continue;
            if (k > begin) add(i, begin, k - begin + 1);
            begin = k + 1;
        }
        if (count > begin + 1) add(i, begin, count - begin);
    }
    // Segments may begin far away.
    low_ = glm::max(low_, near.low);
    high_ = glm::min(high_, near.high);
}

void LinePieces::add(std::uint32_t line, std::uint32_t first, std::uint32_t count) {
    const Piece piece{line, first, count, importance_.size()};
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec2& post = lines_[line].posts[first + i];
        low_ = glm::min(low_, post);
        high_ = glm::max(high_, post);
    }
    all_.push_back({static_cast<std::uint32_t>(pieces_.size()), 0, count - 1});
    pieces_.push_back(piece);
    importance_.resize(importance_.size() + count);
    rate(piece);
}

void LinePieces::rate(const Piece& piece) {
    for (std::uint32_t first = 0; first + 1 < piece.count; first += kTogether) {
        const std::uint32_t last = std::min(first + kTogether, piece.count - 1);
        importance_[piece.importance + first] = std::numeric_limits<float>::max();
        rate(piece, first, last);
    }
}

/// Rates the vertices between two by the distance at which Douglas and Peucker drop them, no more
/// than those around them.
void LinePieces::rate(const Piece& piece, std::uint32_t first, std::uint32_t last) {
    struct Span {
        std::uint32_t first, last;
        float most;
    };
    const std::vector<glm::dvec2>& posts = lines_[piece.line].posts;
    std::vector<Span> spans{{first, last, std::numeric_limits<float>::max()}};
    while (!spans.empty()) {
        const Span span = spans.back();
        spans.pop_back();
        if (span.last - span.first < 2) continue;
        std::uint32_t farthest = span.first + 1;
        double far = -1;
        for (std::uint32_t i = span.first + 1; i < span.last; ++i) {
            const double away = distance_to(posts[piece.first + i], posts[piece.first + span.first],
                                            posts[piece.first + span.last]);
            if (away > far) {
                far = away;
                farthest = i;
            }
        }
        const float rating = std::min(span.most, static_cast<float>(far));
        importance_[piece.importance + farthest] = rating;
        spans.push_back({span.first, farthest, rating});
        spans.push_back({farthest, span.last, rating});
    }
}

double LinePieces::along_m(const LinePart& part, double fraction) const {
    const std::vector<double>& along_m = line(part).along_m;
    const std::uint32_t begin = pieces_[part.piece].first;
    return glm::mix(along_m[begin + part.first], along_m[begin + part.last], fraction);
}

std::optional<std::vector<LinePart>> LinePieces::exact(const std::vector<LinePart>& parts,
                                                       const LineBox& box, std::size_t most) const {
    // Most parts of a cell with so many vertices have more than `most` in it.
    constexpr std::size_t kTried = 16;
    std::size_t count = 0;
    for (const LinePart& part : parts) {
        count += part.last - part.first;
        if (count > kTried * most) return std::nullopt;
    }
    std::vector<LinePart> found;
    for (const LinePart& part : parts)
        for (std::uint32_t i = part.first; i < part.last; ++i) {
            if (!clipped(vertex(part.piece, i), vertex(part.piece, i + 1), box)) continue;
            if (found.size() == most) return std::nullopt;
            found.push_back({part.piece, i, i + 1});
        }
    return found;
}

std::vector<LinePart> LinePieces::refined(const std::vector<LinePart>& parts, const LineBox& box,
                                          double tolerance) const {
    std::vector<LinePart> finer;
    for (const LinePart& part : parts) {
        const std::size_t importance = pieces_[part.piece].importance;
        std::uint32_t begin = part.first;
        for (std::uint32_t i = part.first + 1; i <= part.last; ++i) {
            if (i < part.last && importance_[importance + i] <= tolerance) continue;
            if (clipped(vertex(part.piece, begin), vertex(part.piece, i), box))
                finer.push_back({part.piece, begin, i});
            begin = i;
        }
    }
    return finer;
}

}  // namespace relevo::render
