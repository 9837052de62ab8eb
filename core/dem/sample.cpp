#include "dem/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>

#include "base/parallel_for.h"

namespace relevo::dem {
namespace {

/// A part of a line of posts that is read, and the means that it gives.
struct Span {
    int first_mean, means;
    int first_post, posts;
};

/// About every `stride`-th block of a line with the first and the last one, but at most one for
/// each mean.
/// @param posts  of the line, `means` times `reduction`
std::vector<Span> spans(int posts, int block, int reduction, int stride) {
    std::vector<Span> result;
    const int blocks = (posts - 1) / block + 1;
    int next_mean = 0;
    const int count = (blocks - 1) / stride + 1;
    for (int k = 0; k < count; ++k) {
        const std::int64_t index = std::int64_t{blocks - 1} * k / std::max(1, count - 1);
        const auto begin = static_cast<int>(index * block);
        const int end = std::min(posts, begin + block);
        const int first = (begin + reduction - 1) / reduction, last = end / reduction;
        Span span{first, last - first, first * reduction, (last - first) * reduction};
        if (last <= first) {  // a part of one mean
            const int mean = begin / reduction;
            span = {mean, 1, begin, std::min(end, (mean + 1) * reduction) - begin};
        }
        if (span.first_mean < next_mean) continue;
        next_mean = span.first_mean + span.means;
        result.push_back(span);
    }
    return result;
}

/// Interpolates between known values of a line, and continues the outermost ones.
/// @param known   indices that have a value, in ascending order
/// @param stride  from value to value
void fill_between(float* first, std::ptrdiff_t stride, int count, const std::vector<int>& known) {
    const auto at = [&](int index) -> float& { return first[index * stride]; };
    for (int i = 0; i < known.front(); ++i)
        at(i) = at(known.front());
    for (std::size_t k = 0; k + 1 < known.size(); ++k) {
        const int a = known[k], b = known[k + 1];
        for (int i = a + 1; i < b; ++i) {
            const float share = static_cast<float>(i - a) / static_cast<float>(b - a);
            // Next to a void the nearer of both decides.
            at(i) = std::isnan(at(a)) || std::isnan(at(b)) ? at(share < 0.5f ? a : b)
                                                           : at(a) + share * (at(b) - at(a));
        }
    }
    for (int i = known.back() + 1; i < count; ++i)
        at(i) = at(known.back());
}

std::vector<int> indices_of(const std::vector<Span>& spans) {
    std::vector<int> indices;
    for (const Span& span : spans)
        for (int i = 0; i < span.means; ++i)
            indices.push_back(span.first_mean + i);
    return indices;
}

}  // namespace

Array2d<float> sample_means(const Source& source, int reduction, std::int64_t most_cells) {
    const int columns = source.grid().columns() / reduction,
              rows = source.grid().rows() / reduction;
    const glm::ivec2 block = source.block_size();
    const bool tiled = 2 * block.x < source.grid().columns();
    // One block for each mean at most; of these as many as the budget allows.
    const glm::ivec2 one = glm::max(reduction / block, 1);
    const double cells =
        double(source.grid().columns()) * source.grid().rows() / one.y / (tiled ? one.x : 1);
    const double excess = cells / static_cast<double>(most_cells);
    const int times = std::max(1, static_cast<int>(std::ceil(tiled ? std::sqrt(excess) : excess)));
    const std::vector<Span> down = spans(rows * reduction, block.y, reduction, one.y * times);
    const std::vector<Span> across =
        tiled ? spans(columns * reduction, block.x, reduction, one.x * times)
              : std::vector<Span>{{0, columns, 0, columns * reduction}};
    Array2d<float> means(columns, rows, std::numeric_limits<float>::quiet_NaN());
    const auto count = static_cast<int>(down.size() * across.size());
    parallel_for(0, count, 1, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const Span& row = down[static_cast<std::size_t>(i) / across.size()];
            const Span& column = across[static_cast<std::size_t>(i) % across.size()];
            const Array2d<float> read =
                source.read({column.first_post, row.first_post, column.posts, row.posts},
                            column.means, row.means);
            for (int y = 0; y < row.means; ++y)
                std::ranges::copy(read.row(y), &means.at(column.first_mean, row.first_mean + y));
        }
    });
    const std::vector<int> known_rows = indices_of(down), known_columns = indices_of(across);
    for (const int row : known_rows)
        fill_between(&means.at(0, row), 1, columns, known_columns);
    parallel_for(0, columns, 16, [&](int begin, int end) {
        for (int column = begin; column < end; ++column)
            fill_between(&means.at(column, 0), means.width(), rows, known_rows);
    });
    return means;
}

}  // namespace relevo::dem
