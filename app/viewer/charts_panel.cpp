#include "viewer/charts_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "sun/position.h"
#include "viewer/image_texture.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr ImU32 kNow = IM_COL32(200, 40, 20, 255);
constexpr float kHeight_units = 300;

/// Height of the time bar, the status line and the scale.
float below_px(const State& state) {
    return state.bar_px + 3.4f * ImGui::GetFontSize();
}

/// Draws a chart unscaled. @returns its upper left corner in the window
ImVec2 show(const gl::Texture& texture) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const gl::Extent extent = texture.extent();
    ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name())),
                 {static_cast<float>(extent.width), static_cast<float>(extent.height)});
    return at;
}

ImVec2 at_screen(ImVec2 corner, glm::dvec2 units, double px_a_unit) {
    return {corner.x + static_cast<float>(units.x * px_a_unit),
            corner.y + static_cast<float>(units.y * px_a_unit)};
}

/// Window position of the chosen point [px], from the upper left.
std::optional<glm::vec2> chosen_in_window(const State& state, glm::vec2 size_px) {
    geo::Geodetic place = *state.chosen;
    place.height_m = state.land.aim_m(place) * state.land.exaggeration;
    const auto at = in_picture(camera_of(state.document.pose, state.land),
                               state.land.frame->to_local(place), double{size_px.x} / size_px.y);
    if (!at) return std::nullopt;
    return in_window(*at, size_px);
}

}  // namespace

template <typename Chart>
void ChartsPanel::Shown<Chart>::take(std::shared_ptr<const Chart> newer) {
    if (newer == chart) return;
    chart = std::move(newer);
    texture = chart ? texture_of(chart->picture) : gl::Texture();
}

/// With the sun's current position.
void ChartsPanel::horizon(State& state) {
    const double px_a_unit = state.point->of.px_a_unit;
    const ImVec2 corner = show(horizon_.texture);
    const chart::HorizonPanorama::Axes& axes = horizon_.chart->axes;
    const sun::Position position = sun::position(state.document.utc, state.point->of.place);
    const double elevation_rad = state.air.apparent_rad(position.elevation_rad);
    if (elevation_rad < axes.low_rad || elevation_rad > axes.high_rad) return;
    const ImVec2 at = at_screen(corner, axes.at(position.azimuth_rad, elevation_rad), px_a_unit);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled(at, 7, IM_COL32(255, 214, 90, 255));
    list.AddCircle(at, 7.5f, kNow, 0, 2);
}

/// Marks the displayed day and time. A click sets another time.
void ChartsPanel::year(State& state) {
    const double px_a_unit = state.point->of.px_a_unit;
    const ImVec2 corner = show(year_.texture);
    const bool hovered = ImGui::IsItemHovered();
    const chart::Rect& plot = year_.chart->plot;
    const sun::Zone& zone = state.document.zone;
    const DayMinute now = DayMinute::of(state.document.utc, zone);
    const int days = sun::days_between({now.date.year, 1, 1}, {now.date.year + 1, 1, 1});
    const double x = plot.x + plot.width * (day_of_year(now.date) + 0.5) / days;
    const double y = plot.y + plot.height * (1 - now.minute / 1440.0);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine(at_screen(corner, {x, plot.y}, px_a_unit),
                 at_screen(corner, {x, plot.y + plot.height}, px_a_unit), kNow, 1.5f);
    list.AddCircle(at_screen(corner, {x, y}, px_a_unit), 5, kNow, 0, 2);
    if (!hovered) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double across = ((mouse.x - corner.x) / px_a_unit - plot.x) / plot.width;
    const double up = 1 - ((mouse.y - corner.y) / px_a_unit - plot.y) / plot.height;
    if (across < 0 || across >= 1 || up < 0 || up >= 1) return;
    const DayMinute there{date_of(now.date.year, static_cast<int>(across * days)),
                          static_cast<int>(up * 1440)};
    ImGui::SetTooltip("%s, %02d:%02d", day_label(there.date).c_str(), there.minute / 60,
                      there.minute % 60);
    if (!ImGui::IsMouseClicked(0)) return;
    state.set_utc(there.utc(zone));
    state.step = true;
}

