#pragma once

#include "viewer/state.h"
#include "viewer/window.h"

namespace relevo::viewer {

/// Keeps the window's style and fonts those of the settings and of the texts that panels show.
class WindowStyle {
  public:
    /// @param window  outlives this
    WindowStyle(Window& window, const Settings& settings);
    /// Loads fonts, so that it may only be called between frames.
    /// @returns whether the style changed
    bool update(const State& state);

  private:
    bool needs_glyphs(const State& state);

    Window& window_;
    Settings applied_;
    const EffectsModel* effects_ = nullptr;  // whose glyphs are loaded
};

}  // namespace relevo::viewer
