#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/units.h"
#include "viewer/state.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

void jump(State& state, const char* name, std::optional<sun::Instant> to, const char* otherwise) {
    if (!to) ImGui::BeginDisabled();
    if (ImGui::SmallButton(name) && to) {
        state.set_utc(*to);
        state.step = true;
    }
    if (!to) ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        if (to)
            ImGui::SetTooltip("%s", sun::to_iso(*to, state.document.zone).c_str());
        else
            ImGui::SetTooltip("%s", otherwise);
    }
    ImGui::SameLine();
}

void jumps(State& state) {
    const sun::Day& day = state.day.events;
    const char* const kNone = tr("does not happen on this day");
    jump(state, tr_label("Sunrise"), day.first(sun::EventKind::Sunrise), kNone);
    jump(state, tr_label("Noon"), day.first(sun::EventKind::Transit), kNone);
    jump(state, tr_label("Sunset"), day.first(sun::EventKind::Sunset), kNone);
    const sun::Seasons& seasons = state.day.seasons;
    ImGui::NewLine();
    for (const sun::Instant of : {seasons.march_equinox, seasons.june_solstice,
                                  seasons.september_equinox, seasons.december_solstice}) {
        // The day of it, at the hour there is.
        const sun::Date then = state.document.zone.local(of).wall.date;
        const int minute = DayMinute::of(state.document.utc, state.document.zone).minute;
        jump(state, day_label(then).c_str(), DayMinute{then, minute}.utc(state.document.zone),
             kNone);
    }
    ImGui::NewLine();
}

}  // namespace

std::string sun_figures(const State& state) {
    const SunPoint sun = sun_at(state.document.utc, state.centre, state.air);
    double azimuth_deg = degrees(std::atan2(sun.direction.x, sun.direction.y));
    if (azimuth_deg < 0) azimuth_deg += 360;
    return tr_format("azimuth {:.2f}°, elevation {:.2f}°", azimuth_deg, sun.elevation_deg);
}

void sun_panel(State& state) {
    const DayMinute now = DayMinute::of(state.document.utc, state.document.zone);
    ImGui::PushItemWidth(-1);
    int day = day_of_year(now.date);
    const int days = sun::days_between({now.date.year, 1, 1}, {now.date.year + 1, 1, 1});
    const char* const month = month_name(now.date.month);
    if (ImGui::SliderInt("##day", &day, 0, days - 1, slider_format(month, "").c_str()))
        state.set_date(date_of(now.date.year, std::clamp(day, 0, days - 1)));
    state.sun_moves = state.sun_moves || ImGui::IsItemActive();
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();

    ImGui::PopItemWidth();
    jumps(state);
    ImGui::TextUnformatted(sun_figures(state).c_str());
    const int length_min = static_cast<int>(std::lround(state.day.events.day_length_s / 60));
    ImGui::TextUnformatted(
        tr_format("day length {} h {:02} min", length_min / 60, length_min % 60).c_str());
}

}  // namespace relevo::viewer
