#include "cli/sun_options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/text.h"
#include "geo/crs.h"
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

/// What is wrong with a number; empty: nothing. @param more  said in addition
std::string fault_in(const figure::Range& range, const std::string& text, const char* more) {
    const auto number = parse_number(text);
    if (number && *number >= range.min && *number <= range.max) return {};
    return fmt::format("expected {} to {}{}", range.min, range.max,
                       fmt::format(fmt::runtime(more), text));
}

}  // namespace

std::string fault_of_tilt(const std::string& text) {
    if (text == "ground") return {};
    return fault_in(figure::kTilt_deg, text, " degrees, or ground, but got {}");
}

std::string fault_of_azimuth(const std::string& text) {
    return fault_in(figure::kAzimuth_deg, text,
                    " degrees, clockwise from true north, but got {}; PVGIS counts from south: add "
                    "180");
}

void PlaceArguments::add_to(Verb verb) {
    verb.add_option("--at", at, "Place: LAT,LON[,H]").required();
    verb.add_option("--name", name, "Name of the place, for titles");
    verb.add_option("--eye-height", eye_height_m, "Height of the eye above the ground, m")
        .check(in_range(0.0, 10000.0));
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

report::Days DaysArguments::parse(const geo::Geodetic& place, bool tell) const {
    return tell ? DaysText::parse(place, session::zone_of)
                : DaysText::parse(place, sun::choose_zone);
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

report::View LightArguments::view() const {
    report::View view;
    view.body = body;
    if (refraction.given()) view.refraction = refraction.name();
    view.limb = limb;
    view.dip_deg = dip_deg;
    return view;
}

void TerrainArguments::add_to(Verb verb) {
    dem.add_to(verb);
    dem.add_surroundings_to(verb);
    add_number(verb, figure::kTerrestrialRefraction, refraction, "-k,").group("Horizon");
    add_number(verb, figure::kHighestAtPoint_m, highest_m).group("Horizon");
}

report::View TerrainArguments::view(const std::optional<double>& eye_height_m,
                                    report::View light) const {
    light.eye_height_m = eye_height_m;
    light.terrestrial_refraction = refraction;
    light.highest_m = highest_m;
    return light;
}

void OutputArguments::add_to(Verb verb, const std::vector<std::string>& endings_of_verb) {
    endings = endings_of_verb;
    schema = schema_of(verb);
    verb.add_option("-o,--output", paths,
                    fmt::format("Write {}; may be repeated", fmt::join(endings, ", ")))
        .one_word();
    verb.add_flag("--overwrite", overwrite, "Replace an existing file");
    verb.add_option("--scale", scale, "Pixels of a PNG per unit of the drawing (1.5)")
        .check(in_range(0.25, 8.0));
    const Option csv_flag = verb.add_flag("--csv", csv, "CSV on standard output");
    verb.add_flag("--json", json, "One JSON object on standard output").excludes(csv_flag);
}

OutputFile* open_result(const ResultArguments& result, FilesInUse& files, const DemArguments& dem) {
    result.check_ending();
    dem.add_named(files);
    OutputFile& file = files.open_output(result.path, result.overwrite, "-o");
    dem.add_all(files);
    return &file;
}

OpenResults OutputArguments::open(FilesInUse& files, const DemArguments& dem) const {
    OpenResults results;
    for (const std::string& path : paths) {
        const ResultArguments result{.path = path, .overwrite = overwrite, .endings = endings};
        results.push_back({result.ending(), open_result(result, files, dem)});
    }
    return results;
}

bool OutputArguments::has(std::string_view ending) const {
    return std::ranges::any_of(paths, [&](const std::string& path) {
        return ResultArguments{.path = path, .overwrite = {}, .endings = {}}.ending() == ending;
    });
}

void OutputArguments::deliver(const Forms& forms, const OpenResults& results) const {
    std::vector<OutputFile*> files;
    for (const auto& [form, file] : results) {
        files.push_back(file);
        if (form == "png") {
            const chart::Drawing drawing = forms.drawing();
            image::write(*file, chart::to_image(drawing, scale),
                         {{"Software", "Relevo " RELEVO_VERSION},
                          {"Title", drawing.title()},
                          {"Description", drawing.description()}});
        } else {
            file->write(form == "svg"    ? chart::to_svg(forms.drawing())
                        : form == "json" ? json_text(with_schema(schema, forms.json()))
                                         : forms.csv());
        }
    }
    OutputFile::finish_all(files);
    if (json)
        fmt::print("{}", json_text(with_schema(schema, forms.json())));
    else if (csv)
        fmt::print("{}", forms.csv());
    else if (results.empty())
        forms.print();
}

std::string clock_text(sun::Instant utc, const sun::Zone& zone) {
    const sun::CivilTime wall = zone.local(utc + 0.5).wall;
    return fmt::format("{:02}:{:02}:{:02}", wall.hour, wall.minute, wall.second);
}

std::string csv_remarks(const std::vector<std::string>& remarks) {
    std::string text;
    for (const std::string& remark : remarks)
        text += "# " + remark + "\n";
    return text;
}

}  // namespace relevo::cli
