#include "viewer/layout.h"

#include <algorithm>
#include <cmath>

namespace relevo::viewer {
namespace {

/// Heights of the menu, the time bar, and the row of status line and scale below the film panel, of
/// the texts' height.
constexpr float kMenu = 1.375f, kBar = 2.75f, kStatus = 2;
/// A chart that nobody has made higher or lower, of the window's height.
constexpr float kChartsShare = 0.2f;

}  // namespace

scene::Insets Layout::insets(glm::vec2 window) const {
    scene::Insets insets;
    insets.left = picture.at.x / window.x;
    insets.right = 1 - picture.end().x / window.x;
    insets.top = picture.at.y / window.y;
    insets.bottom = 1 - (picture.end().y - below) / window.y;
    // A very low window has no room between the two.
    if (insets.top + insets.bottom > 0.75) insets.top = insets.bottom = 0;
    return insets;
}

Layout lay_out(glm::vec2 window, float unit, const Settings& settings, Lower lower) {
    Layout layout{.picture = {{0, 0}, window}};
    if (!settings.panels) return layout;
    const float text = unit * kUsualText_px;
    const float top = std::floor(kMenu * text);
    const float bar = lower == Lower::Film ? 0 : std::floor(kBar * text);
    const float low = std::max(top, window.y - bar);
    layout.bar = {{0, low}, {window.x, bar}};
    const float most = kMostPanelShare * window.x;
    layout.side = {{0, top},
                   {std::floor(std::clamp(unit * static_cast<float>(settings.panel_width),
                                          std::min(most, unit * kLeastPanel), most)),
                    low - top}};
    const float left = layout.side.end().x;
    float high = 0;
    if (lower == Lower::Charts) {
        const float wanted = settings.charts_height > 0
                                 ? unit * static_cast<float>(settings.charts_height)
                                 : kChartsShare * window.y;
        const float room = kMostChartsShare * (low - top);
        high = std::floor(std::clamp(wanted, std::min(room, unit * kLeastCharts), room));
    }
    layout.charts = {{left, low - high}, {window.x - left, high}};
    layout.picture = {{left, top}, {window.x - left, std::max(0.0f, low - high - top)}};
    if (lower == Lower::Film) layout.below = std::min(kStatus * text, layout.picture.size.y);
    return layout;
}

}  // namespace relevo::viewer
