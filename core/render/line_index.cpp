#include "render/line_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/line_pieces.h"

namespace relevo::render {
namespace {

constexpr std::size_t kExact = 16;  // segments of the file in a cell that needs no finer ones
constexpr std::size_t kMostInCell = 1023;  // shaders/lib/lines.glsl loops over so many
constexpr double kTolerance = 1.0 / 2048;  // of a cell's side
constexpr double kFinest_m = 2;            // side of the finest cells
constexpr double kWidest_m = 2000;  // side of cells without finer ones: floats hold 0.2 mm there
constexpr int kTableSide = 256;
constexpr std::size_t kNodeTexels = 4;

using Cell = glm::i64vec2;

/// Cells of one level, by place.
struct Table {
    Cell first{0};
    glm::i64vec2 size{0};
    std::vector<std::uint32_t> nodes{};

    std::uint32_t* at(const Cell& cell) {
        const Cell in = cell - first;
        if (in.x < 0 || in.y < 0 || in.x >= size.x || in.y >= size.y) return nullptr;
        return &nodes[static_cast<std::size_t>(in.y * size.x + in.x)];
    }
};

class Builder {
  public:
    Builder(const LinePieces& pieces, const LineIndexOptions& options, double least_m,
            int finest_level)
        : pieces_(pieces), options_(options), least_m_(least_m), finest_level_(finest_level) {
        while (side(top_) < 2.0 * std::max(options.size_posts.x, options.size_posts.y))
            ++top_;
        base_ = top_;
        for (int level = top_; tables_.empty() || fits(level); --level) {
            tables_.push_back(table(level));
            base_ = level;
        }
    }

    /// @returns false if there are too many texels
    bool run(std::size_t features) {
        const std::size_t head = 1 + 2 * tables_.size();
        std::size_t cells = 0;
        for (const Table& table : tables_)
            cells += table.nodes.size();
        lines_ = head + cells;
        texels_.resize(lines_ + features, glm::vec4(0));
        Table& top = tables_.front();
        for (std::int64_t y = 0; y < top.size.y; ++y)
            for (std::int64_t x = 0; x < top.size.x; ++x)
                visit(top_, top.first + Cell(x, y), pieces_.all());
        if (overflows()) return false;
        write_head(head);
        return true;
    }

    void set_value(std::size_t number, float value) { texels_[lines_ + number].x = value; }
    LineIndex take() {
        return {std::move(texels_), coarsest_ * least_m_, side(finest_level_) * least_m_, dropped_};
    }

  private:
    static double side(int level) { return std::exp2(level); }
    bool overflows() const { return texels_.size() > options_.max_texels; }
    glm::dvec2 low(int level, const Cell& cell) const { return side(level) * glm::dvec2(cell); }

    bool fits(int level) const {
        const glm::dvec2 cells = (pieces_.high() - pieces_.low()) / side(level) + 3.0;
        return std::max(cells.x, cells.y) <= kTableSide && level > finest_level_;
    }

    Table table(int level) const {
        const double c = side(level);
        Table made;
        made.first = Cell(glm::floor(pieces_.low() / c - 0.5));
        made.size = Cell(glm::floor(pieces_.high() / c + 0.5)) - made.first + Cell(1);
        made.nodes.resize(static_cast<std::size_t>(made.size.x * made.size.y));
        return made;
    }

    /// Sets a cell of a table, and for a node without finer ones those that are finer.
    void note(int level, const Cell& cell, std::uint32_t node, bool leaf) {
        for (int finer = level; finer >= base_; --finer) {
            const int shift = level - finer;
            Table& table = tables_[static_cast<std::size_t>(top_ - finer)];
            const Cell from = glm::max(cell << Cell(shift), table.first),
                       to = glm::min((cell + Cell(1)) << Cell(shift), table.first + table.size);
            for (std::int64_t y = from.y; y < to.y; ++y)
                for (std::int64_t x = from.x; x < to.x; ++x)
                    *table.at({x, y}) = node;
            if (!leaf) return;
        }
    }

