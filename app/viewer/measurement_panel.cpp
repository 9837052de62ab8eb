#include "viewer/measurement_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "base/units.h"
#include "geo/format.h"
#include "viewer/overlay.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

std::optional<ImVec2> at_window(const Picture& picture, glm::vec2 size_px,
                                const glm::dvec3& point_m) {
    if (std::isnan(point_m.x + point_m.y + point_m.z)) return std::nullopt;
    const auto at = in_picture(picture.camera, point_m, static_cast<double>(size_px.x) / size_px.y);
    if (!at || std::abs(at->x) > 4 || std::abs(at->y) > 4) return std::nullopt;
    const glm::vec2 px = in_window(*at, size_px);
    return ImVec2(px.x, px.y);
}

/// A point of the line in the window.
struct Place {
    ImVec2 at;
    bool hidden = false;
};

/// Every point of the line that is before the camera.
std::vector<std::optional<Place>> places_of(const std::vector<glm::dvec3>& line_m,
                                            const Picture& picture, glm::vec2 size_px) {
    std::vector<std::optional<Place>> places(line_m.size());
    std::vector<glm::ivec2> pixels(line_m.size(), glm::ivec2(-1));
    for (std::size_t i = 0; i < line_m.size(); ++i) {
        const std::optional<ImVec2> at = at_window(picture, size_px, line_m[i]);
        if (!at) continue;
        places[i] = Place{*at};
        const glm::ivec2 px(at->x / size_px.x * static_cast<float>(picture.width_px),
                            (1 - at->y / size_px.y) * static_cast<float>(picture.height_px));
        if (px.x >= 0 && px.y >= 0 && px.x < picture.width_px && px.y < picture.height_px)
            pixels[i] = px;
    }
    std::vector<glm::ivec2> wanted;
    std::ranges::copy_if(pixels, std::back_inserter(wanted),
                         [](const glm::ivec2& px) { return px.x >= 0; });
    picture.fetch_depths(wanted);
    for (std::size_t i = 0; i < line_m.size(); ++i) {
        if (!places[i] || pixels[i].x < 0) continue;
        const double depth_m = dot(line_m[i] - picture.camera.eye_m, picture.camera.forward);
        // Ground is drawn from coarser posts the farther it is.
        places[i]->hidden = picture.depth_m(pixels[i].x, pixels[i].y) < 0.98 * depth_m;
    }
    return places;
}

/// A ring, so that a moon that stands over the point is seen in it.
void draw_ring(ImDrawList& list, ImVec2 at) {
    const float unit = style::px(1);
    list.AddCircle(at, 7 * unit, style::kMark, 0, 3 * unit);
    list.AddCircle(at, 9 * unit, style::kInk, 0, 1.5f * unit);
}

/// Straight, from the last corner to the first.
void draw_closing_line(const Measurement& measurement, const Picture& picture, glm::vec2 size_px) {
    if (measurement.corners_m.size() < 3) return;
    const auto a = at_window(picture, size_px, measurement.corners_m.front());
    const auto b = at_window(picture, size_px, measurement.corners_m.back());
    if (a && b) ImGui::GetBackgroundDrawList()->AddLine(*a, *b, style::kFaintMark, style::px(2));
}

}  // namespace

void draw_measurement(const Measurement& measurement, const Picture& picture, glm::vec2 size_px) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto places = places_of(measurement.line_m, picture, size_px);
    for (std::size_t i = 1; i < places.size(); ++i)
        if (places[i - 1] && places[i])
            list.AddLine(
                places[i - 1]->at, places[i]->at,
                places[i - 1]->hidden || places[i]->hidden ? style::kFaintMark : style::kMark,
                style::px(2));
    draw_closing_line(measurement, picture, size_px);
    std::optional<ImVec2> last;
    for (const glm::dvec3& corner_m : measurement.corners_m) {
        last = at_window(picture, size_px, corner_m);
        if (last) draw_ring(list, *last);
    }
    if (measurement.marked && *measurement.marked < places.size())
        if (const auto& place = places[*measurement.marked]) draw_ring(list, place->at);
    if (!last || !measurement.profile) return;
    const std::string length = length_text(measurement.profile->level_m);
    label_over({last->x + style::px(15), last->y - style::px(8)}, length.c_str());
}

