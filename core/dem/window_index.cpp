#include "dem/window_index.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relevo::dem {
namespace {

constexpr double kMostBuckets = 1 << 20;
constexpr int kLarge = 64;  // buckets

/// The window around both.
Window around(const Window& a, const Window& b) {
    const int column = std::min(a.column, b.column), row = std::min(a.row, b.row);
    return {column, row, std::max(a.end_column(), b.end_column()) - column,
            std::max(a.end_row(), b.end_row()) - row};
}

/// A side of square buckets, in posts, of which there are about as many as windows.
int side_of(const Window& all, std::size_t windows) {
    const double posts = double(all.columns) * all.rows;
    const double buckets = std::clamp(double(windows), 1.0, kMostBuckets);
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(posts / buckets))));
}

}  // namespace

WindowIndex::WindowIndex(const std::vector<Window>& windows) : windows_(windows) {
    if (windows_.empty()) return;
    all_ = windows_.front();
    for (const Window& window : windows_)
        all_ = around(all_, window);
    bucket_columns_ = bucket_rows_ = side_of(all_, windows_.size());
    across_ = (all_.columns - 1) / bucket_columns_ + 1;
    down_ = (all_.rows - 1) / bucket_rows_ + 1;
    begins_.assign(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_) + 1, 0);
    const auto each_bucket = [&](const Window& window, const auto& body) {
        const Buckets b = buckets_of(window);
        for (int row = b.first_row; row < b.end_row; ++row)
            for (int column = b.first_column; column < b.end_column; ++column)
                body(static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
                     static_cast<std::size_t>(column));
    };
    const auto is_large = [&](const Window& window) {
        const Buckets b = buckets_of(window);
        return (b.end_column - b.first_column) * (b.end_row - b.first_row) > kLarge;
    };
    for (std::size_t i = 0; i < windows_.size(); ++i)
        if (is_large(windows_[i]))
            large_.push_back(static_cast<int>(i));
        else
            each_bucket(windows_[i], [&](std::size_t bucket) { ++begins_[bucket + 1]; });
    for (std::size_t bucket = 1; bucket < begins_.size(); ++bucket)
        begins_[bucket] += begins_[bucket - 1];
    members_.resize(begins_.back());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < windows_.size(); ++i)
        if (!is_large(windows_[i]))
            each_bucket(windows_[i], [&](std::size_t bucket) {
                members_[next[bucket]++] = static_cast<int>(i);
            });
}

WindowIndex::Buckets WindowIndex::buckets_of(const Window& window) const {
    const Window inside = common(window, all_);
    if (inside.is_empty()) return {0, 0, 0, 0};
    return {(inside.column - all_.column) / bucket_columns_,
            (inside.end_column() - 1 - all_.column) / bucket_columns_ + 1,
            (inside.row - all_.row) / bucket_rows_,
            (inside.end_row() - 1 - all_.row) / bucket_rows_ + 1};
}

std::vector<int> WindowIndex::within(const Window& window) const {
    std::vector<int> found;
    const auto add = [&](int number) {
        if (!common(windows_[static_cast<std::size_t>(number)], window).is_empty())
            found.push_back(number);
    };
    for (const int number : large_)
        add(number);
    const Buckets b = buckets_of(window);
    for (int row = b.first_row; row < b.end_row; ++row) {
        // The buckets of a row follow each other.
        const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(across_);
        const std::size_t begin = begins_[first + static_cast<std::size_t>(b.first_column)];
        const std::size_t end = begins_[first + static_cast<std::size_t>(b.end_column)];
        for (std::size_t i = begin; i < end; ++i)
            add(members_[i]);
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace relevo::dem
