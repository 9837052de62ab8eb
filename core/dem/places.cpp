#include "dem/places.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "dem/csv.h"
#include "dem/geojson.h"
#include "dem/gpx.h"
#include "dem/vector_point.h"
#include "geo/crs.h"

namespace relevo::dem {
namespace {

/// A GeoJSON is held in memory some ten times over.
constexpr std::uint64_t kMostJsonBytes = std::uint64_t{64} << 20;

/// A text file line by line, of any length, in bounded memory.
class Lines {
  public:
    explicit Lines(const FileErrors& errors)
        : errors_(errors), file_(AllowedName(errors.path), errors.who) {}

    /// The next line, without its end; nothing after the last. Valid until the next call.
    std::optional<std::string_view> next() {
        for (;;) {
            const std::size_t end = text_.find('\n', at_);
            if (end != text_.npos || (ended_ && at_ < text_.size())) {
                const std::size_t length = std::min(end, text_.size()) - at_;
                std::string_view line = std::string_view(text_).substr(at_, length);
                at_ += length + 1;
                if (number_++ == 0 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
                if (line.ends_with('\r')) line.remove_suffix(1);
                return line;
            }
            if (ended_) return std::nullopt;
            more();
        }
    }
    std::size_t number() const { return number_; }  ///< of the last line, from 1

  private:
    static constexpr std::size_t kBlockBytes = 1 << 16;

    void more() {
        text_.erase(0, at_);
        at_ = 0;
        if (text_.size() > kBlockBytes)
            errors_.refuse(
                fmt::format("line {} has more than {} bytes, expected a CSV, a GPX or a "
                            "GeoJSON file",
                            number_ + 1, kBlockBytes));
        const std::size_t before = text_.size();
        text_.resize(before + kBlockBytes);
        const ssize_t count = read(file_.descriptor(), text_.data() + before, kBlockBytes);
        if (count < 0) errors_.refuse(fmt::format("cannot be read, {}", std::strerror(errno)));
        text_.resize(before + static_cast<std::size_t>(count));
        ended_ = count == 0;
    }

    FileErrors errors_;
    InputFile file_;
    std::string text_;
    std::size_t at_ = 0, number_ = 0;
    bool ended_ = false;
};

/// Whether a file begins as XML or JSON do, and with which of them: '<', '{', or another byte.
char beginning_of(const FileErrors& errors) {
    const InputFile file(AllowedName(errors.path), errors.who);
    std::array<char, 512> head{};
    const ssize_t count = read(file.descriptor(), head.data(), head.size());
    std::string_view text(head.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    text = trimmed(text);
    if (text.empty()) errors.refuse("an empty file, expected a CSV, a GPX or a GeoJSON file");
    if (text.find('\0') != text.npos)
        errors.refuse("not a text, expected a CSV, a GPX or a GeoJSON file");
    if (text.front() == '{' && file.size() > kMostJsonBytes)
        errors.refuse(fmt::format("a GeoJSON file of more than {} MiB; make a CSV of it",
                                  kMostJsonBytes >> 20));
    return text.front();
}

/// The columns of a CSV of places, by their names.
class Columns {
  public:
    Columns(std::string_view header, const std::string& crs, const FileErrors& errors)
        : errors_(errors), header_(header, errors) {
        lat_ = header_.find({"lat", "latitude", "lat_deg"});
        lon_ = header_.find({"lon", "longitude", "lng", "long", "lon_deg"});
        name_ = header_.find({"name", "id", "title"});
        height_ = header_.find({"height", "height_m"});
        time_ = header_.find({"time"});
        rank_ = header_.find({"rank"});
        tilt_ = header_.find({"tilt", "tilt_deg"});
        azimuth_ = header_.find({"azimuth", "azimuth_deg"});
        if (lat_ && lon_) return;
        lon_ = header_.find({"x", "easting"});
        lat_ = header_.find({"y", "northing"});
        if (!lat_ || !lon_)
            errors_.refuse("no columns lat and lon, expected a first line that names them");
        if (crs.empty())
            errors_.refuse(
                "columns x and y without a coordinate reference system; pass --points-crs EPSG:n, "
                "or columns lat and lon in degrees");
        crs_ = geo::Crs::parse(crs, "--points-crs");
    }

    NamedPlace read(std::string_view line, std::size_t number) const {
        const std::vector<std::string> fields = header_.fields(line, number);
        const auto field = [&](const std::optional<std::size_t>& column) {
            return csv_field(fields, column);
        };
        const std::string who = fmt::format("{}: {}: line {}", errors_.who, errors_.path, number);
        const std::string height = field(height_);
        NamedPlace place{field(name_), {},           field(time_),   number,
                         field(rank_), field(tilt_), field(azimuth_)};
        for (const auto& column : {lat_, lon_})
            if (field(column).find(',') != std::string::npos)
                errors_.refuse(number,
                               fmt::format("\"{}\": write a decimal point, as in {}", field(column),
                                           column == lat_ ? "46.91" : "8.05"));
        std::string text = field(lat_) + "," + field(lon_);
        if (crs_) text = "0,0";
        if (!height.empty()) text += "," + height;
        try {
            place.at = geo::parse_place(text, who);
        } catch (const Error& error) {
            bad_input(error.what());  // of a file, not of the command line
        }
        if (crs_) set_projected(field(lon_), field(lat_), who, place.at.place);
        return place;
    }

  private:
    void set_projected(const std::string& x_text, const std::string& y_text, const std::string& who,
                       geo::Geodetic& place) const {
        const std::optional<double> x = parse_number(x_text), y = parse_number(y_text);
        if (!x || !y)
            bad_input(fmt::format("{}: x and y, expected numbers but got \"{}\" and \"{}\"", who,
                                  x_text, y_text));
        const geo::Geodetic found = crs_->to_geodetic(*x, *y);
        if (!std::isfinite(found.lat_rad) || !std::isfinite(found.lon_rad))
            bad_input(fmt::format("{}: {:.10g},{:.10g}: no place on Earth in {}", who, *x, *y,
                                  crs_->name()));
        place.lat_rad = found.lat_rad;
        place.lon_rad = found.lon_rad;
    }

    FileErrors errors_;
    CsvHeader header_;
    std::optional<std::size_t> lat_, lon_, name_, height_, time_, rank_, tilt_, azimuth_;
    std::optional<geo::Crs> crs_;
};

[[noreturn]] void refuse_many(const FileErrors& errors) {
    errors.refuse(fmt::format("more than {} places; split the file", kMostPlaces));
}

std::vector<NamedPlace> read_csv(const FileErrors& errors, const std::string& crs) {
    Lines lines(errors);
    std::optional<Columns> columns;
    std::vector<NamedPlace> places;
    while (const std::optional<std::string_view> line = lines.next()) {
        if (trimmed(*line).empty() || line->starts_with('#')) continue;
        if (!columns) {
            columns.emplace(*line, crs, errors);
        } else {
            if (places.size() >= kMostPlaces) refuse_many(errors);
            places.push_back(columns->read(*line, lines.number()));
        }
    }
    return places;
}

NamedPlace place_of(const FileErrors& errors, VectorPoint&& point) {
    const double lat_deg = point.lat_deg, lon_deg = point.lon_deg;
    const auto is_lat = [](double deg) { return std::abs(deg) <= 90; };
    const auto is_lon = [](double deg) { return deg >= -180 && deg <= 360; };
    if (!is_lat(lat_deg) || !is_lon(lon_deg)) {
        const bool swapped = is_lat(lon_deg) && is_lon(lat_deg);
        errors.refuse(
            point.line,
            fmt::format("latitude {:.10g}, longitude {:.10g}: no place on Earth, expected -90 to "
                        "90 and -180 to 360 degrees{}",
                        lat_deg, lon_deg, swapped ? "; perhaps the two are swapped" : ""));
    }
    return {std::move(point.name),
            {.place = geo::geodetic_deg(lat_deg, lon_deg)},
            std::move(point.time),
            point.line};
}

/// The lines of a GPX: its tracks, or its routes where it has no tracks.
/// @param wanted  which one's points are kept, from 1
/// @param places  get them
/// @returns the names of all
std::vector<std::string> gpx_lines(const FileErrors& errors, int wanted,
                                   std::vector<NamedPlace>& places) {
    std::vector<std::string> names;
    for (const GpxKind kind : {GpxKind::Tracks, GpxKind::Routes}) {
        std::size_t count = 0;
        names = read_gpx(errors, kind, [&](int index, VectorPoint&& point) {
            if (++count > kMostPlaces) refuse_many(errors);
            if (index == wanted) places.push_back(place_of(errors, std::move(point)));
        });
        if (!names.empty()) break;
    }
    return names;
}

/// The same of a GeoJSON.
std::vector<std::string> geojson_lines(const FileErrors& errors, int wanted,
                                       std::vector<NamedPlace>& places) {
    std::vector<std::string> names;
    std::size_t count = 0;
    for (VectorLine& line : read_geojson(errors).lines) {
        names.push_back(std::move(line.name));
        count += line.points.size();
        if (count > kMostPlaces) refuse_many(errors);
        if (static_cast<int>(names.size()) != wanted) continue;
        for (VectorPoint& point : line.points)
            places.push_back(place_of(errors, std::move(point)));
    }
    return names;
}

/// @throws Error (BadInput) where a CRS is given for a file that has its own
void refuse_crs(const FileErrors& errors, const std::string& crs) {
    if (!crs.empty())
        errors.refuse(
            "--points-crs is for columns x and y of a CSV; GPX and GeoJSON have their own");
}

}  // namespace

std::vector<NamedTime> read_times(const std::string& path, std::string_view who, std::size_t most) {
    const FileErrors errors{path, who};
    Lines lines(errors);
    std::optional<CsvHeader> header;
    std::optional<std::size_t> time, name;
    std::vector<NamedTime> times;
    while (const std::optional<std::string_view> line = lines.next()) {
        if (line->find('\0') != line->npos) errors.refuse("not a text, expected a CSV file");
        if (trimmed(*line).empty() || line->starts_with('#')) continue;
        if (!header) {
            header.emplace(*line, errors);
            time = header->find({"time"});
            name = header->find({"name", "id", "title"});
            if (!time) errors.refuse("no column time, expected a first line that names it");
            continue;
        }
        const std::vector<std::string> fields = header->fields(*line, lines.number());
        times.push_back({csv_field(fields, name), csv_field(fields, time), lines.number()});
        if (times.back().time.empty()) errors.refuse(lines.number(), "no time in it");
        if (times.size() > most)
            errors.refuse(fmt::format("more than {} times; split the file", most));
    }
    if (times.empty())
        errors.refuse("no times, expected a first line \"time\" and a line for each below it");
    return times;
}

std::vector<NamedPlace> read_points(const std::string& path, std::string_view who,
                                    const std::string& crs) {
    const FileErrors errors{path, who};
    const char beginning = beginning_of(errors);
    std::vector<NamedPlace> places;
    if (beginning != '<' && beginning != '{') {
        places = read_csv(errors, crs);
        if (places.empty()) errors.refuse("no points, expected a line for each below the columns");
        return places;
    }
    refuse_crs(errors, crs);
    const auto add = [&](VectorPoint&& point) {
        if (places.size() >= kMostPlaces) refuse_many(errors);
        places.push_back(place_of(errors, std::move(point)));
    };
    if (beginning == '<') {
        for (const GpxKind kind : {GpxKind::Waypoints, GpxKind::Tracks, GpxKind::Routes})
            if (places.empty())
                read_gpx(errors, kind, [&](int, VectorPoint&& point) { add(std::move(point)); });
    } else
        for (VectorPoint& point : read_geojson(errors).points)
            add(std::move(point));
    if (places.empty())
        errors.refuse(beginning == '<' ? "no points, expected waypoints, a track or a route"
                                       : "no points, expected features with Point geometries");
    return places;
}

NamedLine read_line(const std::string& path, std::string_view who, const std::string& crs,
                    int number) {
    const FileErrors errors{path, who};
    const char beginning = beginning_of(errors);
    const int wanted = std::max(number, 1);
    NamedLine line;
    int lines = 1;
    if (beginning == '<' || beginning == '{') {
        refuse_crs(errors, crs);
        const std::vector<std::string> names = beginning == '<'
                                                   ? gpx_lines(errors, wanted, line.places)
                                                   : geojson_lines(errors, wanted, line.places);
        lines = static_cast<int>(names.size());
        if (wanted <= lines) line.name = names[static_cast<std::size_t>(wanted) - 1];
    } else {
        line.places = read_csv(errors, crs);
    }
    if (lines == 0)
        errors.refuse(beginning == '<' ? "no line in it, expected a track or a route"
                                       : "no line in it, expected a LineString");
    if (number == 0 && lines > 1)
        errors.refuse(fmt::format("{} lines in it; select one with --track 1 to {}", lines, lines));
    if (number > lines)
        errors.refuse(
            fmt::format("--track {}, expected 1 to {}: the file has that many", number, lines));
    if (line.places.size() < 2)
        errors.refuse(fmt::format("a line of {} point{}, expected two or more", line.places.size(),
                                  line.places.size() == 1 ? "" : "s"));
    return line;
}

}  // namespace relevo::dem
