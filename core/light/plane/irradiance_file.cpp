#include "light/plane/irradiance_file.h"

#include <initializer_list>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "light/plane/irradiance_rows.h"

namespace relevo::light {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;

/// A column that a table must have, by its names.
std::size_t need(const dem::CsvHeader& header, std::initializer_list<std::string_view> names,
                 const IrradianceFile& file) {
    const auto found = header.find(names);
    if (!found)
        file.errors.refuse(
            fmt::format("no column {}, expected a line that names it", *names.begin()));
    return *found;
}

void set_pvgis(double offset_h, IrradianceFile& file) {
    if (!(offset_h >= 0 && offset_h < 1))
        file.errors.refuse(fmt::format("irradiance time offset {}, expected 0 to 1 h", offset_h));
    file.time = {RowTime::Kind::Instant, offset_h};
    file.format = "PVGIS";
}

/// EnergyPlus, "Auxiliary Programs", EnergyPlus Weather File (EPW) Data Dictionary.
void read_epw(TextLines lines, IrradianceFile& file) {
    file.format = "EPW";
    file.step_s = kHour_s;
    bool in_data = false;
    std::optional<double> minute_of_all;
    while (const auto line = lines.next()) {
        if (trimmed(*line).empty()) continue;
        const std::vector<std::string> f = dem::csv_fields(*line, ',');
        const std::size_t n = lines.number();
        if (in_data) {
            auto wall = file.numbers<5>(f, {0, 1, 2, 3, 4}, n);
            const double minute = wall[4];
            if (minute != 0 && minute != 60)
                file.refuse(n, fmt::format("minute {}, expected 0 or 60 in all rows", minute));
            if (minute != minute_of_all.value_or(minute))
                file.refuse(n,
                            "minutes 0 and 60 in one file: which hours its rows are is not known");
            minute_of_all = minute;
            wall[3] -= 1;  // the row ends at its hour, whatever its minute
            wall[4] = 0;
            file.add(file.instant(wall, n), file.numbers<3>(f, {13, 14, 15}, n), n);
        } else if (f[0] == "LOCATION") {
            const auto [lat, lon, hours, height] = file.numbers<4>(f, {6, 7, 8, 9}, n);
            file.set_clock(hours);
            file.set_place(lat, lon, height);
        } else if (f[0] == "HOLIDAYS/DAYLIGHT SAVINGS") {
            file.leap_days = lower(dem::csv_field(f, 1)) == "yes";
        } else if (constexpr std::string_view kOffset = "Irradiance Time Offset (h):";
                   f[0].starts_with("COMMENTS") && dem::csv_field(f, 1).starts_with(kOffset)) {
            // PVGIS's: instants by UTC, whatever its LOCATION says, before the rows' ends.
            set_pvgis(1 + file.number(f[1].substr(kOffset.size()), n), file);
            file.set_clock(0);
        } else if (f[0] == "DATA PERIODS") {
            if (file.numbers<1>(f, {2}, n)[0] != 1)
                file.refuse(n, "several rows an hour, expected one");
            in_data = true;
        }
    }
}

/// "20180101:0000" in UTC.
sun::Instant pvgis_time(const std::string& text, const IrradianceFile& file, std::size_t line) {
    if (text.size() != 13 || text[8] != ':')
        file.refuse(line, fmt::format("time \"{}\", expected 20180101:0000", text));
    const auto part = [&](std::size_t at, std::size_t count) {
        return file.number(text.substr(at, count), line);
    };
    return file.instant({part(0, 4), part(4, 2), part(6, 2), part(9, 2), part(11, 2)}, line);
}

/// PVGIS 5.3, European Commission, JRC: "tmy" of its API.
void read_pvgis_csv(TextLines lines, IrradianceFile& file) {
    double offset_h = 0, lat_deg = 0, lon_deg = 0, height_m = 0;
    std::optional<dem::CsvHeader> header;
    std::size_t time = 0;
    std::array<std::size_t, 3> values{};
    while (const auto line = lines.next()) {
        const std::size_t n = lines.number();
        const std::size_t colon = line->find(':');
        if (line->starts_with("time")) {
            header.emplace(*line, file.errors);
            time = need(*header, {"time(UTC)"}, file);
            values = {need(*header, {"G(h)"}, file), need(*header, {"Gb(n)"}, file),
                      need(*header, {"Gd(h)"}, file)};
        } else if (header) {
            if (trimmed(*line).empty()) break;
            const std::vector<std::string> f = header->fields(*line, n);
            file.add(pvgis_time(dem::csv_field(f, time), file, n), file.numbers(f, values, n), n);
        } else if (colon != line->npos) {
            const double value = file.number(line->substr(colon + 1), n);
            (line->starts_with("Latitude")    ? lat_deg
             : line->starts_with("Longitude") ? lon_deg
             : line->starts_with("Elevation") ? height_m
                                              : offset_h) = value;
        }
    }
    file.set_place(lat_deg, lon_deg, height_m);
    set_pvgis(offset_h, file);
}

void read_pvgis_json(std::string_view text, IrradianceFile& file) {
    file.unit = "entry";
    try {
        const nlohmann::json all = nlohmann::json::parse(text);
        const nlohmann::json& at = all.at("inputs").at("location");
        file.set_place(at.at("latitude").get<double>(), at.at("longitude").get<double>(),
                       at.at("elevation").get<double>());
        set_pvgis(at.value("irradiance_time_offset", 0.0), file);
        for (const nlohmann::json& row : all.at("outputs").at("tmy_hourly")) {
            const std::size_t n = file.rows.size() + 1;
            file.add(pvgis_time(row.at("time(UTC)").get<std::string>(), file, n),
                     {row.at("G(h)").get<double>(), row.at("Gb(n)").get<double>(),
                      row.at("Gd(h)").get<double>()},
                     n);
        }
    } catch (const nlohmann::json::exception& error) {
        file.errors.refuse(fmt::format("not a typical year of PVGIS: {}", error.what()));
    }
}

/// NREL, "NSRDB data dictionary": two lines about the site, one of columns, then rows.
void read_nsrdb(TextLines lines, IrradianceFile& file) {
    file.time = {RowTime::Kind::Instant, 0};
    file.begins_with_step = true;
    file.format = "NSRDB";
    const dem::CsvHeader site(lines.next().value_or(""), file.errors);
    const auto [lat, lon, hours, height] =
        file.numbers<4>(site.fields(lines.next().value_or(""), 2),
                        {need(site, {"Latitude"}, file), need(site, {"Longitude"}, file),
                         need(site, {"Time Zone"}, file), need(site, {"Elevation"}, file)},
                        2);
    file.set_clock(hours);
    file.set_place(lat, lon, height);
    const dem::CsvHeader header(lines.next().value_or(""), file.errors);
    const std::array wall{need(header, {"Year"}, file), need(header, {"Month"}, file),
                          need(header, {"Day"}, file), need(header, {"Hour"}, file),
                          need(header, {"Minute"}, file)};
    const std::array values{need(header, {"GHI"}, file), need(header, {"DNI"}, file),
                            need(header, {"DHI"}, file)};
    while (const auto line = lines.next()) {
        if (trimmed(*line).empty()) continue;
        const std::size_t n = lines.number();
        const std::vector<std::string> f = header.fields(*line, n);
        file.add(file.instant(file.numbers(f, wall, n), n), file.numbers(f, values, n), n);
    }
}

/// Reads the times of a plain CSV, all by one clock.
class PlainTimes {
  public:
    PlainTimes(IrradianceFile& file, const std::optional<sun::Zone>& zone)
        : file_(file), zone_(zone) {}

