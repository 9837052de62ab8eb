#include "cli/sun_options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/files_of.h"
#include "geo/crs.h"
#include "geo/geodetic.h"
#include "image/image.h"
#include "sun/event_time.h"

namespace relevo::cli {
namespace {

/// A whole number; of one that an int does not hold it is said which years there are.
Check year_number() {
    return {[](const std::string& text) {
                const std::size_t sign = text.starts_with('-');
                const bool digits = text.size() > sign + 9 &&
                                    text.find_first_not_of("0123456789", sign) == text.npos;
                return digits ? fmt::format(
                                    "sun and moon are computed for the years {} to {}, but got {}",
                                    sun::kFirstYear, sun::kLastYear, text)
                              : whole_number().fault(text);
            },
            ""};
}

}  // namespace

void PlaceArguments::add_to(Verb verb) {
    verb.add_option("--at", at, "Place: LAT,LON[,H]").required();
    verb.add_option("--name", name, "Name of the place, for titles");
    verb.add_option("--eye-height", eye_height_m, "Height of the eye above the ground, m")
        .check(in_range(0.0, 10000.0));
}

void PlaceArguments::add_crs_to(Verb verb) {
    verb.add_option("--at-crs", crs, "CRS of --at, which is then X,Y[,H]: EPSG:n");
}

geo::PlaceText PlaceArguments::parse() const {
    if (crs.empty()) return geo::parse_place(at, "--at");
    const std::vector<std::string> parts = split(at, ',');
    const auto number = [&](std::size_t k) {
        return k < parts.size() ? parse_number(trimmed(parts[k])) : std::nullopt;
    };
    const std::optional<double> x = number(0), y = number(1);
    if (!x || !y)
        bad_usage(fmt::format("--at: {}: expected X,Y in {} but got other text", at, crs));
    geo::PlaceText place =
        geo::parse_place(parts.size() > 2 ? "0,0," + parts[2] : std::string("0,0"), "--at");
    const geo::Geodetic found = geo::Crs::parse(crs, "--at-crs").to_geodetic(*x, *y);
    if (!std::isfinite(found.lat_rad) || !std::isfinite(found.lon_rad))
        bad_input(fmt::format("--at: {}: no place on Earth in {}", at, crs));
    place.place.lat_rad = found.lat_rad;
    place.place.lon_rad = found.lon_rad;
    return place;
}

void DaysArguments::add_to(Verb verb) {
    verb.add_option("--date", date, "Day: 2026-06-21");
    verb.add_option("--from", from, "First day of a range");
    verb.add_option("--to", to, "Last day of the range");
    add_year_to(verb);
}

void DaysArguments::add_year_to(Verb verb) {
    verb.add_option("--year", year, "All days of a year, 1900 to 2100").check(year_number());
    verb.add_option("--tz", zone,
                    "Time zone of the days: Europe/Zurich, +05:30, solar, or auto, that of the "
                    "place (auto)");
}

DaysArguments::Days DaysArguments::parse(const geo::Geodetic& place, bool tell) const {
    const int ways = !date.empty() + (!from.empty() || !to.empty()) + year.has_value();
    if (ways == 0)
        bad_usage("--date: missing; pass --date 2026-06-21, --from and --to, or --year 2026");
    if (ways > 1) bad_usage("--date, --from with --to, and --year exclude each other; use one");
    if (from.empty() != to.empty())
        bad_usage(from.empty() ? "--to needs --from" : "--from needs --to");
    Days days;
    if (year) {
        if (*year < sun::kFirstYear || *year > sun::kLastYear)
            bad_input(fmt::format("--year: {}: sun and moon are computed for the years {} to {}",
                                  *year, sun::kFirstYear, sun::kLastYear));
        days.first = {*year, 1, 1};
        days.last = {*year, 12, 31};
    } else if (!date.empty()) {
        days.first = days.last = sun::parse_date(date);
        days.single = true;
    } else {
        days.first = sun::parse_date(from);
        days.last = sun::parse_date(to);
        if (days.last < days.first)
            bad_input(
                fmt::format("--from {} --to {}: ends before it begins, expected the earlier "
                            "day first",
                            from, to));
    }
    sun::ChosenZone chosen = tell ? session::zone_of(zone, place) : sun::choose_zone(zone, place);
    days.zone = std::move(chosen.zone);
    days.assumption = std::move(chosen.assumption);
    if (days.single) days.zone.day(days.first);  // says so where the zone skipped it
    return days;
}

double step_s_of(const std::string& step, double least_s, double most_s) {
    const auto step_s = sun::parse_step_s(step);
    if (!step_s || *step_s < least_s || *step_s > most_s)
        bad_usage(fmt::format(
            "--step: expected {:.10g}s to {:.10g}h, such as 30s, 3min or minutes alone, "
            "but got {}",
            least_s, most_s / 3600, printable(step)));
    return *step_s;
}

void LightArguments::add_to(Verb verb) {
    refraction.add_to(verb, body);
    verb.add_option("--limb", limb,
                    fmt::format("Part of the {} disc that counts: upper, center, lower",
                                body == sun::Body::Sun ? "solar" : "lunar"))
        .check(one_of({"upper", "center", "lower"}));
}

void LightArguments::add_dip_to(Verb verb) {
    verb.add_option("--dip", dip_deg, "Dip of a flat horizon, degrees; default: from --eye-height")
        .check(in_range(0.0, 5.0));
}

namespace {

sun::Limb limb_of(const std::optional<std::string>& text, sun::Limb otherwise) {
    if (!text) return otherwise;
    return *text == "upper"   ? sun::Limb::Upper
           : *text == "lower" ? sun::Limb::Lower
                              : sun::Limb::Center;
}

}  // namespace

sun::RiseRule LightArguments::rule(const geo::Geodetic& place,
                                   const std::optional<double>& eye_height_m) const {
    if (!limb && !refraction.given() && !eye_height_m && !dip_deg)
        return sun::RiseRule::almanac(body);
    if (dip_deg && eye_height_m) bad_usage("--dip and --eye-height exclude each other; use one");
    const sun::Limb part = limb_of(limb, sun::Limb::Upper);
    if (dip_deg)
        return sun::RiseRule::seen_over_dip(part, refraction.at(place), radians(*dip_deg), body);
    return sun::RiseRule::seen(part, refraction.at(place), eye_height_m.value_or(0), body);
}

light::LightOptions LightArguments::light(const geo::Geodetic& place,
                                          const std::optional<double>& eye_height_m) const {
    light::LightOptions options;
    options.body = body;
    options.limb = limb_of(limb, sun::Limb::Center);
    options.refraction = refraction.at(place);
    options.flat.rule = rule(place, eye_height_m);
    return options;
}

void TerrainArguments::add_to(Verb verb) {
    dem.add_to(verb);
    add_number(verb, figure::kTerrestrialRefraction, refraction, "-k,").group("Horizon");
    add_number(verb, figure::kHighestAtPoint_m, highest_m).group("Horizon");
}

light::HorizonOptions TerrainArguments::horizon(const geo::PlaceText& at,
                                                const std::optional<double>& eye_height_m) const {
    if (at.has_height && eye_height_m)
        bad_usage("--eye-height and a height in --at exclude each other; use one");
    light::HorizonOptions options;
    options.refraction = refraction;
    options.eye_height_m = at.has_height ? at.place.height_m : eye_height_m.value_or(0);
    options.eye_above_ground = at.above_ground || !at.has_height;
    return options;
}

std::unique_ptr<TerrainView> TerrainArguments::view_from(const PlaceArguments& place) const {
    const geo::PlaceText at = place.parse();
    const light::HorizonOptions options = horizon(at, place.eye_height_m);
    return std::make_unique<TerrainView>(load(), at.place, options);
}

namespace {

/// Directions that follow each other but for less than five degrees are one for a reader.
template <typename Sector, typename Join>
std::vector<Sector> merged(const std::vector<Sector>& sectors, const Join& join) {
    std::vector<Sector> result;
    for (const Sector& sector : sectors) {
        if (!result.empty() &&
            sector.from_azimuth_rad - result.back().to_azimuth_rad < radians(5)) {
            result.back().to_azimuth_rad = sector.to_azimuth_rad;
            join(result.back(), sector);
        } else {
            result.push_back(sector);
        }
    }
    return result;
}

std::string sector_text(const light::Sector& sector) {
    const double from_deg = degrees(sector.from_azimuth_rad);
    const double to_deg = degrees(sector.to_azimuth_rad);
    if (std::lround(from_deg) == std::lround(to_deg))
        return fmt::format("at azimuth {:.0f} ({})", from_deg, compass_point(from_deg));
    return fmt::format("from azimuth {:.0f} ({}) to {:.0f} ({})", from_deg, compass_point(from_deg),
                       to_deg, compass_point(to_deg));
}

std::string matters_text(const light::Doubt& doubt) {
    switch (doubt.matters) {
        case light::Matters::Sun:
            return fmt::format("hide the {}", name_of(doubt.body));
        case light::Matters::Alignment:
            return "hide the summit or the sun";
        default:
            return "raise the horizon";
    }
}

void warn_of_the_edge(const light::Doubt& doubt) {
    std::vector<std::string> parts;
    for (const light::OpenSector& s :
         merged(doubt.open, [](light::OpenSector&to, const light::OpenSector&of) {
             to.reach_m = std::min(to.reach_m, of.reach_m);
             to.needed_m = std::max(to.needed_m, of.needed_m);
             to.least_m = std::min(to.least_m, of.least_m);
         }))
        parts.push_back(fmt::format(
            "above {:.0f} m {} as far as {:.0f} km away, where the DEM reaches {:.1f} km",
            s.least_m, sector_text(s), s.needed_m / 1000, s.reach_m / 1000));
    if (parts.empty()) return;
    const std::string earths =
        doubt.earths_needed_m
            ? fmt::format("; those of up to {:.0f} m (the Earth's highest) as far as {:.0f} km",
                          light::kHighestTerrain_m, *doubt.earths_needed_m / 1000)
            : "";
    log::warning(
        fmt::format("mountains of up to {:.0f} m{} outside the DEM could {}: {}{}; use a larger "
                    "DEM, or bound them with --highest",
                    doubt.highest_m, doubt.earths_needed_m ? " (the DEM's highest post)" : "",
                    matters_text(doubt), fmt::join(parts, ", and "), earths));
}

void warn_of_holes(const light::Doubt& doubt) {
    if (doubt.holes.empty()) return;
    log::warning(fmt::format(
        "the DEM has voids {}: {}; use a DEM without voids", sectors_text(doubt.holes),
        doubt.matters == light::Matters::Sun
            ? fmt::format("of the direct {} {} is not known, as ground in them could hide it",
                          doubt.body == sun::Body::Sun ? "sun" : "moonlight",
                          hours_text(std::max(1.0, doubt.not_known_s)))
            : "ground in them could raise the horizon"));
}

/// From a summit the sun is seen so much below the level horizon; ground that is not there, too.
void say_that_more_is_lit(const light::Doubt& doubt) {
    constexpr double kUsual_rad = radians(0.5);
    if (!doubt.lowest_sun || doubt.lowest_sun->elevation_rad > -kUsual_rad) return;
    const double azimuth_deg = degrees(doubt.lowest_sun->azimuth_rad);
    log::info(
        fmt::format("more {} than over a level horizon: it shines from {:.1f} degrees below "
                    "at azimuth {:.0f} ({}), over lower ground",
                    name_of(doubt.body), -degrees(doubt.lowest_sun->elevation_rad), azimuth_deg,
                    compass_point(azimuth_deg)));
}

}  // namespace

void warn_of(const light::Doubt& doubt) {
    say_that_more_is_lit(doubt);
    warn_of_the_edge(doubt);
    warn_of_holes(doubt);
}

std::string sectors_text(const std::vector<light::Sector>& sectors) {
    std::vector<std::string> parts;
    for (const light::Sector& sector : merged(sectors, [](light::Sector&, const light::Sector&) {}))
        parts.push_back(sector_text(sector));
    return fmt::format("{}", fmt::join(parts, ", and "));
}

nlohmann::ordered_json sectors_json(const std::vector<light::Sector>& sectors) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const light::Sector& s : sectors)
        array.push_back({{"from_azimuth_deg", angle_deg(s.from_azimuth_rad)},
                         {"to_azimuth_deg", angle_deg(s.to_azimuth_rad)}});
    return array;
}

