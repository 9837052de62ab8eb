#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "viewer/picture.h"

namespace relevo::viewer {

/// Frames of a scene that the window has not fetched: the newest finished one, and those that the
/// device is drawing. One thread adds frames, another takes them.
class PictureQueue {
  public:
    void add(std::shared_ptr<const Picture> picture);
    /// Waits until the device has drawn frames, and drops those that newer ones replace.
    /// @param unfinished  at most so many of the newest may be unfinished then
    /// @param gives_up    asked now and then; true ends the wait
    void finish(std::size_t unfinished, const std::function<bool()>& gives_up);
    /// The newest frame that the device has finished, if its number is greater than `number`. If
    /// frames are shared, call it with the window's context current.
    std::shared_ptr<const Picture> newer_than(std::uint64_t number) const;
    void clear();

  private:
    mutable std::mutex mutex_;
    std::deque<std::shared_ptr<const Picture>> pictures_;
};

}  // namespace relevo::viewer
