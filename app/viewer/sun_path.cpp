#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/state.h"
#include "viewer/style.h"

namespace relevo::viewer {
namespace {

constexpr float kSun_px = 11, kReach_px = 26;
constexpr double kFar_m = 1e9;
/// From great heights the horizon is below the horizontal.
constexpr double kLowest_deg = -4;

/// Window position of a direction; nullopt behind the camera.
std::optional<ImVec2> direction_at_window(const Picture& picture, glm::vec2 size_px,
                                          const glm::dvec3& direction) {
    const auto at = in_picture(picture.camera, picture.camera.eye_m + kFar_m * direction,
                               static_cast<double>(size_px.x) / size_px.y);
    if (!at || std::abs(at->x) > 4 || std::abs(at->y) > 4) return std::nullopt;
    const glm::vec2 px = in_window(*at, size_px);
    return ImVec2(px.x, px.y);
}

/// Pixel at a window position; nullopt outside.
std::optional<glm::ivec2> pixel_at(const Picture& picture, glm::vec2 size_px, ImVec2 at) {
    const int x = static_cast<int>(at.x / size_px.x * static_cast<float>(picture.width_px));
    const int y = static_cast<int>((1 - at.y / size_px.y) * static_cast<float>(picture.height_px));
    if (x < 0 || y < 0 || x >= picture.width_px || y >= picture.height_px) return std::nullopt;
    return glm::ivec2(x, y);
}

/// True if there is sky at a window position.
bool is_sky(const Picture& picture, glm::vec2 size_px, ImVec2 at) {
    const auto pixel = pixel_at(picture, size_px, at);
    return !pixel || std::isinf(picture.depth_m(pixel->x, pixel->y));
}

/// Reads the depths along several days' paths in one transfer.
void fetch_depths(const std::vector<const SunDay*>& days, const Picture& picture,
                  glm::vec2 size_px) {
    std::vector<glm::ivec2> pixels;
    for (const SunDay* const day : days)
        for (const SunPoint& point : day->points)
            if (point.elevation_deg >= kLowest_deg)
                if (const auto at = direction_at_window(picture, size_px, point.direction))
                    if (const auto pixel = pixel_at(picture, size_px, *at))
                        pixels.push_back(*pixel);
    picture.fetch_depths(pixels);
}

}  // namespace

namespace {

void draw_way(const SunDay& day, const Picture& picture, glm::vec2 size_px, ImU32 clear,
              ImU32 hidden, float width) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const std::vector<SunPoint>& points = day.points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (std::max(points[i].elevation_deg, points[i + 1].elevation_deg) < kLowest_deg) continue;
        const auto a = direction_at_window(picture, size_px, points[i].direction);
        const auto b = direction_at_window(picture, size_px, points[i + 1].direction);
        if (!a || !b) continue;
        const bool seen = is_sky(picture, size_px, *a) && is_sky(picture, size_px, *b);
        list.AddLine(*a, *b, seen ? clear : hidden, seen ? width : 0.6f * width);
    }
}

void draw_hours(const SunDay& day, const sun::Zone& zone, const Picture& picture,
                glm::vec2 size_px) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const SunPoint& point : day.points) {
        const int minute = DayMinute::of(point.utc, zone).minute;
        const auto at = direction_at_window(picture, size_px, point.direction);
        if (minute % 60 != 0 || point.elevation_deg < kLowest_deg || !at) continue;
        const bool clear = is_sky(picture, size_px, *at);
        list.AddCircleFilled(*at, style::px(3), clear ? style::kSun : style::kHiddenSun);
        if (!clear) continue;
        const std::string hour = fmt::format("{}", minute / 60);
        label_over({at->x + style::px(9), at->y - style::px(19)}, hour.c_str());
    }
}

}  // namespace

void draw_sun_path(const State& state, const Picture& picture, glm::vec2 size_px) {
    std::vector<const SunDay*> days = {&state.day};
    for (const SunDay& extreme : state.extremes)
        days.push_back(&extreme);
    fetch_depths(days, picture, size_px);
    for (const SunDay& extreme : state.extremes)
        draw_way(extreme, picture, size_px, style::kSolstice, style::kHiddenSolstice,
                 style::px(1.5f));
    draw_way(state.day, picture, size_px, style::kWay, style::kHiddenWay, style::px(2.5f));
    draw_hours(state.day, state.document.zone, picture, size_px);
    const SunPoint now = sun_at(picture.utc, state.centre, state.air);
    const auto at = direction_at_window(picture, size_px, now.direction);
    if (!at || now.elevation_deg < kLowest_deg) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const bool clear = is_sky(picture, size_px, *at);
    const float radius = style::px(kSun_px), unit = style::px(1);
    list.AddCircleFilled(*at, radius, clear ? style::kSun : style::kHiddenSun);
    list.AddCircle(*at, radius + unit, style::kSunRim, 0, 1.5f * unit);
}

std::optional<sun::Instant> time_at(const State& state, const Picture& picture, glm::vec2 size_px,
                                    glm::vec2 at_px) {
    std::optional<sun::Instant> best;
    float least = style::px(kReach_px);
    const std::vector<SunPoint>& points = state.day.points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (points[i].elevation_deg < kLowest_deg) continue;
        const auto a = direction_at_window(picture, size_px, points[i].direction);
        const auto b = direction_at_window(picture, size_px, points[i + 1].direction);
        if (!a || !b) continue;
        const glm::vec2 from(a->x, a->y), along(b->x - a->x, b->y - a->y);
        const float length2 = dot(along, along);
        const float share =
            length2 > 0 ? std::clamp(dot(at_px - from, along) / length2, 0.0f, 1.0f) : 0.0f;
        const float away = length(at_px - (from + share * along));
        if (away >= least) continue;
        least = away;
        best = points[i].utc + share * (points[i + 1].utc - points[i].utc);
    }
    return best;
}

}  // namespace relevo::viewer
