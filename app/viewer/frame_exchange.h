#pragma once

#include <memory>

#include "viewer/picture.h"

namespace relevo::viewer {

/// Pool of frames that a scene's thread draws and the window displays. A frame is reused when no
/// Picture refers to it.
class FrameExchange {
  public:
    FrameExchange();

    /// A free frame. On the device, later writes wait until the window has displayed its previous
    /// contents.
    std::shared_ptr<SharedFrame> take(gl::Extent extent);

  private:
    struct Pool;
    std::shared_ptr<Pool> pool_;
};

}  // namespace relevo::viewer
