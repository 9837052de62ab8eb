#include "dem/geojson.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/line_counting_iterator.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/crs.h"

namespace relevo::dem {
namespace {

constexpr std::size_t kMostLevels = 64;

struct Position {
    double x = 0, y = 0;
    std::size_t line = 0;
};

/// An object of GeoJSON: a geometry, a feature or a collection of either.
struct Thing {
    std::string type, id;
    std::array<std::string, 3> names;  // by kNameKeys
    std::size_t line = 0;
    std::vector<Position> positions;
    int depth = 0;  // of lists around a position
    bool has_coordinates = false;
    std::vector<Thing> children;
    bool has_crs = false;
    std::size_t crs_line = 0;
    std::string crs;  // empty: cannot be read

    std::string name() const {
        for (const std::string& text : names)
            if (!text.empty()) return text;
        return id;
    }
};
constexpr std::array<std::string_view, 3> kNameKeys = {"name", "title", "id"};

/// Makes Things of the parser's events; members that GeoJSON does not have are skipped.
class Builder : public nlohmann::json_sax<nlohmann::json> {
  public:
    Builder(const FileErrors& errors, const std::size_t& line) : errors_(errors), line_(line) {}

    Thing take() { return std::move(root_); }

    bool null() override { return scalar(Kind::Null, {}, 0); }
    bool boolean(bool value) override { return scalar(Kind::Bool, value ? "true" : "false", 0); }
    bool number_integer(number_integer_t value) override {
        return scalar(Kind::Number, fmt::format("{}", value), static_cast<double>(value));
    }
    bool number_unsigned(number_unsigned_t value) override {
        return scalar(Kind::Number, fmt::format("{}", value), static_cast<double>(value));
    }
    bool number_float(number_float_t value, const string_t& text) override {
        return scalar(Kind::Number, text, value);
    }
    bool string(string_t& value) override { return scalar(Kind::String, value, 0); }
    bool binary(binary_t&) override { return false; }

    bool start_object(std::size_t) override {
        Level level = level_inside();
        if (level.role == Role::Position) refuse("an object in coordinates, expected numbers");
        if (level.role == Role::Things) level.role = Role::Thing;
        if (level.role == Role::Thing) {
            Thing thing;
            thing.line = line_;
            things_.push_back(std::move(thing));
        }
        return open(std::move(level));
    }
    bool end_object() override {
        if (levels_.back().role == Role::Thing && things_.size() > 1) {
            Thing thing = std::move(things_.back());
            things_.pop_back();
            things_.back().children.push_back(std::move(thing));
        } else if (levels_.back().role == Role::Thing) {
            root_ = std::move(things_.back());
            things_.pop_back();
        }
        levels_.pop_back();
        return true;
    }
    bool start_array(std::size_t) override {
        Level level = level_inside();
        if (!levels_.empty() && levels_.back().role == Role::Thing &&
            levels_.back().key == "coordinates")
            things_.back().has_coordinates = true;
        // A root, a geometry, properties or a CRS in a list are none.
        if (level.role == Role::Position) {
            level.line = line_;
        } else if (level.role != Role::Things) {
            level.role = Role::Skipped;
        }
        return open(std::move(level));
    }
    bool end_array() override {
        const Level level = std::move(levels_.back());
        levels_.pop_back();
        if (level.role == Role::Position && level.count > 0) add_position(level);
        return true;
    }
    bool key(string_t& value) override {
        levels_.back().key = value;
        if (levels_.back().role == Role::Thing && value == "crs") {
            things_.back().has_crs = true;
            things_.back().crs_line = line_;
        }
        return true;
    }
    bool parse_error(std::size_t, const std::string&,
                     const nlohmann::detail::exception& error) override {
        // "[json.exception.parse_error.101] parse error at line 3, column 5: what", or without a
        // place "[json.exception.out_of_range.406] what".
        std::string_view text = error.what();
        if (const std::size_t name = text.find("] "); name != text.npos)
            text.remove_prefix(name + 2);
        if (const std::size_t place = text.find("column "); place != text.npos)
            text.remove_prefix(std::min(text.size(), text.find(": ", place) + 2));
        refuse(fmt::format("no well-formed JSON, {}", text.substr(0, 160)));
    }

