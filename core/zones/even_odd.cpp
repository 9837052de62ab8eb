#include "zones/even_odd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace relevo::zones {
namespace {

/// Edges by the bands of y that they reach into, so that only neighbours are compared.
class Bands {
  public:
    explicit Bands(const std::vector<Edge>& edges) {
        double high = -1e300;
        for (const Edge& edge : edges) {
            low_ = std::min(low_, edge.low.y);
            high = std::max(high, edge.high.y);
        }
        const std::size_t count = std::max<std::size_t>(edges.size() / 4, 1);
        bands_.resize(count);
        per_y_ = static_cast<double>(count) / std::max(high - low_, 1e-300);
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (std::size_t band = at(edges[i].low.y); band <= at(edges[i].high.y); ++band)
                bands_[band].push_back(i);
    }
    std::size_t at(double y) const {
        const double band = std::floor((y - low_) * per_y_);
        return static_cast<std::size_t>(
            std::clamp(band, 0.0, static_cast<double>(bands_.size() - 1)));
    }
    const std::vector<std::size_t>& operator[](std::size_t band) const { return bands_[band]; }
    std::size_t size() const { return bands_.size(); }

  private:
    double low_ = 1e300, per_y_ = 0;
    std::vector<std::vector<std::size_t>> bands_;
};

double x_at(const Edge& edge, double y) {
    const double share = (y - edge.low.y) / (edge.high.y - edge.low.y);
    return edge.low.x + share * (edge.high.x - edge.low.x);
}

double side_of(const Edge& edge, const glm::dvec2& point) {
    const glm::dvec2 along = edge.high - edge.low, to = point - edge.low;
    return along.x * to.y - along.y * to.x;
}

/// Heights at which an edge has to be cut because another one meets it between its ends.
void add_cuts(const Edge& edge, const Edge& other, std::vector<double>& cuts) {
    const auto cut = [&](double y) {
        if (y > edge.low.y && y < edge.high.y) cuts.push_back(y);
    };
    const double low = side_of(edge, other.low), high = side_of(edge, other.high);
    if (low == 0) cut(other.low.y);
    if (high == 0) cut(other.high.y);
    if ((low < 0) == (high < 0) || low == 0 || high == 0) return;
    const double share = low / (low - high);
    cut(other.low.y + share * (other.high.y - other.low.y));
}

/// Cuts edges where they meet, and leaves level ones out: what is enclosed may change its side
/// there.
std::vector<Edge> cut_where_they_meet(const std::vector<Edge>& edges) {
    const Bands bands(edges);
    std::vector<std::vector<double>> cuts(edges.size());
    for (std::size_t band = 0; band < bands.size(); ++band)
        for (const std::size_t i : bands[band])
            for (const std::size_t j : bands[band]) {
                const Edge &a = edges[i], &b = edges[j];
                const double lower_y = std::max(a.low.y, b.low.y);
                if (i == j || a.low.y == a.high.y || lower_y > std::min(a.high.y, b.high.y) ||
                    bands.at(lower_y) != band ||  // each pair once
                    std::max(a.low.x, a.high.x) < std::min(b.low.x, b.high.x) ||
                    std::max(b.low.x, b.high.x) < std::min(a.low.x, a.high.x))
                    continue;
                add_cuts(a, b, cuts[i]);
            }
    std::vector<Edge> pieces;
    pieces.reserve(edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].low.y == edges[i].high.y) continue;
        std::ranges::sort(cuts[i]);
        glm::dvec2 from = edges[i].low;
        for (const double y : cuts[i]) {
            if (y <= from.y) continue;
            const glm::dvec2 to(x_at(edges[i], y), y);
            pieces.push_back({from, to});
            from = to;
        }
        if (edges[i].high.y > from.y) pieces.push_back({from, edges[i].high});
    }
    return pieces;
}

/// Says of each edge whether what is enclosed lies behind it: an even number of others is before it
/// in its row.
void find_sides(std::vector<Edge>& edges) {
    const Bands bands(edges);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double y = 0.5 * (edges[i].low.y + edges[i].high.y), x = x_at(edges[i], y);
        bool even = true;
        for (const std::size_t j : bands[bands.at(y)]) {
            const Edge& other = edges[j];
            if (i == j || y < other.low.y || y >= other.high.y) continue;
            const double at = x_at(other, y);
            if (at < x || (at == x && j < i)) even = !even;  // two upon each other: one of each
        }
        edges[i].enters = even;
    }
}

}  // namespace

std::vector<Edge> even_odd_edges(std::span<const Ring> rings) {
    std::vector<Edge> edges;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
            if (a != b) edges.push_back(a.y < b.y ? Edge{a, b} : Edge{b, a});
        }
    if (edges.empty()) return edges;
    edges = cut_where_they_meet(edges);
    find_sides(edges);
    return edges;
}

double area(std::span<const Edge> edges) {
    if (edges.empty()) return 0;
    const double from = edges.front().low.x;  // near: nothing is lost to rounding
    double sum = 0;
    for (const Edge& edge : edges) {
        const double width = 0.5 * (edge.low.x + edge.high.x) - from;
        sum += (edge.enters ? -width : width) * (edge.high.y - edge.low.y);
    }
    return sum;
}

}  // namespace relevo::zones