void ChartsPanel::place(const State& state, glm::vec2 size_px, float unit) {
    ImGui::SetNextWindowSizeConstraints({360 * unit, 220 * unit}, {size_px.x, size_px.y});
    if (std::exchange(is_open_, true)) return;
    if (extent_px_.x == 0) {
        const float left = 400 * unit;
        extent_px_ = {std::max(420 * unit, std::min(size_px.x - left - 10, 1100 * unit)),
                      kHeight_units * unit};
        at_px_ = {std::max(0.0f, size_px.x - 10 - extent_px_.x),
                  size_px.y - state.bar_px - 64 * unit - extent_px_.y};
    }
    if (const auto point = chosen_in_window(state, size_px)) {
        const glm::vec2 from = *point - at_px_;
        const bool is_under =
            from.x > 0 && from.y > 0 && from.x < extent_px_.x && from.y < extent_px_.y;
        if (is_under) {
            // At the edge with more room, upper or lower.
            const float top = ImGui::GetFrameHeight() + 10;
            at_px_.y = point->y - top > size_px.y - point->y
                           ? top
                           : size_px.y - extent_px_.y - below_px(state);
        }
    }
    ImGui::SetNextWindowPos({at_px_.x, at_px_.y});
    ImGui::SetNextWindowSize({extent_px_.x, extent_px_.y});
}

void ChartsPanel::dock(State& state, glm::vec2 size_px, float unit) {
    const glm::vec2 sides = state.side_panel_px.value_or(glm::vec2(0));
    // On the right of the side panel unless that is at the right edge.
    const bool is_left = sides.x + sides.y < size_px.x;
    float left = is_left ? sides.y + 10 : 10, right = is_left ? size_px.x - 10 : sides.x - 10;
    if (right - left < 360 * unit) {  // over the side panel
        left = 10;
        right = size_px.x - 10;
    }
    if (docked_px_ == 0) docked_px_ = kHeight_units * unit;
    docked_px_ = std::clamp(docked_px_, 150 * unit, std::max(150 * unit, size_px.y / 2));
    ImGui::SetNextWindowPos({left, size_px.y - below_px(state)}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSize({right - left, docked_px_});
    state.docked_px = docked_px_ + 1.4f * ImGui::GetFontSize();
    is_open_ = false;  // place() begins anew
}

void ChartsPanel::tabs(State& state) {
    const auto tab = [&](const char* name, bool is_there, const auto& draw_it) {
        if (!ImGui::BeginTabItem(name)) return;
        const ImVec2 room = ImGui::GetContentRegionAvail();
        state.chart_px = {static_cast<int>(room.x), static_cast<int>(room.y)};
        if (is_there)
            draw_it();
        else if (state.point && !state.point->error.empty())
            ImGui::TextWrapped("%s", state.point->error.c_str());
        else
            ImGui::TextDisabled("%s", tr("computing its horizon ..."));
        ImGui::EndTabItem();
    };
    tab(tr_label("Horizon"), horizon_.chart != nullptr, [&] { horizon(state); });
    tab(tr_label("Year"), year_.chart != nullptr, [&] { year(state); });
    bool& is_docked = state.settings.charts_are_docked;
    if (ImGui::TabItemButton(is_docked ? tr_label("Float") : tr_label("Dock"),
                             ImGuiTabItemFlags_Trailing))
        is_docked = !is_docked;
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "%s", is_docked ? tr("Moves freely") : tr("Stays at the lower edge of the window"));
}

void ChartsPanel::draw(State& state, glm::vec2 size_px, double px_a_unit) {
    horizon_.take(state.point ? state.point->horizon : nullptr);
    year_.take(state.point ? state.point->year : nullptr);
    state.chart_px = {0, 0};
    state.docked_px = 0;
    if (!state.settings.charts || !state.chosen) {
        is_open_ = false;
        return;
    }
    const bool is_docked = state.settings.charts_are_docked;
    if (is_docked)
        dock(state, size_px, static_cast<float>(px_a_unit));
    else
        place(state, size_px, static_cast<float>(px_a_unit));
    const ImGuiWindowFlags flags = is_docked ? ImGuiWindowFlags_NoMove : 0;
    const bool open =
        ImGui::Begin(tr_label("Horizon and year of the point"), &state.settings.charts,
                     flags | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollbar |
                         ImGuiWindowFlags_NoScrollWithMouse);
    const glm::vec2 extent_px(ImGui::GetWindowSize().x, ImGui::GetWindowSize().y);
    if (is_docked) {
        if (open) docked_px_ = extent_px.y;
    } else {
        at_px_ = {ImGui::GetWindowPos().x, ImGui::GetWindowPos().y};
        if (open) extent_px_ = extent_px;
    }
    if (open && ImGui::BeginTabBar("charts")) {
        tabs(state);
        ImGui::EndTabBar();
    }
    ImGui::End();
}

}  // namespace relevo::viewer
