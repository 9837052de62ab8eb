#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/units.h"
#include "viewer/overlay.h"
#include "viewer/state.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr std::array<const char*, 12> kMonthNames = {
    tr_later("January"),   tr_later("February"), tr_later("March"),    tr_later("April"),
    tr_later("May"),       tr_later("June"),     tr_later("July"),     tr_later("August"),
    tr_later("September"), tr_later("October"),  tr_later("November"), tr_later("December")};
constexpr int kFirstYear = 1900, kLastYear = 2100;
/// Of the texts' height: the strip, and gaps.
constexpr float kStrip = 0.8f, kGap = 0.19f;

/// What the strip shows of a time: the sun as its ground's middle sees it.
struct Sky {
    ImU32 colour;
    const char* name;
};

Sky sky_at(const SunDay& day, sun::Instant utc, double elevation_deg) {
    const auto is_in = [&](const std::vector<sun::TimeSpan>& spans) {
        return std::ranges::any_of(
            spans, [&](const sun::TimeSpan& span) { return span.begin <= utc && utc < span.end; });
    };
    if (is_in(day.events.sun_up))
        return is_in(day.events.golden_hour) ? Sky{style::kGolden, tr_later("golden hour")}
                                             : Sky{style::kDay, tr_later("day")};
    if (elevation_deg > -6) return {style::kCivil, tr_later("civil twilight")};
    if (elevation_deg > -12) return {style::kNautical, tr_later("nautical twilight")};
    if (elevation_deg > -18) return {style::kAstronomical, tr_later("astronomical twilight")};
    return {style::kNight, tr_later("night")};
}

/// The day from midnight to midnight along the strip.
class Strip {
  public:
    /// @param grab_px  width of the slider's knob
    Strip(const State& state, ImVec2 at, float width, float height, float grab_px)
        : state_(state),
          at_(at),
          height_(height),
          left_(at.x + 2 + grab_px / 2),
          width_(width - 4 - grab_px) {}

    float x_of(sun::Instant utc) const {
        const sun::TimeSpan& span = state_.day.events.span;
        return left_ + width_ * static_cast<float>((utc - span.begin) / span.length_s());
    }
    sun::Instant time_at(float x) const {
        const sun::TimeSpan& span = state_.day.events.span;
        return span.begin +
               std::clamp(double{x - left_} / width_, 0.0, 1.0) * (span.length_s() - 1);
    }
    Sky sky(sun::Instant utc) const { return sky_at(state_.day, utc, by_points_deg(utc)); }
    /// Whether ground hides the sun from the clicked point; false if that is not known.
    bool is_hidden(sun::Instant utc) const {
        const PointLight* const point = state_.point.get();
        return point && state_.chosen && point->error.empty() &&
               point->of.date == state_.day.date && !point->is_lit(utc) && by_points_deg(utc) > 0;
    }

    float top_px() const { return at_.y; }

    void draw() const {
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const auto look = [&](float x) {
            const sun::Instant utc = time_at(x + 0.5f);
            return std::pair(sky(utc).colour, is_hidden(utc));
        };
        const float right = left_ + width_;
        std::pair<ImU32, bool> now = look(left_);
        for (float from = left_, to = left_ + 1; from < right; to += 1) {
            const auto next = to < right ? look(to) : std::pair(ImU32{0}, false);
            if (next == now) continue;
            const float end = std::min(to, right);
            list.AddRectFilled({from, at_.y}, {end, at_.y + height_}, now.first);
            if (now.second)
                list.AddRectFilled({from, at_.y + height_ / 2}, {end, at_.y + height_},
                                   style::kHiddenByGround);
            from = to;
            now = next;
        }
        for (const sun::TimeSpan& up : state_.moon->moon_up)
            list.AddRectFilled({x_of(up.begin), at_.y}, {x_of(up.end), at_.y + height_ / 6},
                               style::kMoon);
        draw_hours(list);
    }

