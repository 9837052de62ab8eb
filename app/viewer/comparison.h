#pragma once

#include <memory>
#include <string>

#include "viewer/discard.h"
#include "viewer/messages.h"
#include "viewer/scene_thread.h"
#include "viewer/window.h"

namespace relevo::viewer {

/// A second image of the scene, with earlier effects, on the left of the window's dividing line.
class Comparison {
  public:
    Comparison(const SceneDevice& device, Window& window, Messages& messages, Discard& discard);

    /// @param opened   of `scene`; its DEM is not read again
    void start(const scene::Scene& scene, const Opened& opened, const Wanted& wanted);
    /// Follows the window, but for its effects. Requires thread().
    void want(Wanted wanted);
    void stop();
    /// The scene's thread; null: there is no comparison.
    SceneThread* thread() const { return thread_.get(); }
    /// The image of the window's left side; null: none yet.
    const std::shared_ptr<const Picture>& image() const { return image_; }
    /// Passes a new image to the window. Stops if the scene cannot be drawn.
    /// @returns whether there was a new image
    bool poll();

  private:
    SceneDevice device_;
    Window& window_;
    Messages& messages_;
    Discard& discard_;
    std::unique_ptr<SceneThread> thread_;
    scene::Effects effects_;
    int effects_read_ = 0;
    std::shared_ptr<const Picture> image_;
};

}  // namespace relevo::viewer
