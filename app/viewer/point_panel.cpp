#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/overlay.h"
#include "viewer/state.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

std::string duration_text(double seconds) {
    const auto minutes = static_cast<int>(std::lround(seconds / 60));
    return tr_format("{} h {:02} min", minutes / 60, minutes % 60);
}

/// "in the sun until 15:03".
std::string light_words(const PointLight& point, sun::Instant now, const sun::Zone& zone) {
    const auto next = point.next_change(now);
    if (point.is_lit(now))
        return next ? tr_format("in the sun until {}", clock_label(*next, zone))
                    : tr("in the sun until midnight");
    if (next) return tr_format("in shade until {}", clock_label(*next, zone));
    std::string text = point.lit.empty() ? tr("no sun today") : tr("no more sun today");
    if (point.tomorrow)
        text += tr_format(", tomorrow from {}", clock_label(*point.tomorrow, zone));
    else if (point.tomorrow_is_known)
        text += tr(", nor tomorrow");
    return text;
}

/// Duration of a period of sun between its displayed ends.
std::string span_text(const LitSpan& span) {
    static const sun::Instant kAny = sun::Instant::from_utc({{2000, 1, 1}});
    const auto minute = [](sun::Instant utc) { return std::floor((utc - kAny + 30) / 60); };
    return fmt::format("  ({})", duration_text(60 * (minute(span.end) - minute(span.begin))));
}

/// "no sun at all on 34 days, 30 of them from 8 Dec to 6 Jan"
std::string dark_text(const YearPicture& year) {
    if (year.dark_days == 0) return tr("direct sun on every day of the year");
    std::string text = tr_format_plural("no direct sun on {} day", "no direct sun on {} days",
                                        static_cast<std::size_t>(year.dark_days));
    if (year.dark_row < year.dark_days) text += tr_format(", {} of them", year.dark_row);
    const auto& [first, last] = year.dark;
    return text + (first == last ? ", " + day_label(first)
                                 : tr_format(", {} to {}", day_label(first), day_label(last)));
}

/// Warns of voids and unmodelled terrain.
void doubts(const PointLight& point) {
    if (point.not_known_s > 0)
        ImGui::TextWrapped("%s", tr_format("{} of it are uncertain because of voids in the DEM.",
                                           duration_text(point.not_known_s))
                                     .c_str());
    if (point.open_deg.empty()) return;
    std::string where;
    for (const glm::dvec2& open : point.open_deg) {
        where += fmt::format("{}{:.0f}°", where.empty() ? "" : ", ", open.x);
        if (std::lround(open.x) != std::lround(open.y)) where += tr_format(" to {:.0f}°", open.y);
    }
    ImGui::TextWrapped(
        "%s", tr_format("Mountains outside the DEM may hide more: azimuth {}.", where).c_str());
}

/// "06:45, over ground 2.3 km ENE, 4.1° high", after a button that goes there.
void edge_row(State& state, const char* name, sun::Instant utc, const Ridge& ridge) {
    if (ImGui::SmallButton(name)) {
        state.set_utc(utc);
        state.step = true;
    }
    ImGui::SameLine();
    const std::string where =
        std::isnan(ridge.distance_m)
            ? tr_format("{} at a level horizon", compass_text(ridge.azimuth_deg))
            : tr_format("over ground {} {}, {:.1f}° high", length_text(ridge.distance_m),
                        compass_text(ridge.azimuth_deg), ridge.elevation_deg);
    ImGui::TextUnformatted(where.c_str());
}

void light_of(State& state, const PointLight& point) {
    const sun::Zone& zone = state.document.zone;
    const bool lit = point.is_lit(state.document.utc);
    ImGui::TextColored(lit ? style::lit() : style::shaded(), "%s",
                       light_words(point, state.document.utc, zone).c_str());
    for (const LitSpan& span : point.lit) {
        const std::string from =
            span.from_midnight ? tr("midnight") : clock_label(span.begin, zone);
        const std::string to = span.to_midnight ? tr("midnight") : clock_label(span.end, zone);
        ImGui::TextUnformatted(
            (tr_format("{} to {}", from, to) + (point.lit.size() > 1 ? span_text(span) : ""))
                .c_str());
    }
    if (!point.lit.empty() && !point.lit.front().from_midnight)
        edge_row(state, tr_label("First light"), point.lit.front().begin,
                 point.lit.front().begins_over);
    if (!point.lit.empty() && !point.lit.back().to_midnight)
        edge_row(state, tr_label("Last light"), point.lit.back().end, point.lit.back().ends_over);
    ImGui::TextUnformatted(tr_format("{} of sun, {} over a level horizon",
                                     duration_text(point.lit_s), duration_text(point.flat_s))
                               .c_str());
    if (point.year)
        ImGui::TextUnformatted(tr_format("{:.0f} h in {}, {:.0f} h over a level horizon",
                                         point.year->lit_s / 3600, point.of.date.year,
                                         point.year->level_s / 3600)
                                   .c_str());
    if (point.year) ImGui::Text("%s", dark_text(*point.year).c_str());
    doubts(point);
}

}  // namespace

void point_menu(State& state, bool opens) {
    if (opens) ImGui::OpenPopup("point");
    if (!ImGui::BeginPopup("point")) return;
    if (ImGui::MenuItem(tr_label("Stand here"))) state.commands.push_back(Command::StandHere);
    if (ImGui::MenuItem(tr_label("Look there"))) state.commands.push_back(Command::LookThere);
    if (ImGui::MenuItem(tr_label("When the sun stands over it")))
        state.commands.push_back(Command::SunOverPoint);
    if (ImGui::MenuItem(tr_label("When the moon stands over it")))
        state.commands.push_back(Command::MoonOverPoint);
    if (ImGui::MenuItem(tr_label("Measure from here"), "M"))
        state.commands.push_back(Command::Measure);
    if (state.chosen && ImGui::MenuItem(tr_label("Copy coordinates")))
        ImGui::SetClipboardText(
            coordinates_text(*state.chosen, state.settings.coordinates).c_str());
    ImGui::EndPopup();
}

void point_panel(State& state) {
    if (!state.chosen) {
        ImGui::TextDisabled("%s", tr("Click the ground to see its direct sun of the day."));
        return;
    }
    const geo::Geodetic& place = *state.chosen;
    for (const Coordinates kind : {Coordinates::Degrees, Coordinates::Utm, Coordinates::Mgrs})
        ImGui::Text("%s%s", kind == Coordinates::Mgrs ? "MGRS " : "",
                    coordinates_text(place, kind).c_str());
    ImGui::TextUnformatted(tr_format("height {:.1f} m", place.height_m).c_str());
    if (ImGui::SmallButton(tr_label("Stand here"))) state.commands.push_back(Command::StandHere);
    ImGui::SameLine();
    if (ImGui::SmallButton(tr_label("Look there"))) state.commands.push_back(Command::LookThere);
    if (state.point && !state.point->error.empty())
        ImGui::TextWrapped("%s", state.point->error.c_str());
    else if (state.is_preview)
        ImGui::TextDisabled("%s", tr("waiting until all posts are read ..."));
    else if (!state.point || state.point->of.date != state.day.date)
        ImGui::TextDisabled("%s", tr("computing its horizon ..."));
    else
        light_of(state, *state.point);
    ImGui::Checkbox(tr_label("Horizon and year (P)"), &state.settings.charts);
}

}  // namespace relevo::viewer