  private:
    /// Between the points of the day.
    double by_points_deg(sun::Instant utc) const {
        const std::vector<SunPoint>& points = state_.day.points;
        const auto after = std::ranges::upper_bound(points, utc, {}, &SunPoint::utc);
        if (after == points.begin()) return points.front().elevation_deg;
        if (after == points.end()) return points.back().elevation_deg;
        const SunPoint& before = *std::prev(after);
        return std::lerp(before.elevation_deg, after->elevation_deg,
                         (utc - before.utc) / (after->utc - before.utc));
    }
    /// Every third hour, and where the clocks change.
    void draw_hours(ImDrawList& list) const {
        const sun::Zone& zone = state_.document.zone;
        for (int hour = 3; hour < 24; hour += 3) {
            const float x = x_of(DayMinute{state_.day.date, hour * 60}.utc(zone));
            list.AddLine({x, at_.y + height_ * 0.55f}, {x, at_.y + height_}, style::kTick);
        }
        const std::vector<SunPoint>& points = state_.day.points;
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
            if (zone.local(points[i].utc).utc_offset_s !=
                zone.local(points[i + 1].utc).utc_offset_s)
                list.AddLine({x_of(points[i + 1].utc), at_.y},
                             {x_of(points[i + 1].utc), at_.y + height_}, style::kMark, 2);
    }

    const State& state_;
    ImVec2 at_;
    float height_, left_, width_;
};

std::string wall_clock(sun::Instant utc, const sun::Zone& zone) {
    const int minute = DayMinute::of(utc, zone).minute;
    return fmt::format("{:02}:{:02}", minute / 60, minute % 60);
}

/// "moon up 18:02 - 24:00, 78 % lit"
std::string moon_text(const State& state) {
    const sun::MoonDay& moon = *state.moon;
    if (moon.moon_up.empty()) return tr("no moon");
    std::string text = tr("moon up");
    for (const sun::TimeSpan& up : moon.moon_up)
        text +=
            fmt::format("{}{} - {}", up.begin == moon.moon_up.front().begin ? " " : ", ",
                        wall_clock(up.begin, state.document.zone),
                        up.end < moon.span.end ? wall_clock(up.end, state.document.zone) : "24:00");
    return text + tr_format(", {:.0f} % lit", 100 * moon.illuminated_fraction);
}

void tell(const State& state, const Strip& strip, sun::Instant utc) {
    const SunPoint sun = sun_at(utc, state.centre, state.air);
    std::string text =
        tr_format("{}   {}   sun {:.1f}° in the {}", wall_clock(utc, state.document.zone),
                  tr(strip.sky(utc).name), sun.elevation_deg,
                  compass_text(degrees(std::atan2(sun.direction.x, sun.direction.y))));
    if (strip.is_hidden(utc)) text += std::string("\n") + tr("behind the ground at the point");
    const float em = ImGui::GetFontSize();
    // Above the status line, which lies over everything.
    ImGui::SetNextWindowPos({ImGui::GetIO().MousePos.x, strip.top_px() - 2.2f * em},
                            ImGuiCond_Always, {0.5f, 1});
    ImGui::SetTooltip("%s\n%s", text.c_str(), moon_text(state).c_str());
}

void strip_row(State& state) {
    const float em = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float grab = std::floor(0.4f * em);
    const Strip strip(state, at, width, kStrip * em, grab);
    strip.draw();
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0.5f * (kStrip - 1) * em});
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, grab);
    for (const ImGuiCol of : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive})
        ImGui::PushStyleColor(of, IM_COL32_BLACK_TRANS);
    for (const ImGuiCol of : {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive})
        ImGui::PushStyleColor(of, style::kMark);
    const sun::TimeSpan& span = state.day.events.span;
    const int last = static_cast<int>(span.length_s() / 60) - 1;
    int minute = static_cast<int>(std::floor((state.document.utc - span.begin) / 60));
    ImGui::SetNextItemWidth(width);
    const bool moved = ImGui::SliderInt("##minute", &minute, 0, last, " ");
    ImGui::PopStyleColor(5);
    ImGui::PopStyleVar(2);
    state.sun_moves = state.sun_moves || ImGui::IsItemActive();
    state.step = state.step || ImGui::IsItemDeactivatedAfterEdit();
    const sun::Instant begin = span.begin;  // set_utc() may replace the day
    if (ImGui::IsItemHovered()) {
        tell(state, strip, strip.time_at(ImGui::GetIO().MousePos.x));
        if (const float notches = ImGui::GetIO().MouseWheel; notches != 0) {
            state.set_utc(state.document.utc + 600.0 * notches);
            state.sun_moves = true;
        }
    }
    if (moved) state.set_utc(begin + 60.0 * std::clamp(minute, 0, last));
}

