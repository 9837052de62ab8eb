#include "cli/day_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "cli/sun_options.h"
#include "geo/format.h"

namespace relevo::cli {

using nlohmann::ordered_json;

namespace {

std::string word_of(sun::EventKind kind) {
    std::string word(sun::name_of(kind));
    std::ranges::replace(word, '_', ' ');
    return word;
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

/// @param light  of the terrain
/// @param holes  what is not known for holes
std::string columns_of(const DayResult::Words& words, bool light, bool holes) {
    std::string text = words.first_columns;
    for (const sun::EventKind kind : words.kinds)
        text += fmt::format(",{}", sun::name_of(kind));
    text += words.last_columns;
    if (light) text += fmt::format(",{0},{0}_h", words.light);
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

std::vector<sun::TimeSpan> not_known_of(const std::vector<light::LitInterval>& lit) {
    std::vector<sun::TimeSpan> spans;
    for (const light::LitInterval& interval : lit)
        spans.insert(spans.end(), interval.not_known.begin(), interval.not_known.end());
    return spans;
}

std::optional<light::DirectLight> find_light(const DayArguments& arguments,
                                             const geo::PlaceText& at,
                                             const light::TerrainHorizon* horizon,
                                             DayResult& result) {
    if (!horizon) check_has_ground(at);
    const std::optional<double>& eye_height_m = arguments.place.eye_height_m;
    result.place = horizon ? horizon->place() : at.place;
    result.definition = arguments.light.rule(result.place, eye_height_m).description();
    if (!horizon) return {};
    light::DirectLight direct(*horizon, arguments.light.light(result.place, eye_height_m));
    result.light = direct.days(result.asked.first, result.asked.last, result.asked.zone);
    result.doubt = light::doubt_of(direct, result.light, horizon->profile(kDoubtDirections),
                                   arguments.terrain.highest_m);
    result.light_definition = direct.definition();
    result.horizon_definition = horizon->description();
    return direct;
}

ordered_json json_of(const DayResult& result, std::size_t days,
                     const std::function<ordered_json(std::size_t)>& day_json) {
    ordered_json json;
    json["place"] = place_json(result.place);
    json["zone"] = result.asked.zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = result.definition;
    json[result.words.key] = result.words.definition;
    if (!result.light.empty()) {
        json["light_definition"] = result.light_definition;
        json["horizon_definition"] = result.horizon_definition;
    }
    if (result.has_holes()) json["hole_sectors"] = sectors_json(result.doubt.holes);
    const auto with_light = [&](std::size_t i) {
        ordered_json day = day_json(i);
        if (result.light.empty()) return day;
        const std::string key = result.words.light;
        day[key] = lit_json(result.light[i].lit);
        day[key + "_h"] = result.light[i].lit_s / 3600;
        if (result.has_holes()) day["not_known_h"] = result.light[i].not_known_s / 3600;
        return day;
    };
    if (result.asked.single) {
        json.update(with_light(0));
        return json;
    }
    ordered_json& all = json["days"] = ordered_json::array();
    for (std::size_t i = 0; i < days; ++i)
        all.push_back(with_light(i));
    return json;
}

std::string light_columns(const DayResult& result, std::size_t day, bool holes) {
    if (result.light.empty()) return {};
    const light::LightDay& light = result.light[day];
    const sun::Zone& zone = result.asked.zone;
    std::vector<sun::TimeSpan> lit;
    for (const light::LitInterval& interval : light.lit)
        lit.push_back({interval.begin.utc, interval.end.utc});
    std::string text = fmt::format(",{},{:.4f}", spans_of(lit, zone), light.lit_s / 3600);
    if (holes)
        text += fmt::format(",{},{:.4f}", spans_of(not_known_of(light.lit), zone),
                            light.not_known_s / 3600);
    return text;
}

void print_head(const DayResult& result) {
    const DaysArguments::Days& asked = result.asked;
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

std::string csv_of(const DayResult& result, const std::vector<std::string>& rows) {
    std::string text = csv_remarks(definitions_of(result)) +
                       columns_of(result.words, !result.light.empty(), result.has_holes()) + "\n";
    for (const std::string& row : rows)
        text += row + "\n";
    return text;
}

void run_days(const DayArguments& arguments, const DayResult::Words& words,
              decltype(DayFigure::forms) forms) {
    run_days(arguments,
             {.columns = [&](bool terrain) { return columns_of(words, terrain, terrain); },
              .remarks = {words.definition},
              .forms = std::move(forms)});
}

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
