#pragma once

#include <memory>

#include "viewer/picture.h"

namespace relevo::viewer {

/// Frames that a scene's thread draws and the window shows. One is used again when all pictures of
/// it are gone: the window's, and those that it has not fetched.
class FrameExchange {
  public:
    FrameExchange();

    /// A frame that nobody has. What is written to it next waits, on the device, until the window
    /// has shown what it had before.
    std::shared_ptr<SharedFrame> take(gl::Extent extent);

  private:
    struct Pool;
    std::shared_ptr<Pool> pool_;
};

}  // namespace relevo::viewer
