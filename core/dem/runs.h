#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relevo::dem {

/// Posts beside each other in a row.
struct Run {
    int row, first, last;
    int parent;  // run of the same component, itself for the first of them
};

/// Runs of posts, joined where they touch those of the row before.
class Runs {
  public:
    explicit Runs(int rows) { first_of_row_.reserve(static_cast<std::size_t>(rows) + 1); }

    void begin_row() { first_of_row_.push_back(static_cast<int>(runs_.size())); }

    /// @param joins  whether a post of this run and the one above it belong together
    template <typename Joins>
    void add(int row, int first, int last, const Joins& joins) {
        const int here = static_cast<int>(runs_.size());
        runs_.push_back({row, first, last, here});
        if (first_of_row_.size() < 2) return;
        const int end = first_of_row_.back();
        cursor_ = std::max(cursor_, first_of_row_[first_of_row_.size() - 2]);
        while (cursor_ < end && runs_[static_cast<std::size_t>(cursor_)].last < first)
            ++cursor_;
        for (int i = cursor_; i < end && runs_[static_cast<std::size_t>(i)].first <= last; ++i) {
            const int column = std::max(first, runs_[static_cast<std::size_t>(i)].first);
            if (joins(column)) join(i, here);
        }
    }

    int root(int i) {
        while (at(i).parent != i)
            i = at(i).parent = at(at(i).parent).parent;
        return i;
    }
    int size() const { return static_cast<int>(runs_.size()); }
    Run& at(int i) { return runs_[static_cast<std::size_t>(i)]; }

  private:
    void join(int a, int b) {
        a = root(a);
        b = root(b);
        at(std::max(a, b)).parent = std::min(a, b);
    }

    std::vector<Run> runs_;
    std::vector<int> first_of_row_;
    int cursor_ = 0;  // the first run above that may touch the next one
};

}  // namespace relevo::dem