void calendar(State& state, sun::Date date) {
    // The button has the width of the widest date, so that its neighbours do not move.
    // Translators: the widest date.
    const float width = ImGui::CalcTextSize(tr("30 September 2000")).x + ImGui::GetFontSize();
    if (ImGui::Button(
            fmt::format("{} {} {}###date", date.day, month_name(date.month), date.year).c_str(),
            {width, 0}))
        ImGui::OpenPopup("calendar");
    if (!ImGui::BeginPopup("calendar")) return;
    int year = date.year, month = date.month - 1;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(8.75f * em);
    if (ImGui::Combo("##month", &month, tr_all(kMonthNames).data(), 12))
        state.set_date(
            in_year({date.year, month + 1, std::min(date.day, days_in_month(date.year, month + 1))},
                    date.year));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(7.5f * em);
    if (ImGui::InputInt("##year", &year))
        state.set_date(in_year(date, std::clamp(year, kFirstYear, kLastYear)));
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
        if (chosen)
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(ImGuiCol_TextSelectedBg));
        if (ImGui::Button(fmt::format("{}##day", day).c_str(), cell)) {
            state.set_date({date.year, date.month, day});
            state.step = true;
            ImGui::CloseCurrentPopup();
        }
        if (chosen) ImGui::PopStyleColor();
        if ((offset + day) % 7 != 0) ImGui::SameLine(0, 0.25f * em);
    }
    ImGui::EndPopup();
}

/// @returns the wall clock's minute of "14:05", "1405", "14"
std::optional<int> minute_of(const std::string& text) {
    int hour = 0, minute = 0;
    char rest = 0;
    const bool is_clock = std::sscanf(text.c_str(), "%2d:%2d%c", &hour, &minute, &rest) == 2 ||
                          std::sscanf(text.c_str(), "%2d%2d%c", &hour, &minute, &rest) == 2 ||
                          std::sscanf(text.c_str(), "%2d%c", &hour, &rest) == 1;
    if (!is_clock || hour < 0 || hour > 23 || minute < 0 || minute > 59) return std::nullopt;
    return hour * 60 + minute;
}

/// "Europe/Vienna (UTC+02:00)"
std::string zone_text(const State& state) {
    const sun::LocalTime local = state.document.zone.local(state.document.utc);
    return fmt::format("{} (UTC{})", state.document.zone.name(),
                       sun::offset_text(local.utc_offset_s));
}

