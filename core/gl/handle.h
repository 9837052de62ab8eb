#pragma once

#include <utility>

namespace relevo::gl {

/// A GL object name owned by one place: move-only, deleted when it goes.
/// The context it was made in must be current when it is destroyed.
template <void (*Delete)(unsigned)>
class Handle {
  public:
    Handle() = default;
    explicit Handle(unsigned name) : name_(name) {}
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (name_) Delete(name_);
    }

    /// The GL name; 0 after a move.
    unsigned name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

  private:
    unsigned name_ = 0;
};

}  // namespace relevo::gl