namespace {

/// The plot of a profile: its rectangle in the window and what its sides stand for.
struct Plot {
    ImVec2 at, extent;
    double length_m, low_m, high_m;

    ImVec2 place(double distance_m, double height_m) const {
        return {at.x + extent.x * static_cast<float>(distance_m / std::max(length_m, 1e-9)),
                at.y + extent.y * static_cast<float>((high_m - height_m) / (high_m - low_m))};
    }
};

/// Lines at round heights and distances, with their figures.
void draw_axes(ImDrawList& list, const Plot& plot) {
    const ImU32 grid = ImGui::GetColorU32(ImGuiCol_TextDisabled, 0.4f);
    const ImU32 text = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const double rise_m = round_length((plot.high_m - plot.low_m) / 2);
    for (double h = std::ceil(plot.low_m / rise_m) * rise_m; h < plot.high_m; h += rise_m) {
        const float y = plot.place(0, h).y;
        list.AddLine({plot.at.x, y}, {plot.at.x + plot.extent.x, y}, grid);
        const std::string label = fmt::format("{:.{}f}", h, rise_m < 1 ? 1 : 0);
        const float width = ImGui::CalcTextSize(label.c_str()).x;
        list.AddText({plot.at.x - width - 4, y - ImGui::GetFontSize() / 2}, text, label.c_str());
    }
    const double step_m = round_length(std::max(plot.length_m, 1e-6) / 2);
    for (double s = step_m; s <= plot.length_m; s += step_m) {
        const float x = plot.place(s, 0).x;
        list.AddLine({x, plot.at.y}, {x, plot.at.y + plot.extent.y}, grid);
        const std::string label =
            step_m >= 500 ? fmt::format("{:g} km", s / 1000) : fmt::format("{:g} m", s);
        const float width = ImGui::CalcTextSize(label.c_str()).x;
        list.AddText({std::min(x - width / 2, plot.at.x + plot.extent.x - width),
                      plot.at.y + plot.extent.y + 1},
                     text, label.c_str());
    }
}

void draw_ground(ImDrawList& list, const Plot& plot, const std::vector<ProfilePoint>& points) {
    const ImU32 ink = ImGui::GetColorU32(ImGuiCol_PlotLines);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const ProfilePoint &a = points[i - 1], &b = points[i];
        if (std::isnan(a.place.height_m + b.place.height_m)) continue;
        list.AddLine(plot.place(a.distance_m, a.place.height_m),
                     plot.place(b.distance_m, b.place.height_m), ink, 1.5f);
    }
}

/// The point of the profile under the mouse, which draw_measurement() shows on the ground.
void show_point(Measurement& measurement, ImDrawList& list, const Plot& plot) {
    const std::vector<ProfilePoint>& points = measurement.profile->points;
    const double across = (ImGui::GetIO().MousePos.x - plot.at.x) / plot.extent.x;
    const double way_m = std::clamp(across, 0.0, 1.0) * plot.length_m;
    const auto found = std::ranges::lower_bound(points, way_m, {}, &ProfilePoint::distance_m);
    const auto& point = found == points.end() ? points.back() : *found;
    measurement.marked = static_cast<std::size_t>(&point - points.data());
    const std::string there = length_text(point.distance_m);
    if (std::isnan(point.place.height_m)) {
        ImGui::SetTooltip("%s", tr_format("after {}: no height", there).c_str());
        return;
    }
    list.AddCircleFilled(plot.place(point.distance_m, point.place.height_m), 4, style::kMark);
    ImGui::SetTooltip("%s", tr_format("after {}: {:.1f} m", there, point.place.height_m).c_str());
}

void plot_profile(Measurement& measurement) {
    const Profile& profile = *measurement.profile;
    const float font = ImGui::GetFontSize();
    const float left = ImGui::CalcTextSize("-8888").x + 4;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 extent{ImGui::GetContentRegionAvail().x - left, 6 * font};
    ImGui::InvisibleButton("##profile", {extent.x + left, extent.y + font + 2});
    const double margin_m = std::max(0.05 * (profile.highest_m - profile.lowest_m), 0.05);
    const Plot plot{{corner.x + left, corner.y},
                    extent,
                    profile.level_m,
                    profile.lowest_m - margin_m,
                    profile.highest_m + margin_m};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(plot.at, {plot.at.x + extent.x, plot.at.y + extent.y},
                       ImGui::GetColorU32(ImGuiCol_FrameBg));
    draw_axes(list, plot);
    draw_ground(list, plot, profile.points);
    if (ImGui::IsItemHovered()) show_point(measurement, list, plot);
}