    /// Writes the node of a cell and all finer ones. @returns its address; 0 without lines
    std::uint32_t visit(int level, const Cell& cell, const std::vector<LinePart>& candidates) {
        if (overflows()) return 0;
        const double c = side(level), tolerance = kTolerance * c;
        const glm::dvec2 corner = low(level, cell);
        const LineBox near{corner - 0.5 * c, corner + 1.5 * c};
        if (const auto exact = pieces_.exact(candidates, near, kExact)) {
            if (exact->empty()) return 0;
            if (c * least_m_ <= kWidest_m) return write(level, cell, *exact, true);
            return write_with_finer(level, cell, *exact, *exact);
        }
        const LineBox wide{near.low - tolerance, near.high + tolerance};
        const std::vector<LinePart> parts = pieces_.refined(candidates, wide, tolerance);
        if (parts.empty()) return 0;
        const bool leaf = level <= finest_level_;
        const std::vector<LinePart> listed = longest(parts, near, leaf);
        if (!leaf) return write_with_finer(level, cell, listed, parts);
        coarsest_ = std::max(coarsest_, tolerance);
        return write(level, cell, listed, leaf);
    }

    /// Writes a node with the finer ones of all `parts`.
    std::uint32_t write_with_finer(int level, const Cell& cell, const std::vector<LinePart>& listed,
                                   const std::vector<LinePart>& parts) {
        const std::uint32_t node = write(level, cell, listed, false);
        for (int child = 0; child < 4; ++child) {
            const std::uint32_t finer =
                visit(level - 1, Cell(2) * cell + Cell(child & 1, child >> 1), parts);
            texels_[node + 3][child] = static_cast<float>(finer);
        }
        return node;
    }

    /// As many parts as a cell lists.
    std::vector<LinePart> longest(std::vector<LinePart> parts, const LineBox& in, bool leaf) {
        if (parts.size() <= kMostInCell) return parts;
        if (leaf) dropped_ += parts.size() - kMostInCell;
        const auto length_in = [&](const LinePart& part) {
            const glm::dvec2 a = pieces_.first(part), b = pieces_.last(part);
            const auto cut = clipped(a, b, in);
            return cut ? (cut->second - cut->first) * distance(a, b) : 0.0;
        };
        std::vector<std::pair<double, LinePart>> all;
        for (const LinePart& part : parts)
            all.emplace_back(length_in(part), part);
        std::ranges::nth_element(all, all.begin() + kMostInCell,
                                 [](const auto& a, const auto& b) { return a.first > b.first; });
        parts.clear();
        for (std::size_t i = 0; i < kMostInCell; ++i)
            parts.push_back(all[i].second);
        return parts;
    }

    glm::vec4 whole_and_rest(int level, const Cell& cell) const {
        const glm::dvec2 corner = low(level, cell), whole = glm::floor(corner);
        return glm::vec4(whole, corner - whole);
    }

    std::uint32_t write(int level, const Cell& cell, const std::vector<LinePart>& parts,
                        bool leaf) {
        const double c = side(level);
        const glm::dvec2 corner = low(level, cell);
        const LineBox near{corner - 0.5 * c, corner + 1.5 * c};
        const auto node = static_cast<std::uint32_t>(texels_.size());
        texels_.resize(node + kNodeTexels);
        std::vector<glm::vec2> along;
        for (const LinePart& part : parts) {
            const glm::dvec2 a = pieces_.first(part), b = pieces_.last(part);
            const auto cut = clipped(a, b, near);
            if (!cut) continue;  // within the tolerance alone
            texels_.emplace_back(glm::mix(a, b, cut->first) - corner,
                                 glm::mix(a, b, cut->second) - corner);
            along.emplace_back(pieces_.along_m(part, cut->first), pieces_.number(part));
        }
        texels_[node] = {along.size(), leaf, level, 0};
        texels_[node + 1] = whole_and_rest(level, cell);
        const glm::dvec2 last(options_.size_posts - 1);
        const glm::dmat2 metres =
            options_.metres_per_post(glm::clamp(corner + 0.5 * c, glm::dvec2(0), last));
        texels_[node + 2] = {metres[0], metres[1]};
        along.resize(along.size() + along.size() % 2);
        for (std::size_t i = 0; i < along.size(); i += 2)
            texels_.emplace_back(along[i], along[i + 1]);
        note(level, cell, node, leaf);
        return node;
    }

