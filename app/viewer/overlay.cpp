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

namespace relevo::viewer {
namespace {

constexpr ImU32 kLine = IM_COL32(255, 80, 60, 255);
constexpr ImU32 kInk = IM_COL32(255, 255, 255, 235), kShade = IM_COL32(0, 0, 0, 150);

}  // namespace

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

void draw_sides(float line_px, float top_px) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto label = [&](const char* words, bool left) {
        const ImVec2 extent = ImGui::CalcTextSize(words);
        const ImVec2 at{left ? line_px - extent.x - 14 : line_px + 14, top_px + 8};
        list.AddRectFilled({at.x - 6, at.y - 3}, {at.x + extent.x + 6, at.y + extent.y + 3}, kShade,
                           4);
        list.AddText(at, kInk, words);
    };
    label("as it was", true);
    label("as it is now", false);
}

namespace {

constexpr float kNorthRadius_px = 34;

ImVec2 north_middle(glm::vec2 size_px, float top_px) {
    return {size_px.x - 46, 46 + top_px};
}

}  // namespace

chart::Rect north_place(glm::vec2 size_px, float top_px) {
    const ImVec2 middle = north_middle(size_px, top_px);
    return {static_cast<double>(middle.x - kNorthRadius_px),
            static_cast<double>(middle.y - kNorthRadius_px), 2 * double{kNorthRadius_px},
            2 * double{kNorthRadius_px}};
}

void draw_scale_and_north(const Picture& picture, const Land& land,
                          const std::optional<glm::dvec3>& middle_m, glm::vec2 size_px,
                          float top_px) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    // True north at the eye, as if the arrow lay on level ground.
    const geo::Axes axes = land.axes(picture.camera.eye_m);
    const glm::dvec3 right = cross(picture.camera.forward, picture.camera.up);
    const glm::dvec2 north(dot(axes.north, right), dot(axes.north, picture.camera.up));
    const glm::dvec2 east(dot(axes.east, right), dot(axes.east, picture.camera.up));
    const ImVec2 middle = north_middle(size_px, top_px);
    const auto tip = [&](glm::dvec2 way, double length) {
        return ImVec2(middle.x + static_cast<float>(way.x * length),
                      middle.y - static_cast<float>(way.y * length));
    };
    list.AddCircleFilled(middle, kNorthRadius_px, kShade);
    list.AddTriangleFilled(tip(north, 26), tip(east, 7), tip(-east, 7), kLine);
    list.AddTriangleFilled(tip(-north, 26), tip(-east, 7), tip(east, 7), kInk);
    const ImVec2 letter = tip(north, 26);
    list.AddText({letter.x - 5, letter.y - 8}, kInk, "N");
    if (!middle_m) return;
    // A scale bar across the view, at the depth of the ground in the centre.
    const double depth_m = dot(*middle_m - picture.camera.eye_m, picture.camera.forward);
    const double m_a_px = 2 * depth_m * std::tan(picture.camera.fov_y_rad / 2) / size_px.y;
    constexpr double kBar_px = 160;
    const double length_m = round_length(kBar_px * m_a_px);
    const auto width = static_cast<float>(length_m / m_a_px);
    const std::string text = length_text(length_m) + " here";
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    const ImVec2 end{size_px.x - 24, size_px.y - 24};
    const float wide = std::max(width, extent.x), tall = extent.y + 10;
    list.AddRectFilled({end.x - wide - 8, end.y - tall}, {end.x + 8, end.y + 8}, kShade, 4);
    list.AddLine({end.x - width, end.y}, end, kInk, 2);
    list.AddLine({end.x - width, end.y - 5}, {end.x - width, end.y + 1}, kInk, 2);
    list.AddLine({end.x, end.y - 5}, {end.x, end.y + 1}, kInk, 2);
    list.AddText({end.x - wide / 2 - extent.x / 2, end.y - tall + 3}, kInk, text.c_str());
}

std::string slope_text(double slope_deg, double aspect_deg) {
    if (std::isnan(slope_deg)) return "";
    if (std::isnan(aspect_deg)) return fmt::format("{:.1f} degrees", slope_deg);
    return fmt::format("{:.1f} degrees, facing {}", slope_deg,
                       geo::compass_point(std::fmod(aspect_deg + 360, 360)));
}

void key_sheet() {
    static constexpr std::array<std::array<const char*, 2>, 36> kKeys = {{
        {"Left drag", "move the ground"},
        {"Right drag, Shift + drag", "turn about the ground under the cursor"},
        {"Middle drag", "look around"},
        {"Wheel, two fingers", "zoom to the ground under the cursor"},
        {"Shift + wheel", "move the ground"},
        {"Drag the sun", "along its path of the day"},
        {"Arrows", "turn about the centre"},
        {"Page up, Page down", "zoom in, zoom out"},
        {"W A S D, Q E", "fly, down and up; faster with Shift"},
        {"G", "walk at the clicked point or in the middle, and fly again"},
        {"Ctrl + F", "go to coordinates or a name"},
        {"Home, N, T", "whole DEM, north up, top view"},
        {"[ ]", "half an hour earlier, later; with Shift a day"},
        {"Space", "play and pause the time"},
        {"Click", "direct sun of the day at a point, its horizon and year"},
        {"Right click", "stand there, look there, measure from there, copy its coordinates"},
        {"P", "horizon and year on and off"},
        {"M", "measure from the point: clicks set corners, Backspace goes back, M ends"},
        {"C", "compare: the left side stays, the right side follows; drag the line"},
        {"O", "sun hours of the day on the ground, on and off"},
        {"F12", "save the image as a picture"},
        {"Ctrl + P", "export a picture: size, format, samples, stamps"},
        {"Ctrl + C", "copy the command for this picture"},
        {"Ctrl + S", "save the scene"},
        {"Ctrl + E", "export the sun overlay as GeoTIFF"},
        {"Ctrl + J", "save the day's hours as a job"},
        {"F", "film: a day, a year, orbits and flights, on a time line"},
        {"Ctrl + O", "open a DEM, scene, photograph, track ...; files can be dropped too"},
        {"Ctrl + Page down, Page up", "next, previous DEM of the folder"},
        {"B, then 1 to 9", "save the view; go to a saved view"},
        {"F5", "reload effects (automatic if their files change)"},
        {"Ctrl + Z, Ctrl + Y", "undo, redo"},
        {"Tab", "panels and menu on and off"},
        {"F6, F10, Esc", "keyboard to the panels, to the menu, back to the scene"},
        {"H, Esc", "this sheet; Esc also cancels opening a DEM"},
        {"Ctrl + Q", "quit"},
    }};
    ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x / 2, ImGui::GetIO().DisplaySize.y / 2},
                            ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin("Keys", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
    if (ImGui::BeginTable("keys", 2)) {
        for (const auto& [key, what] : kKeys) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(key);
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", what);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace relevo::viewer