    sun::Instant read(const std::string& text, std::size_t line) {
        sun::ParsedTime time;
        bool wall = false;
        try {
            wall = sun::is_wall_time(text);
            if (!wall || zone_)
                time = sun::parse_time(text, wall ? zone_ : std::optional<sun::Zone>());
        } catch (const Error& error) {
            file_.refuse(line, error.what());
        }
        if (wall && !zone_)
            file_.refuse(line, fmt::format("time {} without an offset; write {}+01:00, or pass "
                                           "--tz",
                                           text, text));
        if (time.kind != sun::WallTimeKind::Unique)
            file_.refuse(line, fmt::format("time {}: {}; write offsets", text, time.note));
        const int offset_s = wall ? 0 : time.zone.local(time.utc).utc_offset_s;
        if (!first_) {
            first_ = First{line, wall, offset_s};
            file_.clock = wall ? *zone_ : time.zone;
        }
        if (wall != first_->wall || offset_s != first_->offset_s)
            file_.refuse(line, fmt::format("time {} is of another zone than in line {}, expected "
                                           "one offset in all rows",
                                           text, first_->line));
        return time.utc;
    }

  private:
    struct First {
        std::size_t line;
        bool wall;
        int offset_s;
    };
    IrradianceFile& file_;
    const std::optional<sun::Zone>& zone_;
    std::optional<First> first_;
};

void read_plain(TextLines lines, const IrradianceOptions& options, IrradianceFile& file) {
    file.format = "CSV";
    std::optional<dem::CsvHeader> header;
    PlainTimes times(file, options.zone);
    std::size_t begin = 0;
    std::optional<std::size_t> end;
    std::array<std::size_t, 3> values{};
    while (const auto line = lines.next()) {
        if (trimmed(*line).empty() || line->starts_with('#')) continue;
        const std::size_t n = lines.number();
        if (!header) {
            header.emplace(*line, file.errors);
            end = header->find({"end"});
            begin = end ? need(*header, {"begin"}, file) : need(*header, {"time"}, file);
            values = {need(*header, {"ghi", "ghi_w_m2"}, file),
                      need(*header, {"dni", "dni_w_m2"}, file),
                      need(*header, {"dhi", "dhi_w_m2"}, file)};
            continue;
        }
        const std::vector<std::string> f = header->fields(*line, n);
        const sun::Instant stamp = times.read(dem::csv_field(f, begin), n);
        std::optional<sun::Instant> until;
        if (end) until = times.read(dem::csv_field(f, end), n);
        file.add(stamp, file.numbers(f, values, n), n, until);
    }
    if (!end && !options.interval)
        bad_usage("--interval: missing; a CSV with a column time needs end, begin or instant");
    if (end && options.interval)
        bad_usage(fmt::format("--interval: {} has the columns begin and end", file.errors.path));
    if (!end) file.time = *options.interval;
}

}  // namespace

