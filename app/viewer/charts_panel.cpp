#include "viewer/charts_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "chart/carpet_chart.h"
#include "sun/position.h"
#include "viewer/image_texture.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

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

/// The colours of the year, beside the tabs if there is room. @param at  the chart's upper edge
void year_legend(float at) {
    using light::Light;
    constexpr std::array<std::pair<Light, const char*>, 4> kKeys{
        {{Light::Lit, tr_later("direct sun")},
         {Light::Shaded, tr_later("behind ground")},
         {Light::Twilight, tr_later("twilight")},
         {Light::Night, tr_later("night")}}};
    const style::Sized small(style::Size::Small);
    const float em = ImGui::GetFontSize(), gap = em / 2;
    float wide = 0;
    for (const auto& [light, words] : kKeys)
        wide += 1.5f * em + gap + ImGui::CalcTextSize(tr(words)).x;
    constexpr float kTabs_em = 12;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (wide + kTabs_em * em > ImGui::GetWindowContentRegionMax().x) return;
    ImVec2 next(right - wide, at - 1.75f * em);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const auto& [light, words] : kKeys) {
        list.AddRectFilled(next, {next.x + em, next.y + em},
                           style::colour(chart::CarpetChart::color_of(light).rgb));
        list.AddText({next.x + em + gap / 2, next.y}, ImGui::GetColorU32(ImGuiCol_Text), tr(words));
        next.x += 1.5f * em + gap + ImGui::CalcTextSize(tr(words)).x;
    }
}

}  // namespace

std::string lit_label(const light::LightDay& day, const sun::Zone& zone) {
    if (day.lit.empty()) return tr("no direct sun");
    const auto clock = [&](const light::LightEdge& edge) {
        return edge.midnight ? std::string(tr("midnight")) : clock_label(edge.utc, zone);
    };
    std::string text;
    for (const light::LitInterval& lit : day.lit)
        text += (text.empty() ? "" : "\n") +
                tr_format("sun {} to {}", clock(lit.begin), clock(lit.end));
    return text;
}

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
    list.AddCircleFilled(at, 7, style::kChartSun);
    list.AddCircle(at, 7.5f, style::kChartNow, 0, 2);
}

/// Marks the displayed day and time. A click sets another time.
void ChartsPanel::year(State& state) {
    const double px_a_unit = state.point->of.px_a_unit;
    year_legend(ImGui::GetCursorScreenPos().y);
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
                 at_screen(corner, {x, plot.y + plot.height}, px_a_unit), style::kChartNow, 1.5f);
    list.AddCircle(at_screen(corner, {x, y}, px_a_unit), 5, style::kChartNow, 0, 2);
    if (!hovered) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double across = ((mouse.x - corner.x) / px_a_unit - plot.x) / plot.width;
    const double up = 1 - ((mouse.y - corner.y) / px_a_unit - plot.y) / plot.height;
    if (across < 0 || across >= 1 || up < 0 || up >= 1) return;
    const DayMinute there{date_of(now.date.year, static_cast<int>(across * days)),
                          static_cast<int>(up * 1440)};
    const std::vector<light::LightDay>& lit = year_.chart->days;
    const auto day = std::ranges::find(lit, there.date, &light::LightDay::date);
    ImGui::SetTooltip("%s, %02d:%02d\n%s", day_label(there.date).c_str(), there.minute / 60,
                      there.minute % 60, day == lit.end() ? "" : lit_label(*day, zone).c_str());
    if (!ImGui::IsMouseClicked(0)) return;
    state.set_utc(there.utc(zone));
    state.step = true;
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
}

void ChartsPanel::draw(State& state, double px_a_unit) {
    horizon_.take(state.point ? state.point->horizon : nullptr);
    year_.take(state.point ? state.point->year : nullptr);
    state.chart_px = {0, 0};
    if (!state.settings.charts || !state.chosen) return;
    const Area& area = state.layout.charts;
    const glm::vec2 end = area.end();
    ImGui::SetNextWindowPos({area.at.x, end.y}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSize({area.size.x, area.size.y});
    ImGui::SetNextWindowSizeConstraints({area.size.x, 1}, {area.size.x, end.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("##charts", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollbar |
                     ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar();
    if (const float height = ImGui::GetWindowHeight(); height != area.size.y)
        state.settings.charts_height = static_cast<int>(std::lround(height / px_a_unit));
    if (ImGui::BeginTabBar("charts")) {
        tabs(state);
        ImGui::EndTabBar();
    }
    ImGui::End();
}

}  // namespace relevo::viewer
