#include "cli/day_parts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "cli/sun_options.h"

namespace relevo::cli {

using nlohmann::ordered_json;

namespace {

std::string word_of(sun::EventKind kind) {
    std::string word(sun::name_of(kind));
    std::ranges::replace(word, '_', ' ');
    return word;
}

}  // namespace

ordered_json events_json(const std::vector<sun::Event>& events, const sun::Zone& zone) {
    ordered_json json = ordered_json::array();
    for (const sun::Event& event : events)
        json.push_back({{"kind", sun::name_of(event.kind)},
                        {"utc", utc_json(event.utc)},
                        {"local", sun::to_iso(event.utc, zone)},
                        {"azimuth_deg", angle_deg(event.azimuth_rad)},
                        {"elevation_deg", angle_deg(event.elevation_rad)}});
    return json;
}

ordered_json lit_json(const std::vector<light::LitInterval>& lit) {
    ordered_json json = ordered_json::array();
    for (const light::LitInterval& interval : lit) {
        json.push_back({{"first_utc", utc_json(interval.begin.utc)},
                        {"last_utc", utc_json(interval.end.utc)},
                        {"first_azimuth_deg", angle_deg(interval.begin.azimuth_rad)},
                        {"last_azimuth_deg", angle_deg(interval.end.azimuth_rad)},
                        {"first_apparent_elevation_deg", angle_deg(interval.begin.elevation_rad)},
                        {"last_apparent_elevation_deg", angle_deg(interval.end.elevation_rad)},
                        {"from_midnight", interval.begin.midnight},
                        {"to_midnight", interval.end.midnight}});
        if (!interval.not_known.empty()) json.back()["not_known"] = spans_json(interval.not_known);
    }
    return json;
}

std::string spans_of(const std::vector<sun::TimeSpan>& spans, const sun::Zone& zone) {
    std::string joined;
    for (const sun::TimeSpan& span : spans)
        joined += fmt::format("{}{}/{}", joined.empty() ? "" : ";", sun::to_iso(span.begin, zone),
                              sun::to_iso(span.end, zone));
    return joined;
}

std::string spans_of(const std::vector<light::LitInterval>& lit, const sun::Zone& zone) {
    std::vector<sun::TimeSpan> spans;
    for (const light::LitInterval& interval : lit)
        spans.push_back({interval.begin.utc, interval.end.utc});
    return spans_of(spans, zone);
}

std::vector<sun::TimeSpan> not_known_of(const std::vector<light::LitInterval>& lit) {
    std::vector<sun::TimeSpan> spans;
    for (const light::LitInterval& interval : lit)
        spans.insert(spans.end(), interval.not_known.begin(), interval.not_known.end());
    return spans;
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
        light, sectors_text(doubt.holes));
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
