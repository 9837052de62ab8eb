#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace relevo {

/// A row-major grid of values that owns its storage. Row 0 is the first row of the file it came
/// from.
template <typename T>
class Array2d {
  public:
    Array2d() = default;
    Array2d(int width, int height, T value = T{})
        : width_(width),
          height_(height),
          values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {
        assert(width >= 0 && height >= 0);
    }

    int width() const { return width_; }    ///< columns
    int height() const { return height_; }  ///< rows
    bool empty() const { return values_.empty(); }
    std::size_t size() const { return values_.size(); }

    T& at(int column, int row) { return values_[index(column, row)]; }
    const T& at(int column, int row) const { return values_[index(column, row)]; }

    std::span<T> row(int r) { return {&values_[index(0, r)], static_cast<std::size_t>(width_)}; }
    std::span<const T> row(int r) const {
        return {&values_[index(0, r)], static_cast<std::size_t>(width_)};
    }

    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    auto begin() { return values_.begin(); }
    auto begin() const { return values_.begin(); }
    auto end() { return values_.end(); }
    auto end() const { return values_.end(); }

    friend bool operator==(const Array2d&, const Array2d&) = default;

  private:
    std::size_t index(int column, int row) const {
        assert(column >= 0 && column < width_ && row >= 0 && row < height_);
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(column);
    }

    int width_ = 0;
    int height_ = 0;
    std::vector<T> values_;
};

}  // namespace relevo
