#pragma once

#include <chrono>

namespace relevo::gl {

/// A place in the commands of a context that other contexts of its share group can wait for.
class Fence {
  public:
    Fence() = default;  ///< has passed
    /// Behind all commands of the current context so far. Flushes them.
    static Fence insert();
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;
    ~Fence();

    /// Whether the device has executed the commands.
    bool has_passed() const;
    /// Has the device execute no further command of the current context before.
    void wait_on_device() const;
    /// Has the calling thread wait. @returns has_passed()
    /// @throws DeviceLost
    bool wait(std::chrono::milliseconds at_most) const;

  private:
    void* sync_ = nullptr;
};

}  // namespace relevo::gl