    void write_head(std::size_t address) {
        texels_[0] = {top_, base_, least_m_, lines_};
        for (std::size_t i = 0; i < tables_.size(); ++i) {
            const Table& table = tables_[i];
            texels_[1 + 2 * i] = whole_and_rest(top_ - static_cast<int>(i), table.first);
            texels_[2 + 2 * i] = {table.size, address, 0};
            for (const std::uint32_t node : table.nodes)
                texels_[address++].x = static_cast<float>(node);
        }
    }

    const LinePieces& pieces_;
    const LineIndexOptions& options_;
    double least_m_;
    int finest_level_;
    int top_ = 0, base_ = 0;
    std::vector<Table> tables_;  // from top_ to base_
    std::vector<glm::vec4> texels_;
    std::size_t lines_ = 0;
    double coarsest_ = 0;  // greatest tolerance of a node without finer ones [posts]
    std::size_t dropped_ = 0;
};

/// Least ground metres of a post along any direction, over the lines. Near a pole posts have no
/// width: reaches are shorter there.
double least_metres(const LinePieces& pieces, const LineIndexOptions& options) {
    constexpr int kSamples = 8;
    constexpr double kLeast = 1.0 / 16;  // of the greatest
    double least = 1e30, greatest = 0;
    const glm::dvec2 last(options.size_posts - 1);
    for (int j = 0; j <= kSamples; ++j)
        for (int i = 0; i <= kSamples; ++i) {
            const glm::dvec2 post =
                glm::mix(pieces.low(), pieces.high(), glm::dvec2(i, j) / double{kSamples});
            const glm::dmat2 metres =
                options.metres_per_post(glm::clamp(post, glm::dvec2(0), last));
            const double along = length(metres[0]), down = length(metres[1]);
            const double apart = std::abs(determinant(metres)) / std::max({along, down, 1e-9});
            if (!std::isfinite(apart)) continue;
            least = std::min(least, apart);
            greatest = std::max({greatest, along, down});
        }
    return greatest > 0 ? std::max(least, kLeast * greatest) : 1;
}

/// Level of the finest cells with which an index may have room.
int first_try(const LinePieces& pieces, const LineIndexOptions& options, double least_m) {
    constexpr double kTexels = 6;   // of a segment in several cells, about
    constexpr double kInCell = 64;  // segments of a cell that is too coarse to be exact
    const auto finest = static_cast<int>(std::ceil(std::log2(kFinest_m / least_m)));
    const double segments = static_cast<double>(pieces.segments());
    if (kTexels * segments < static_cast<double>(options.max_texels)) return finest;
    const glm::dvec2 extent = glm::max(pieces.high() - pieces.low(), glm::dvec2(1e-3));
    const double side = 0.5 * std::sqrt(kInCell * extent.x * extent.y / segments);
    return std::max(finest, static_cast<int>(std::floor(std::log2(side))));
}

}  // namespace

LineIndex make_line_index(const std::vector<dem::PlacedLine>& lines,
                          const LineIndexOptions& options) {
    const LinePieces pieces(lines, options.size_posts);
    if (pieces.all().empty()) return {{glm::vec4(-1, 0, 1, 0)}};
    const double least_m = least_metres(pieces, options);
    std::size_t features = 0;
    for (const dem::PlacedLine& line : lines)
        features = std::max(features, static_cast<std::size_t>(line.number) + 1);
    for (int finest = first_try(pieces, options, least_m);; ++finest) {
        Builder builder(pieces, options, least_m, finest);
        if (!builder.run(features)) continue;
        for (const dem::PlacedLine& line : lines)
            builder.set_value(
                static_cast<std::size_t>(line.number),
                std::isfinite(line.value) ? static_cast<float>(line.value) : kNoLineValue);
        return builder.take();
    }
}

}  // namespace relevo::render
