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

constexpr std::array<const char*, 12> kMonthNames = {
    tr_later("January"),   tr_later("February"), tr_later("March"),    tr_later("April"),
    tr_later("May"),       tr_later("June"),     tr_later("July"),     tr_later("August"),
    tr_later("September"), tr_later("October"),  tr_later("November"), tr_later("December")};
constexpr int kFirstYear = 1900, kLastYear = 2100;

/// What a strip has where the sun stands so high.
ImU32 colour_of(double elevation_deg) {
    if (elevation_deg < -18) return IM_COL32(14, 18, 38, 255);
    if (elevation_deg < -6) return IM_COL32(28, 40, 84, 255);
    if (elevation_deg < -0.3) return IM_COL32(84, 84, 140, 255);
    if (elevation_deg < 6) return IM_COL32(232, 160, 84, 255);
    return IM_COL32(244, 216, 140, 255);
}

/// The day from midnight to midnight, as the sun lights it.
void day_strip(const State& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::CalcItemWidth(), height = ImGui::GetTextLineHeight() * 0.5f;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const std::vector<SunPoint>& points = state.day.points;
    const double length_s = state.day.events.span.length_s();
    const auto x_of = [&](sun::Instant utc) {
        return at.x + width * static_cast<float>((utc - state.day.events.span.begin) / length_s);
    };
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        list.AddRectFilled({x_of(points[i].utc), at.y}, {x_of(points[i + 1].utc), at.y + height},
                           colour_of(points[i].elevation_deg));
    const float now = x_of(state.document.utc);
    list.AddLine({now, at.y - 1}, {now, at.y + height + 1}, IM_COL32_WHITE, 2);
    ImGui::Dummy({width, height});
}

void set_date(State& state, sun::Date date) {
    const int minute = DayMinute::of(state.document.utc, state.document.zone).minute;
    state.set_utc(DayMinute{date, minute}.utc(state.document.zone));
}

void calendar(State& state, sun::Date date) {
    // As wide for any date, so that what stands beside it stays where it is.
    // Translators: the widest date.
    const float width = ImGui::CalcTextSize(tr("30 September 2000")).x + ImGui::GetFontSize();
    if (ImGui::Button(
            fmt::format("{} {} {}###date", date.day,
                        tr(kMonthNames[static_cast<std::size_t>(date.month - 1)]), date.year)
                .c_str(),
            {width, 0}))
        ImGui::OpenPopup("calendar");
    if (!ImGui::BeginPopup("calendar")) return;
    int year = date.year, month = date.month - 1;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(8.75f * em);
    if (ImGui::Combo("##month", &month, tr_all(kMonthNames).data(), 12))
        set_date(state, in_year({date.year, month + 1,
                                 std::min(date.day, days_in_month(date.year, month + 1))},
                                date.year));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(7.5f * em);
    if (ImGui::InputInt("##year", &year))
        set_date(state, in_year(date, std::clamp(year, kFirstYear, kLastYear)));
    // Weeks begin on Monday; 1 January 1900 was one.
    const int offset = ((sun::days_between({1900, 1, 1}, {date.year, date.month, 1}) % 7) + 7) % 7;
    for (const char* name : {tr_later("Mo"), tr_later("Tu"), tr_later("We"), tr_later("Th"),
                             tr_later("Fr"), tr_later("Sa"), tr_later("Su")}) {
        ImGui::TextDisabled("%s", tr(name));
        ImGui::SameLine(0, 0.875f * em);
    }
    ImGui::NewLine();
    const ImVec2 cell{1.75f * em, 0};
    for (int i = 0; i < offset; ++i) {
        ImGui::Dummy(cell);
        ImGui::SameLine(0, 0.25f * em);
    }
    for (int day = 1; day <= days_in_month(date.year, date.month); ++day) {
        const bool chosen = day == date.day;
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.26f, 0.59f, 0.98f, 0.8f));
        if (ImGui::Button(fmt::format("{}##day", day).c_str(), cell)) {
            set_date(state, {date.year, date.month, day});
            state.step = true;
            ImGui::CloseCurrentPopup();
        }
        if (chosen) ImGui::PopStyleColor();
        if ((offset + day) % 7 != 0) ImGui::SameLine(0, 0.25f * em);
    }
    ImGui::EndPopup();
}

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

void play(State& state) {
    if (ImGui::Button(state.playing ? tr_label("Pause") : tr_label("Play"), {80, 0}))
        state.playing = !state.playing;
    ImGui::SameLine();
    static constexpr std::array<double, 5> kSpeeds = {1.0 / 6, 0.5, 1, 3, 24};
    static constexpr std::array<const char*, 5> kNames = {"10 min/s", "30 min/s", "1 h/s", "3 h/s",
                                                          tr_later("1 day/s")};
    int speed = 0;
    for (std::size_t i = 0; i < kSpeeds.size(); ++i)
        if (kSpeeds[i] <= state.hours_a_second + 1e-9) speed = static_cast<int>(i);
    ImGui::SetNextItemWidth(6.875f * ImGui::GetFontSize());
    if (ImGui::Combo("##speed", &speed, tr_all(kNames).data(), static_cast<int>(kNames.size())))
        state.hours_a_second = kSpeeds[static_cast<std::size_t>(speed)];
    ImGui::SameLine();
    ImGui::Checkbox(tr_label("Pin"), &state.time_is_pinned);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s",
                          tr("Shows the next DEM at this time of day, even if it is night there"));
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
    calendar(state, now.date);
    ImGui::SameLine();
    if (ImGui::SmallButton(tr_label("-1 d"))) set_date(state, sun::add_days(now.date, -1));
    ImGui::SameLine();
    if (ImGui::SmallButton(tr_label("+1 d"))) set_date(state, sun::add_days(now.date, 1));

    int day = day_of_year(now.date);
    const int days = sun::days_between({now.date.year, 1, 1}, {now.date.year + 1, 1, 1});
    const char* const month = tr(kMonthNames[static_cast<std::size_t>(now.date.month - 1)]);
    if (ImGui::SliderInt("##day", &day, 0, days - 1, slider_format(month, "").c_str()))
        set_date(state, date_of(now.date.year, std::clamp(day, 0, days - 1)));
    state.sun_moves = state.sun_moves || ImGui::IsItemActive();
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();

    day_strip(state);
    int minute = now.minute;
    const std::string clock = fmt::format("{:02}:{:02}", minute / 60, minute % 60);
    if (ImGui::SliderInt("##minute", &minute, 0, 24 * 60 - 1, clock.c_str()))
        state.set_utc(
            DayMinute{now.date, std::clamp(minute, 0, 24 * 60 - 1)}.utc(state.document.zone));
    state.sun_moves = state.sun_moves || ImGui::IsItemActive();
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();
    ImGui::PopItemWidth();
    jumps(state);
    play(state);

    const sun::LocalTime local = state.document.zone.local(state.document.utc);
    ImGui::TextDisabled("%s (UTC%s)", state.document.zone.name().c_str(),
                        sun::offset_text(local.utc_offset_s).c_str());
    ImGui::TextUnformatted(sun_figures(state).c_str());
    const int length_min = static_cast<int>(std::lround(state.day.events.day_length_s / 60));
    ImGui::TextUnformatted(
        tr_format("day length {} h {:02} min", length_min / 60, length_min % 60).c_str());
}

}  // namespace relevo::viewer
