#include "cli/day_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "cli/sun_options.h"
#include "geo/format.h"

namespace relevo::cli {

namespace {

std::string word_of(sun::EventKind kind) {
    std::string word(sun::name_of(kind));
    std::ranges::replace(word, '_', ' ');
    return word;
}

/// @param light  of the terrain
/// @param holes  what is not known for holes
std::string columns_of(const DayWords& words, bool light, bool holes) {
    std::string text = words.first_columns;
    for (const sun::EventKind kind : words.kinds)
        text += fmt::format(",{}", sun::name_of(kind));
    text += words.last_columns;
    if (light)
        text += fmt::format(",{0},{0}_h,first_{1},last_{1},minutes", words.light, words.body);
    return text + (holes ? ",not_known,not_known_h" : "");
}

std::vector<std::string> definitions_of(const DayResult& result) {
    std::vector<std::string> definitions{result.definition, result.words.definition};
    if (!result.light.empty()) {
        definitions.push_back(result.light_definition);
        definitions.push_back(result.horizon_definition);
    }
    if (result.has_holes()) {
        std::string light = result.words.light;
        std::ranges::replace(light, '_', ' ');
        definitions.push_back(not_known_text(result.doubt, light.c_str()));
    }
    return definitions;
}

}  // namespace

std::string light_columns(const DayResult& result, std::size_t day, bool holes) {
    if (result.light.empty()) return {};
    const light::LightDay& light = result.light[day];
    const sun::Zone& zone = result.asked.zone;
    std::vector<sun::TimeSpan> lit;
    for (const light::LitInterval& interval : light.lit)
        lit.push_back({interval.begin.utc, interval.end.utc});
    const auto time = [&](sun::Instant utc) { return sun::to_iso(utc, zone); };
    std::string text = fmt::format(",{},{:.4f},{},{},{:.2f}", spans_of(lit, zone),
                                   light.lit_s / 3600, lit.empty() ? "" : time(lit.front().begin),
                                   lit.empty() ? "" : time(lit.back().end), light.lit_s / 60);
    if (holes)
        text += fmt::format(",{},{:.4f}", spans_of(not_known_of(light.lit), zone),
                            light.not_known_s / 3600);
    return text;
}

void print_head(const DayResult& result) {
    const report::Days& asked = result.asked;
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(result.place),
               result.place.height_m);
    if (asked.single)
        fmt::print("date                {}, {}\n", sun::to_string(asked.first), asked.zone.name());
    else
        fmt::print("dates               {} to {}, {}\n", sun::to_string(asked.first),
                   sun::to_string(asked.last), asked.zone.name());
}

void print_definitions(const DayResult& result) {
    fmt::print("\n");
    for (const std::string& definition : definitions_of(result))
        fmt::print("{}\n", definition);
}

std::string table_of(const DayResult& result, const std::vector<std::string>& rows) {
    std::string text = csv_remarks(definitions_of(result)) +
                       columns_of(result.words, !result.light.empty(), result.has_holes()) + "\n";
    for (const std::string& row : rows)
        text += row + "\n";
    return text;
}

void run_days(const DayArguments& arguments, const DayWords& words,
              decltype(DayFigure::forms) forms) {
    run_days(arguments,
             {.columns = [&](bool terrain) { return columns_of(words, terrain, terrain); },
              .remarks = {words.definition},
              .forms = std::move(forms)});
}

std::string spans_of(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone) {
    std::string joined;
    for (const sun::TimeSpan& span : spans)
        joined += fmt::format("{}{}/{}", joined.empty() ? "" : ";", sun::to_iso(span.begin, zone),
                              sun::to_iso(span.end, zone));
    return joined;
}

std::string spans_text(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone) {
    std::string text;
    for (const sun::TimeSpan& span : spans)
        text += fmt::format("{}{} to {}", text.empty() ? "" : ", ", clock_text(span.begin, zone),
                            clock_text(span.end, zone));
    return text.empty() ? "none" : text;
}

std::string not_known_text(const light::LightDay& day) {
    if (day.not_known_s <= 0) return {};
    return fmt::format(", of it {} not known", hours_text(std::max(1.0, day.not_known_s)));
}

std::string not_known_text(const light::Doubt& doubt, const char* light) {
    return fmt::format(
        "not known: {} through voids of the DEM {}, where ground as high as its highest post would "
        "hide it",
        light, report::sectors_text(doubt.holes));
}

double printed_azimuth_deg(double azimuth_rad) {
    return std::fmod(std::round(degrees(azimuth_rad) * 100) / 100, 360.0);
}

void print_events(const std::vector<sun::Event>& events, const sun::Zone& zone) {
    for (const sun::Event& event : events) {
        const double azimuth_deg = printed_azimuth_deg(event.azimuth_rad);
        fmt::print("{:<20}{}  azimuth {:6.2f} {:<4}", word_of(event.kind),
                   sun::to_iso(event.utc, zone), azimuth_deg, compass_point(azimuth_deg));
        if (event.kind == sun::EventKind::Transit || event.kind == sun::EventKind::LowerTransit)
            fmt::print(" elevation {:6.2f} without refraction", degrees(event.elevation_rad));
        fmt::print("\n");
    }
}

void print_lit(const light::LightDay& day, const char* light, const sun::Zone& zone) {
    for (const light::LitInterval& lit : day.lit)
        fmt::print("{:<20}{} to {}  azimuth {:6.2f} to {:6.2f}{}\n", light,
                   lit.begin.midnight ? "midnight" : clock_text(lit.begin.utc, zone),
                   lit.end.midnight ? "midnight" : clock_text(lit.end.utc, zone),
                   printed_azimuth_deg(lit.begin.azimuth_rad),
                   printed_azimuth_deg(lit.end.azimuth_rad),
                   lit.not_known.empty() ? ""
                   : lit.all_unknown()   ? "  not known: a void of the DEM"
                                         : fmt::format("  not known {}: a void of the DEM",
                                                       spans_text(lit.not_known, zone)));
    if (day.lit.empty()) fmt::print("{:<20}none\n", light);
    fmt::print("{:<20}{}{}\n", fmt::format("{}, total", light), hours_text(day.lit_s),
               not_known_text(day));
}

}  // namespace relevo::cli