std::optional<RowTime> RowTime::parse(std::string_view text) {
    if (text == "end") return RowTime{Kind::End, 0};
    if (text == "begin") return RowTime{Kind::Begin, 0};
    if (text == "instant") return RowTime{Kind::Instant, 0};
    if (!text.starts_with("instant+")) return std::nullopt;
    const std::optional<double> hours = parse_number(text.substr(8));
    if (!hours || *hours < 0 || *hours >= 1) return std::nullopt;
    return RowTime{Kind::Instant, *hours};
}

IrradianceTable read_irradiance(const std::string& path, std::string_view who,
                                const IrradianceOptions& options) {
    IrradianceFile file{.errors = {path, who}};
    const std::string text = dem::read_packed_text(file.errors, kMostBytes);
    const std::string_view first = std::string_view(text).substr(0, text.find('\n'));
    bool plain = false;
    if (trimmed(text).starts_with('{'))
        read_pvgis_json(text, file);
    else if (first.starts_with("LOCATION,"))
        read_epw(TextLines(text), file);
    else if (first.starts_with("Latitude (decimal degrees)"))
        read_pvgis_csv(TextLines(text), file);
    else if (first.find("Time Zone") != first.npos)
        read_nsrdb(TextLines(text), file);
    else
        plain = true;
    if (!plain && options.interval)
        bad_usage(fmt::format("--interval: for a plain CSV; {} knows its own", file.format));
    if (plain) read_plain(TextLines(text), options, file);
    return file.arranged();
}

}  // namespace relevo::light