  private:
    enum class Kind { Null, Bool, Number, String };
    enum class Role {
        Thing,       // an object of GeoJSON
        Things,      // a list of them
        Properties,  // of a feature
        Crs,         // the member crs, and its properties
        Position,    // a list in coordinates, perhaps of lists
        Skipped,
    };
    struct Level {
        Role role = Role::Skipped;
        std::string key{};           // of an object: that is being read
        std::size_t line = 0;        // of a position
        std::size_t count = 0;       // of a position's numbers
        std::array<double, 4> at{};  // those numbers
    };

    [[noreturn]] void refuse(std::string_view what) const { errors_.refuse(line_, what); }

    /// What a list or an object that begins here is.
    Level level_inside() const {
        if (levels_.empty()) return {Role::Thing};
        const Level& outer = levels_.back();
        if (outer.role != Role::Thing) return {outer.role};  // also the properties of a CRS
        if (outer.key == "geometry") return {Role::Thing};
        if (outer.key == "features" || outer.key == "geometries") return {Role::Things};
        if (outer.key == "properties") return {Role::Properties};
        if (outer.key == "crs") return {Role::Crs};
        if (outer.key == "coordinates") return {Role::Position};
        return {};
    }

    bool open(Level level) {
        if (levels_.size() >= kMostLevels)
            refuse(fmt::format("nested deeper than {} levels", kMostLevels));
        // Lists and objects within a property are no names.
        if (!levels_.empty() && levels_.back().role == Role::Properties) level.role = Role::Skipped;
        levels_.push_back(std::move(level));
        return true;
    }

    bool scalar(Kind kind, const std::string& text, double number) {
        if (levels_.empty()) return true;
        Level& level = levels_.back();
        const bool is_text = kind == Kind::String || kind == Kind::Number;
        if (level.role == Role::Position) {
            if (kind != Kind::Number)
                refuse(fmt::format("a coordinate, expected a number but got {}",
                                   kind == Kind::String ? "\"" + text.substr(0, 40) + "\""
                                   : kind == Kind::Null ? "null"
                                                        : text));
            if (level.count < level.at.size()) level.at[level.count] = number;
            ++level.count;
        } else if (level.role == Role::Properties && is_text) {
            for (std::size_t i = 0; i < kNameKeys.size(); ++i)
                if (equal_ignoring_case(level.key, kNameKeys[i])) things_.back().names[i] = text;
        } else if (level.role == Role::Crs && is_text) {
            if (level.key == "name") things_.back().crs = text;
            if (level.key == "code") things_.back().crs = "EPSG:" + text;
        } else if (level.role == Role::Thing) {
            if (level.key == "type" && kind == Kind::String) things_.back().type = text;
            if (level.key == "id" && is_text) things_.back().id = text;
            if (level.key == "crs" && kind == Kind::String) things_.back().crs = text;
            if (level.key == "geometry" && kind != Kind::Null)
                refuse("a geometry that is not an object");
            if (level.key == "coordinates") refuse("coordinates that are no list of numbers");
        } else if (level.role == Role::Things) {
            refuse("a list of features or geometries, expected objects in it");
        }
        return true;
    }

    void add_position(const Level& level) {
        const auto whole = [](double number) { return number == std::floor(number); };
        const bool commas = level.count == 4 && std::ranges::all_of(level.at, whole);
        if (level.count < 2 || level.count > 4 || commas)
            errors_.refuse(level.line,
                           fmt::format("a position of {} number{}, expected longitude, latitude "
                                       "and perhaps height, with decimal points",
                                       level.count, level.count == 1 ? "" : "s"));
        Thing& thing = things_.back();
        int depth = 0;
        for (auto at = levels_.rbegin(); at != levels_.rend() && at->role == Role::Position; ++at)
            ++depth;
        if (!thing.positions.empty() && depth != thing.depth)
            errors_.refuse(level.line, "coordinates nested unevenly");
        thing.depth = depth;
        thing.positions.push_back({level.at[0], level.at[1], level.line});
    }

    const FileErrors& errors_;
    const std::size_t& line_;
    std::vector<Level> levels_;
    std::vector<Thing> things_;
    Thing root_;
};

/// From coordinates of a file to degrees.
class ToDegrees {
  public:
    ToDegrees() = default;
    ToDegrees(const FileErrors& errors, const Thing& thing) {
        const std::string& name = thing.crs;
        if (name.empty())
            errors.refuse(thing.crs_line,
                          "\"crs\" names no coordinate system; remove it if the coordinates are "
                          "longitude and latitude on WGS 84, or write its EPSG code");
        // What coordinates are without it: longitude and latitude, which lose no bit in PROJ.
        for (const std::string_view end : {":CRS84", ":CRS84h", ":4326", ":4979"})
            if (name.ends_with(end)) return;
        crs_ = geo::Crs::parse(
            name, fmt::format("{}: {}: line {}: \"crs\"", errors.who, errors.path, thing.crs_line));
    }

