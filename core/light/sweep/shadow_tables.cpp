#include "light/sweep/shadow_tables.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace relevo::light {

static_assert(std::is_trivially_copyable_v<ShadowTables::Row>);
static_assert(sizeof(ShadowTables::Row) == 18 * 4 && sizeof(ShadowTables::Crossing) == 4 * 4);

namespace {

/// Adds crossings that SweepLines has found for rows of ground of so many numbers.
void add(const SweepLines& lines, int pitch, std::span<const Crossing> found,
         std::vector<ShadowTables::Crossing>& to) {
    for (const Crossing& at : found) {
        const int row = at.p / pitch, column = at.p % pitch + lines.row(row).ground_column;
        const ShadowTables::Crossing::Next next = at.q == at.p ? ShadowTables::Crossing::kOnPost
                                                  : at.q / pitch == row
                                                      ? ShadowTables::Crossing::kInRow
                                                      : ShadowTables::Crossing::kInColumn;
        to.push_back({row - lines.begin(), column, next, at.weight});
    }
}

}  // namespace

void ShadowTables::fill(SweepLines& from, const SheetPosts& posts, float lowest_m) {
    first_row = from.begin();
    lines = from.lines();
    height_origin_m = ShadowStrip::height_origin_m(lowest_m);
    const int pitch = from.ground_columns() + 1;  // all rows are kept
    from.find_crossings(pitch, std::numeric_limits<int>::max());
    rows.reserve(static_cast<std::size_t>(from.end() - from.begin() + 1));
    for (int row = from.begin(); row < from.end(); ++row) {
        const SweepLines::Row& at = from.row(row);
        const double origin_m = ShadowStrip::fall_origin_m(from, row);
        Row& to = rows.emplace_back();
        to.fall_m = static_cast<float>(at.fall_m - origin_m);
        to.fall_per_line_m = static_cast<float>(at.fall_per_line_m);
        to.post_offset = at.post_offset;
        to.fall_origin =
            static_cast<std::int32_t>(std::lround(origin_m / ShadowStrip::kFallOrigins_m));
        to.column = at.column;
        to.lines = at.lines;
        if (row >= posts.window.row) to.posts = posts.at(row);
        to.far_lines = lines_with_far_ground(from, row, columns);
        for (int set = 0; set < ShadowStrip::kSampling.line_sets; ++set) {
            const auto k = static_cast<std::size_t>(set);
            to.edge_lines[k] = light::edge_lines(from, set, row, columns);
            to.crossings[k] = static_cast<std::int32_t>(crossings.size());
            add(from, pitch, from.of_lines(set, row), crossings);
        }
        to.crossings.back() = static_cast<std::int32_t>(crossings.size());
        add(from, pitch, from.of_posts(row), crossings);
    }
    rows.emplace_back().crossings.fill(static_cast<std::int32_t>(crossings.size()));
}

}  // namespace relevo::light
