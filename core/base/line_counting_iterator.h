#pragma once

#include <concepts>
#include <cstddef>
#include <iterator>

namespace relevo {

/// Characters of a text for a parser. Counts the lines that the parser has passed, so that errors
/// can name theirs.
template <std::integral Line>
class LineCountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    /// @param line  is raised by one at each end of a line
    LineCountingIterator(const char* at, Line* line) : at_(at), line_(line) {}

    reference operator*() const { return *at_; }
    LineCountingIterator& operator++() {
        if (*at_++ == '\n') ++*line_;
        return *this;
    }
    LineCountingIterator operator++(int) {
        LineCountingIterator before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const LineCountingIterator& a, const LineCountingIterator& b) {
        return a.at_ == b.at_;
    }

  private:
    const char* at_;
    Line* line_;
};

}  // namespace relevo
