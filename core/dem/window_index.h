#pragma once

#include <cstdint>
#include <vector>

#include "base/window.h"

namespace relevo::dem {

/// Finds those of many windows that a window meets: a grid of buckets, each with the numbers of the
/// windows that reach into it. Queries take time by what they find, not by how many there are.
class WindowIndex {
  public:
    WindowIndex() = default;
    explicit WindowIndex(const std::vector<Window>& windows);

    /// Numbers of the windows that have a post in common with another, ascending.
    std::vector<int> within(const Window& window) const;

  private:
    struct Buckets {
        int first_column, end_column, first_row, end_row;
    };
    Buckets buckets_of(const Window& window) const;

    std::vector<Window> windows_;
    Window all_;
    int bucket_columns_ = 1, bucket_rows_ = 1;  // posts in one
    int across_ = 0, down_ = 0;                 // buckets
    std::vector<std::uint32_t> begins_;         // of each bucket in members_, and the end of all
    std::vector<int> members_;
    std::vector<int> large_;  // windows over so many buckets that they are tested each time
};

}  // namespace relevo::dem