    VectorPoint point(const FileErrors& errors, const Position& at) const {
        VectorPoint point{at.y, at.x, {}, {}, at.line};
        if (!crs_) return point;
        const geo::Geodetic place = crs_->to_geodetic(at.x, at.y);
        if (!std::isfinite(place.lat_rad) || !std::isfinite(place.lon_rad))
            errors.refuse(at.line, fmt::format("{:.10g},{:.10g}: no place on Earth in {}", at.x,
                                               at.y, crs_->name()));
        point.lat_deg = degrees(place.lat_rad);
        point.lon_deg = degrees(place.lon_rad);
        return point;
    }

  private:
    std::optional<geo::Crs> crs_;
};

/// Sorts the geometries of a tree of Things into points and lines.
class Sorter {
  public:
    Sorter(const FileErrors& errors, GeoJson& result) : errors_(errors), result_(result) {}

    void visit(const Thing& thing, const ToDegrees& outer) {
        const ToDegrees own = thing.has_crs ? ToDegrees(errors_, thing) : ToDegrees();
        const ToDegrees& to_degrees = thing.has_crs ? own : outer;
        if (thing.type == "FeatureCollection" || thing.type == "GeometryCollection")
            return visit_all(thing, to_degrees);
        if (thing.type == "Feature") {
            name_ = thing.name();
            line_open_ = false;
            visit_all(thing, to_degrees);
            name_.clear();
            line_open_ = false;
        } else if (thing.type == "Point" || thing.type == "MultiPoint") {
            check(thing, thing.type == "Point" ? 0 : 1);
            for (const Position& at : thing.positions) {
                result_.points.push_back(to_degrees.point(errors_, at));
                result_.points.back().name = name_;
            }
        } else if (thing.type == "LineString" || thing.type == "MultiLineString") {
            check(thing, thing.type == "LineString" ? 1 : 2);
            add_line(thing, to_degrees);
        } else if (thing.type != "Polygon" && thing.type != "MultiPolygon") {
            errors_.refuse(thing.line, thing.type.empty()
                                           ? "an object without \"type\", expected GeoJSON"
                                           : fmt::format("\"type\": \"{}\", expected GeoJSON",
                                                         thing.type.substr(0, 40)));
        }
    }

  private:
    void visit_all(const Thing& thing, const ToDegrees& to_degrees) {
        for (const Thing& child : thing.children)
            visit(child, to_degrees);
    }

    void check(const Thing& thing, int depth) const {
        if (!thing.has_coordinates)
            errors_.refuse(thing.line, fmt::format("a {} without coordinates", thing.type));
        if (!thing.positions.empty() && thing.depth != depth)
            errors_.refuse(thing.positions.front().line,
                           fmt::format("coordinates that are none of a {}", thing.type));
    }

    /// All lines of a feature are one, gaps bridged.
    void add_line(const Thing& thing, const ToDegrees& to_degrees) {
        if (!line_open_) result_.lines.push_back({name_, {}});
        line_open_ = true;
        for (const Position& at : thing.positions)
            result_.lines.back().points.push_back(to_degrees.point(errors_, at));
    }

    const FileErrors& errors_;
    GeoJson& result_;
    std::string name_;
    bool line_open_ = false;  // the last line is of this feature
};

std::string text_of(const FileErrors& errors) {
    const InputFile file(AllowedName(errors.path), errors.who);
    std::string text(file.size(), '\0');
    std::size_t length = 0;
    while (length < text.size()) {
        const ssize_t count = read(file.descriptor(), text.data() + length, text.size() - length);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) errors.refuse(fmt::format("cannot be read, {}", std::strerror(errno)));
        if (count == 0) break;
        length += static_cast<std::size_t>(count);
    }
    text.resize(length);
    return text;
}

}  // namespace

GeoJson read_geojson(const FileErrors& errors) {
    const std::string text = text_of(errors);
    std::size_t line = 1;
    Builder builder(errors, line);
    nlohmann::json::sax_parse(LineCountingIterator(text.data(), &line),
                              LineCountingIterator(text.data() + text.size(), &line), &builder);
    GeoJson result;
    Sorter(errors, result).visit(builder.take(), {});
    return result;
}

}  // namespace relevo::dem
