#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/units.h"
#include "geo/format.h"
#include "viewer/state.h"

namespace relevo::viewer {
namespace {

std::string clock_text(sun::Instant utc, const sun::Zone& zone) {
    const sun::CivilTime wall = zone.local(utc).wall;
    return fmt::format("{:02}:{:02}", wall.hour, wall.minute);
}

std::string duration_text(double seconds) {
    const auto minutes = static_cast<int>(std::lround(seconds / 60));
    return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

void go_to_edge(State& state, const char* name, sun::Instant utc) {
    if (ImGui::SmallButton(name)) {
        state.set_utc(utc);
        state.step = true;
    }
    ImGui::SameLine();
}

void light_of(State& state, const PointLight& point) {
    const sun::Zone& zone = state.document.zone;
    if (!point.error.empty()) {
        ImGui::TextWrapped("%s", point.error.c_str());
        return;
    }
    const sun::Instant now = state.document.utc;
    const auto next = point.next_change(now);
    const bool lit = point.is_lit(now);
    ImGui::TextColored(lit ? ImVec4(1, 0.85f, 0.4f, 1) : ImVec4(0.6f, 0.7f, 1, 1), "%s%s",
                       lit ? "in the sun" : "in shade",
                       next ? fmt::format(", {} at {}", lit ? "till it leaves" : "sun comes",
                                          clock_text(*next, zone))
                                  .c_str()
                            : (lit ? "" : " for the rest of the day"));
    for (const sun::TimeSpan& span : point.lit)
        ImGui::Text("%s to %s  (%s)", clock_text(span.begin, zone).c_str(),
                    clock_text(span.end, zone).c_str(), duration_text(span.length_s()).c_str());
    if (!point.lit.empty()) {
        go_to_edge(state, "First light", point.lit.front().begin);
        go_to_edge(state, "Last light", point.lit.back().end);
        ImGui::NewLine();
    }
    ImGui::Text("%s of sun, %s over a flat horizon", duration_text(point.lit_s).c_str(),
                duration_text(point.flat_s).c_str());
}

}  // namespace

void point_panel(State& state) {
    if (!state.point && !state.point_in_work.valid()) {
        ImGui::TextDisabled("Click the ground: its sun of the day, here.");
        return;
    }
    if (state.point) {
        const geo::Geodetic& place = state.point->place;
        ImGui::TextUnformatted(geo::degrees_text(place).c_str());
        ImGui::TextUnformatted(geo::utm_text(place).c_str());
        ImGui::Text("MGRS %s", geo::mgrs_text(place).c_str());
        ImGui::Text("height %.1f m", place.height_m);
    }
    if (state.point_in_work.valid() || state.point->date != state.day.date)
        ImGui::TextDisabled("looking at its horizon ...");
    else
        light_of(state, *state.point);
}

}  // namespace relevo::viewer
