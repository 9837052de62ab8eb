#include "viewer/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "base/units.h"
#include "geo/format.h"
#include "geo/geodetic.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
double round_length(double length) {
    const double power = std::pow(10, std::floor(std::log10(length)));
    for (const double digit : {5.0, 2.0})
        if (digit * power <= length) return digit * power;
    return power;
}

std::string length_text(double length_m) {
    if (length_m >= 10000) return fmt::format("{:.1f} km", length_m / 1000);
    if (length_m >= 1000) return fmt::format("{:.2f} km", length_m / 1000);
    if (length_m >= 10) return fmt::format("{:.0f} m", length_m);
    return length_m >= 1 ? fmt::format("{:.1f} m", length_m)
                         : fmt::format("{:.3g} cm", 100 * length_m);
}

void label_over(ImVec2 at, const char* words, float wrap_px) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 extent = ImGui::CalcTextSize(words, nullptr, false, wrap_px);
    const float beside = style::px(6), above = style::px(3);
    list.AddRectFilled({at.x - beside, at.y - above},
                       {at.x + extent.x + beside, at.y + extent.y + above}, style::kShade,
                       style::px(4));
    list.AddText(nullptr, 0, at, style::kInk, words, nullptr, std::max(0.0f, wrap_px));
}

void draw_sides(float line_px, float top_px) {
    const auto label = [&](const char* words, bool left) {
        const ImVec2 extent = ImGui::CalcTextSize(words);
        const float beside = style::px(14);
        label_over({left ? line_px - extent.x - beside : line_px + beside, top_px + style::px(8)},
                   words);
    };
    label(tr("as it was"), true);
    label(tr("as it is now"), false);
}

namespace {

/// Of the north arrow.
float radius() {
    return style::px(34);
}

ImVec2 north_middle(const Area& free) {
    return {free.end().x - style::px(46), free.at.y + style::px(46)};
}

/// A scale bar across the view. @param m_a_px  of the ground
void draw_scale(const Area& free, double m_a_px) {
    const double length_m = round_length(double{style::px(160)} * m_a_px);
    const auto width = static_cast<float>(length_m / m_a_px);
    const std::string text = tr_format("{} here", length_text(length_m));
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    // Of a narrow picture the status line takes the lowest rows.
    const bool is_narrow = free.size.x < style::px(620);
    const float unit = style::px(1), up = is_narrow ? 62 * unit : 24 * unit;
    const ImVec2 end{free.end().x - 24 * unit, free.end().y - up};
    const float wide = std::max(width, extent.x), tall = extent.y + 10 * unit;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({end.x - wide - 8 * unit, end.y - tall},
                       {end.x + 8 * unit, end.y + 8 * unit}, style::kShade, 4 * unit);
    list.AddLine({end.x - width, end.y}, end, style::kInk, 2 * unit);
    for (const float x : {end.x - width, end.x})
        list.AddLine({x, end.y - 5 * unit}, {x, end.y + unit}, style::kInk, 2 * unit);
    list.AddText({end.x - wide / 2 - extent.x / 2, end.y - tall + 3 * unit}, style::kInk,
                 text.c_str());
}

}  // namespace

chart::Rect north_place(const Area& free) {
    const ImVec2 middle = north_middle(free);
    return {double{middle.x - radius()}, double{middle.y - radius()}, 2 * double{radius()},
            2 * double{radius()}};
}

void draw_scale_and_north(const Picture& picture, const Land& land,
                          const std::optional<glm::dvec3>& middle_m, glm::vec2 size_px,
                          const Area& free) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    // True north at the eye, as if the arrow lay on level ground.
    const geo::Axes axes = land.axes(picture.camera.eye_m);
    const glm::dvec3 right = cross(picture.camera.forward, picture.camera.up);
    const glm::dvec2 north(dot(axes.north, right), dot(axes.north, picture.camera.up));
    const glm::dvec2 east(dot(axes.east, right), dot(axes.east, picture.camera.up));
    const ImVec2 middle = north_middle(free);
    const auto tip = [&](glm::dvec2 way, float length) {
        return ImVec2(middle.x + static_cast<float>(way.x) * style::px(length),
                      middle.y - static_cast<float>(way.y) * style::px(length));
    };
    list.AddCircleFilled(middle, radius(), style::kShade);
    list.AddTriangleFilled(tip(north, 26), tip(east, 7), tip(-east, 7), style::kMark);
    list.AddTriangleFilled(tip(-north, 26), tip(-east, 7), tip(east, 7), style::kInk);
    const ImVec2 letter = tip(north, 26), letter_px = ImGui::CalcTextSize(compass_text(0));
    list.AddText({letter.x - letter_px.x / 2, letter.y - letter_px.y / 2}, style::kInk,
                 compass_text(0));
    if (!middle_m) return;
    // At the depth of the ground in the centre.
    const double depth_m = dot(*middle_m - picture.camera.eye_m, picture.camera.forward);
    const double m_a_px = 2 * depth_m * std::tan(picture.camera.fov_y_rad / 2) / size_px.y;
    draw_scale(free, m_a_px);
}

const char* compass_text(double azimuth_deg) {
    static constexpr std::array<const char*, 16> kPoints = {
        tr_later("N"), tr_later("NNE"), tr_later("NE"), tr_later("ENE"),
        tr_later("E"), tr_later("ESE"), tr_later("SE"), tr_later("SSE"),
        tr_later("S"), tr_later("SSW"), tr_later("SW"), tr_later("WSW"),
        tr_later("W"), tr_later("WNW"), tr_later("NW"), tr_later("NNW")};
    const double turn = std::fmod(azimuth_deg + 360, 360) / 360;
    return tr(kPoints[static_cast<std::size_t>(16 * turn + 0.5) % 16]);
}

std::string slope_text(double slope_deg, double aspect_deg) {
    if (std::isnan(slope_deg)) return "";
    if (std::isnan(aspect_deg)) return tr_format("{:.1f} degrees", slope_deg);
    return tr_format("{:.1f} degrees, facing {}", slope_deg, compass_text(aspect_deg));
}

}  // namespace relevo::viewer