std::string height_text(double height_m) {
    return std::isnan(height_m) ? tr("no height") : fmt::format("{:.1f} m", height_m);
}

std::string bearing_text(double azimuth_rad) {
    const double azimuth_deg = std::fmod(degrees(azimuth_rad) + 360, 360);
    return fmt::format("{:.1f}° ({})", azimuth_deg, compass_text(azimuth_deg));
}

std::string area_text(double area_m2) {
    if (area_m2 >= 1e6) return fmt::format("{:.2f} km²", area_m2 / 1e6);
    return area_m2 >= 1e4 ? fmt::format("{:.2f} ha", area_m2 / 1e4)
                          : fmt::format("{:.0f} m²", area_m2);
}

void wrapped(const std::string& text) {
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

void lengths(const Profile& profile, bool is_straight) {
    const double first_m = profile.points.front().place.height_m;
    const double last_m = profile.points.back().place.height_m;
    std::string text = length_text(profile.level_m);
    if (is_straight)
        text += tr_format(", azimuth {}, back {}", bearing_text(profile.azimuth_rad),
                          bearing_text(profile.back_rad));
    text += "\n";
    text += profile.has_voids
                ? tr_format("{} over the ground without voids", length_text(profile.surface_m))
                : tr_format("{} over the ground", length_text(profile.surface_m));
    text += "\n" + tr_format("from {} to {}", height_text(first_m), height_text(last_m));
    if (!std::isnan(last_m - first_m)) text += fmt::format(" ({:+.1f} m)", last_m - first_m);
    text += "\n" + tr_format("{:.0f} m up, {:.0f} m down\nlowest {:.0f} m, highest {:.0f} m",
                             profile.up_m, profile.down_m, profile.lowest_m, profile.highest_m);
    wrapped(text);
}

void height_field(const char* label, float& height_m) {
    ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
    ImGui::DragFloat(label, &height_m, 0.1f, 0, 10000, "%.1f m", ImGuiSliderFlags_AlwaysClamp);
}

void line_of_sight_of(Measurement& measurement) {
    height_field(tr_label("eye"), measurement.eye_m);
    ImGui::SameLine();
    height_field(tr_label("end, above ground"), measurement.target_m);
    const auto sight = line_of_sight(*measurement.profile, measurement.eye_m, measurement.target_m);
    if (!sight) return wrapped(tr("line of sight: an end has no height"));
    if (sight->missing_m <= 0)
        return wrapped(
            tr_format("the end is visible, {:.1f} m above the line of sight over the "
                      "ground after {}",
                      -sight->missing_m, length_text(sight->highest.distance_m)));
    constexpr double kHighest_m = 1000;  // of what may stand there
    if (sight->missing_m > kHighest_m)
        return wrapped(tr_format("the end is hidden by the ground after {}",
                                 length_text(sight->highest.distance_m)));
    wrapped(
        tr_format("the end is hidden by the ground after {}; a target {:.1f} m higher is visible",
                  length_text(sight->highest.distance_m), sight->missing_m));
}

}  // namespace

void measurement_panel(State& state) {
    Measurement& measurement = state.measurement;
    const Profile& profile = *measurement.profile;
    if (std::isnan(profile.lowest_m)) {
        ImGui::TextWrapped("%s", tr("No heights along this line."));
        return;
    }
    const bool is_straight = measurement.corners_m.size() == 2;
    plot_profile(measurement);
    lengths(profile, is_straight);
    if (measurement.area_m2)
        wrapped(tr_format("area {}, closed by a straight line", area_text(*measurement.area_m2)));
    if (measurement.crosses_itself) wrapped(tr("no area: the outline crosses itself"));
    if (is_straight) line_of_sight_of(measurement);
    if (ImGui::SmallButton(tr_label("Save as CSV"))) state.commands.push_back(Command::SaveProfile);
    if (!measurement.follows_cursor) return;
    wrapped(tr("Click sets a corner, Backspace removes the last, M ends"));
}

}  // namespace relevo::viewer