void clock(State& state) {
    std::string text = wall_clock(state.document.utc, state.document.zone);
    ImGui::SetNextItemWidth(3 * ImGui::GetFontSize());
    const bool is_entered = ImGui::InputText(
        "##clock", &text, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
        ImGui::SetTooltip("%s\n%s", tr("Time, then Enter: 14:05, 1405 or 14"),
                          zone_text(state).c_str());
    ImGui::SameLine();
    const sun::LocalTime local = state.document.zone.local(state.document.utc);
    ImGui::TextUnformatted(local.abbreviation.c_str());
    if (!is_entered) return;
    const std::optional<int> minute = minute_of(text);
    if (!minute) {
        state.message = tr_format("{}: expected a time of day, 00:00 to 23:59", text);
        return;
    }
    state.set_utc(DayMinute{state.day.date, *minute}.utc(state.document.zone));
    state.step = true;
}

/// "-1 m", "+1 w": buttons that go by months, weeks or days.
void steps(State& state, int sign) {
    struct Step {
        int months, days;
        const char *earlier, *later;
    };
    // Translators: a month, a week, a day.
    static constexpr std::array<Step, 3> kSteps = {{{1, 0, tr_later("-1 m"), tr_later("+1 m")},
                                                    {0, 7, tr_later("-1 w"), tr_later("+1 w")},
                                                    {0, 1, tr_later("-1 d"), tr_later("+1 d")}}};
    for (std::size_t i = 0; i < kSteps.size(); ++i) {
        const Step& step = kSteps[sign < 0 ? i : kSteps.size() - 1 - i];
        if (ImGui::Button(tr_label(sign < 0 ? step.earlier : step.later))) {
            const sun::Date date = state.day.date;
            const int month = date.year * 12 + date.month - 1 + sign * step.months;
            state.set_date(sun::add_days(in_year({date.year, month % 12 + 1, date.day}, month / 12),
                                         sign * step.days));
            state.step = true;
        }
        ImGui::SameLine();
    }
}

void play(State& state) {
    if (ImGui::Button(state.playing ? tr_label("Pause") : tr_label("Play"),
                      {3.8f * ImGui::GetFontSize(), 0}))
        state.playing = !state.playing;
    ImGui::SameLine();
    static constexpr std::array<double, 5> kSpeeds = {1.0 / 6, 0.5, 1, 3, 24};
    static constexpr std::array<const char*, 5> kNames = {"10 min/s", "30 min/s", "1 h/s", "3 h/s",
                                                          tr_later("1 day/s")};
    int speed = 0;
    for (std::size_t i = 0; i < kSpeeds.size(); ++i)
        if (kSpeeds[i] <= state.hours_a_second + 1e-9) speed = static_cast<int>(i);
    ImGui::SetNextItemWidth(5.6f * ImGui::GetFontSize());
    if (ImGui::Combo("##speed", &speed, tr_all(kNames).data(), static_cast<int>(kNames.size())))
        state.hours_a_second = kSpeeds[static_cast<std::size_t>(speed)];
    ImGui::SameLine();
    ImGui::Checkbox(tr_label("Pin"), &state.time_is_pinned);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s",
                          tr("Shows the next DEM at this time of day, even if it is night there"));
}

/// What there is room for on the right.
void words(const State& state) {
    for (const std::string& text : {zone_text(state), sun_figures(state)}) {
        ImGui::SameLine(0, ImGui::GetFontSize());
        if (ImGui::CalcTextSize(text.c_str()).x > ImGui::GetContentRegionAvail().x) return;
        ImGui::TextUnformatted(text.c_str());
    }
}

}  // namespace

const char* month_name(int month) {
    return tr(kMonthNames[static_cast<std::size_t>(month - 1)]);
}

void time_bar(State& state) {
    if (state.day.points.empty()) return;
    if (!state.moon) {  // once a frame, however often the day has changed
        const sun::Date date = state.day.date;
        const auto days = sun::moon_days(date, date, state.document.zone, state.centre);
        state.moon = days.empty() ? sun::MoonDay{} : days.front();
    }
    const float em = ImGui::GetFontSize();
    const Area& bar = state.layout.bar;
    ImGui::SetNextWindowPos({bar.at.x, bar.at.y});
    ImGui::SetNextWindowSize({bar.size.x, bar.size.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {kGap * em, kGap * em});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {2 * kGap * em, kGap * em});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2 * kGap * em, 0.5f * kGap * em});
    ImGui::Begin("##time", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
    strip_row(state);
    steps(state, -1);
    calendar(state, state.day.date);
    ImGui::SameLine();
    steps(state, 1);
    clock(state);
    ImGui::SameLine();
    if (ImGui::Button(tr_label("Now"))) state.commands.push_back(Command::Now);
    ImGui::SameLine();
    play(state);
    words(state);
    ImGui::End();
    ImGui::PopStyleVar(5);
}

}  // namespace relevo::viewer
