#pragma once

#include "viewer/frame_pacing.h"
#include "viewer/hand.h"
#include "viewer/history.h"
#include "viewer/messages.h"
#include "viewer/opening.h"
#include "viewer/overlay_controller.h"
#include "viewer/point_query.h"
#include "viewer/state.h"
#include "viewer/window.h"

namespace relevo::viewer {

/// What commands act on: parts of the window, which outlive those that carry commands out.
struct Parts {
    Window& window;
    State& state;
    Hand& hand;
    History& history;
    Messages& messages;
    FramePacing& pacing;
    PointQuery& point;
    OverlayController& overlay;
    Opening& opening;
};

}  // namespace relevo::viewer