nlohmann::ordered_json spans_json(const std::vector<sun::TimeSpan>& spans) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const sun::TimeSpan& span : spans)
        array.push_back({{"begin_utc", utc_json(span.begin)}, {"end_utc", utc_json(span.end)}});
    return array;
}

void OutputArguments::add_to(Verb verb, const std::vector<std::string>& endings_of_verb) {
    endings = endings_of_verb;
    verb.add_option("-o,--output", path, fmt::format("Write {}", fmt::join(endings, ", ")));
    verb.add_flag("--overwrite", overwrite, "Replace an existing file");
    verb.add_option("--scale", scale, "Pixels of a PNG per unit of the drawing (1.5)")
        .check(in_range(0.25, 8.0));
    const Option csv_flag = verb.add_flag("--csv", csv, "CSV on standard output");
    verb.add_flag("--json", json, "One JSON object on standard output").excludes(csv_flag);
}

OutputFile* OutputArguments::open(FilesInUse& files, const DemArguments& dem) const {
    if (path.empty()) return nullptr;
    check_ending();
    dem::add_named(dem.paths, files);
    OutputFile& file = files.open_output(path, overwrite, "-o");
    dem::add_all(dem.paths, files);
    return &file;
}

void OutputArguments::deliver(const Forms& forms, OutputFile* file) const {
    if (file) {
        const std::string form = ending();
        if (form == "png") {
            const chart::Drawing drawing = forms.drawing();
            image::write(*file, chart::to_image(drawing, scale),
                         {{"Software", "Relevo " RELEVO_VERSION},
                          {"Title", drawing.title()},
                          {"Description", drawing.description()}});
        } else {
            file->write(form == "svg"    ? chart::to_svg(forms.drawing())
                        : form == "json" ? json_text(forms.json())
                                         : forms.csv());
        }
        file->finish();
    }
    if (json)
        fmt::print("{}", json_text(forms.json()));
    else if (csv)
        fmt::print("{}", forms.csv());
    else if (path.empty())
        forms.print();
}

nlohmann::ordered_json place_json(const geo::Geodetic& place) {
    return {{"lat_deg", angle_deg(place.lat_rad)},
            {"lon_deg", angle_deg(place.lon_rad)},
            {"height_m", place.height_m}};
}

void add_assumption(nlohmann::ordered_json& json, const std::string& assumption) {
    if (!assumption.empty()) json["assumptions"] = {assumption};
}

double angle_deg(double angle_rad) {
    return std::round(degrees(angle_rad) * 1e8) / 1e8;
}

nlohmann::ordered_json utc_json(const std::optional<sun::Instant>& utc) {
    if (!utc) return nullptr;
    return sun::to_iso(*utc, 3);
}

std::string clock_text(sun::Instant utc, const sun::Zone& zone) {
    const sun::CivilTime wall = zone.local(utc + 0.5).wall;
    return fmt::format("{:02}:{:02}:{:02}", wall.hour, wall.minute, wall.second);
}

std::string hours_text(double seconds) {
    const long whole = std::lround(seconds);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string csv_remarks(const std::vector<std::string>& remarks) {
    std::string text;
    for (const std::string& remark : remarks)
        text += "# " + remark + "\n";
    return text;
}

}  // namespace relevo::cli
