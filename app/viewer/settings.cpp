#include "viewer/settings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/format.h"
#include "scene/options.h"
#include "sun/zone.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostRecent = 12;
constexpr std::array<const char*, 3> kCoordinates = {"utm", "mgrs", "degrees"};

/// Empty if the user has no home.
fs::path folder_of(const char* variable, const char* below_home) {
    const fs::path folder = user_folder(variable, below_home);
    return folder.empty() ? folder : folder / "relevo";
}

/// Content of a file; null without one, or if it is not JSON.
json read(const fs::path& file) {
    std::error_code ignored;
    if (file.empty() || !fs::exists(file, ignored)) return {};
    try {
        return json::parse(read_text(file, "view"));
    } catch (const Error& error) {
        log::warning(fmt::format("{}; treated as empty", error.what()));
        return {};
    } catch (const json::exception&) {
        log::warning(fmt::format("view: {}: not JSON; treated as empty", printable(file.string())));
        return {};
    }
}

void write_whole(const fs::path& file, const ordered_json& content) {
    if (file.empty()) return;
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);
    if (failure)
        failed(fmt::format("view: {}: cannot be created, {}; settings are not saved",
                           printable(file.parent_path().string()), failure.message()));
    // Writing to a pipe would block the window.
    if (fs::exists(file, failure) && !fs::is_regular_file(file, failure))
        failed(fmt::format("view: {}: is not a regular file, so that nothing is saved; remove it",
                           printable(file.string())));
    // File names may contain any bytes.
    write_text(file, content.dump(2, ' ', false, json::error_handler_t::replace) + "\n",
               /*overwrite=*/true, "view");
}

/// Reads a member of the right type; otherwise keeps `value`.
template <typename T>
void take(const json& from, const char* name, T& value) {
    const auto member = from.is_object() ? from.find(name) : from.end();
    if (!from.is_object() || member == from.end()) return;
    const bool fits = std::is_same_v<T, bool>          ? member->is_boolean()
                      : std::is_same_v<T, std::string> ? member->is_string()
                                                       : member->is_number();
    if (fits) value = member->get<T>();
}

/// What is remembered of exports: name in the file, value, range of whole numbers.
template <typename Each>
void each_of(ExportChoice& choice, FilmFile& film, const Each& each) {
    each("kind", choice.kind, 0, static_cast<int>(kExportKinds.size()) - 1);
    each("width_px", choice.size_px.x, 1, scene::kMaxSide_px);
    each("height_px", choice.size_px.y, 1, scene::kMaxSide_px);
    each("format", choice.format, 0, static_cast<int>(kExportFormats.size()) - 1);
    each("samples", choice.samples, 1, kExportSamples.back());
    each("quality", choice.quality, 1, 100);
    each("transparent", choice.is_transparent);
    each("centred", choice.is_centred);
    each("error_m", choice.error_m);
    each("paper", choice.paper, 0, static_cast<int>(kExportPapers.size()) - 1);
    each("map_scale", choice.map_scale);
    each("folder", choice.folder);
    each("name", choice.name);
    each("film_width_px", film.size_px.x, kLeastFilm_px, kMostFilm_px);
    each("film_height_px", film.size_px.y, kLeastFilm_px, kMostFilm_px);
    each("film_format", film.ending);
    each("film_quality", film.quality, 0, 100);
    each("film_samples", film.samples, 1, kExportSamples.back());
    each("film_date", film.has_date);
    each("film_name", film.name);
}

struct Reader {
    const json& from;

    template <typename T>
    void operator()(const char* name, T& value) const {
        take(from, name, value);
    }
    void operator()(const char* name, int& value, int least, int most) const {
        double number = value;
        take(from, name, number);
        value = static_cast<int>(std::clamp<double>(number, least, most));
    }
};

void read_exports(const json& from, Settings& settings) {
    const bool has_any = from.is_object() && from.contains("export");
    each_of(settings.exporting, settings.film, Reader{has_any ? from["export"] : json()});
    double& error_m = settings.exporting.error_m;
    error_m = std::clamp(error_m, kLeastError_m, kMostError_m);
    settings.exporting.set_map_scale(settings.exporting.map_scale);
    if (!contains(kFilmEndings, settings.film.ending)) settings.film.ending = FilmFile().ending;
    if (!contains(kExportSamples, settings.exporting.samples))
        settings.exporting.samples = ExportChoice().samples;
    if (!contains(kExportSamples, settings.film.samples))
        settings.film.samples = FilmFile().samples;
}

ordered_json exports_of(Settings settings) {
    ordered_json all;
    each_of(settings.exporting, settings.film,
            [&](const char* name, const auto& value, auto...) { all[name] = value; });
    return all;
}

std::vector<std::string> strings(const json& from) {
    std::vector<std::string> result;
    if (!from.is_array()) return result;
    for (const json& one : from)
        if (one.is_string()) result.push_back(one.get<std::string>());
    return result;
}

/// A saved view; nullopt if its values are invalid.
std::optional<SavedView> view_of(const json& from) {
    SavedView view;
    std::string time;
    double lat_deg = 100, lon_deg = 0, fov_deg = 0;
    const scene::Option& fov = scene::option("--fov");
    take(from, "name", view.name);
    take(from, "lat_deg", lat_deg);
    take(from, "lon_deg", lon_deg);
    take(from, "height_m", view.eye.height_m);
    take(from, "heading_deg", view.heading_deg);
    take(from, "pitch_deg", view.pitch_deg);
    take(from, "fov_deg", fov_deg);
    take(from, "time", time);
    if (std::abs(lat_deg) > 90 || std::abs(lon_deg) > 360 || std::abs(view.pitch_deg) > 90 ||
        fov_deg < fov.min || fov_deg > fov.max || std::abs(view.eye.height_m) > 1e9)
        return std::nullopt;
    view.eye.lat_rad = radians(lat_deg);
    view.eye.lon_rad = radians(lon_deg);
    view.fov_y_rad = radians(fov_deg);
    try {
        view.utc = sun::parse_time(time).utc;
    } catch (const Error&) {
        return std::nullopt;
    }
    return view;
}

/// As the "dem" of a scene; only the list of files if options are defaults.
ordered_json json_of(const RecentDem& dem) {
    scene::Scene scene;
    scene.dems = dem.files;
    scene.dem = dem.options;
    scene.holes = dem.holes;
    ordered_json as_read = ordered_json::parse(scene::scene_text(scene, ""))["dem"];
    return as_read.size() > 1 ? as_read : ordered_json(dem.files);
}

/// nullopt if `from` is not the "dem" of a scene.
std::optional<RecentDem> recent_of(const json& from) {
    try {
        const json scene{{"format", 1}, {"dem", from.is_array() ? json{{"files", from}} : from}};
        const scene::Scene read = scene::read_scene_text(scene.dump(), "recent.json", "");
        if (read.dems.empty()) return std::nullopt;
        return RecentDem{read.dems, read.dem, read.holes};
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

ordered_json json_of(const SavedView& view) {
    return {{"name", view.name},
            {"lat_deg", degrees(view.eye.lat_rad)},
            {"lon_deg", degrees(view.eye.lon_rad)},
            {"height_m", view.eye.height_m},
            {"heading_deg", view.heading_deg},
            {"pitch_deg", view.pitch_deg},
            {"fov_deg", degrees(view.fov_y_rad)},
            {"time", sun::to_iso(view.utc, 3)}};
}

/// FNV-1a, for a short file name.
std::uint64_t hash_of(const std::vector<std::string>& words) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const std::string& word : words)
        for (const char c : word + '\n')
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
}

}  // namespace

std::string coordinates_text(const geo::Geodetic& place, Coordinates coordinates) {
    switch (coordinates) {
        case Coordinates::Mgrs:
            return geo::mgrs_text(place);
        case Coordinates::Degrees:
            return geo::degrees_text(place);
        default:
            return geo::utm_text(place);
    }
}

Memory Memory::of_user() {
    return {folder_of("XDG_CONFIG_HOME", ".config"), folder_of("XDG_STATE_HOME", ".local/state")};
}

Memory::Memory(fs::path config, fs::path state)
    : config_(std::move(config)), state_(std::move(state)) {}

Settings Memory::settings() const {
    constexpr double kMostExtent = 10000;  // of a panel
    Settings settings;
    const json from = config_.empty() ? json() : read(config_ / "settings.json");
    std::string style, coordinates;
    double text_px = settings.text_px;
    double panel_width = settings.panel_width, charts_height = settings.charts_height;
    take(from, "style", style);
    take(from, "text_px", text_px);
    take(from, "coordinates", coordinates);
    take(from, "panels", settings.panels);
    take(from, "charts", settings.charts);
    take(from, "panel_width", panel_width);
    take(from, "charts_height", charts_height);
    read_exports(from, settings);
    settings.light_style = style == "light";
    settings.text_px = static_cast<int>(std::clamp<double>(text_px, kLeastText_px, kMostText_px));
    settings.panel_width = static_cast<int>(std::clamp(panel_width, 0.0, kMostExtent));
    settings.charts_height = static_cast<int>(std::clamp(charts_height, 0.0, kMostExtent));
    for (std::size_t i = 0; i < kCoordinates.size(); ++i)
        if (coordinates == kCoordinates[i]) settings.coordinates = static_cast<Coordinates>(i);
    return settings;
}

void Memory::write(const Settings& settings) const {
    if (config_.empty()) return;
    write_whole(config_ / "settings.json",
                {{"style", settings.light_style ? "light" : "dark"},
                 {"text_px", settings.text_px},
                 {"coordinates", kCoordinates[static_cast<std::size_t>(settings.coordinates)]},
                 {"panels", settings.panels},
                 {"charts", settings.charts},
                 {"panel_width", settings.panel_width},
                 {"charts_height", settings.charts_height},
                 {"export", exports_of(settings)}});
}

std::vector<RecentDem> Memory::recent() const {
    std::vector<RecentDem> result;
    const json from = state_.empty() ? json() : read(state_ / "recent.json");
    if (!from.is_array()) return result;
    for (const json& one : from)
        if (auto dem = recent_of(one); dem && result.size() < kMostRecent)
            result.push_back(std::move(*dem));
    return result;
}

void Memory::add_recent(const RecentDem& dem) const {
    if (state_.empty()) return;
    std::vector<RecentDem> all = recent();
    std::erase_if(all, [&](const RecentDem& one) { return one.files == dem.files; });
    all.insert(all.begin(), dem);
    if (all.size() > kMostRecent) all.resize(kMostRecent);
    ordered_json list = ordered_json::array();
    for (const RecentDem& one : all)
        list.push_back(json_of(one));
    write_whole(state_ / "recent.json", list);
}

fs::path Memory::views_file(const std::vector<std::string>& dems) const {
    if (config_.empty()) return {};
    return config_ / "views" / fmt::format("{:016x}.json", hash_of(dems));
}

std::vector<SavedView> Memory::views(const std::vector<std::string>& dems) const {
    std::vector<SavedView> result;
    const json from = read(views_file(dems));
    if (!from.is_object() || !from.contains("views") || !from["views"].is_array() ||
        !from.contains("dems") || strings(from["dems"]) != dems)
        return result;
    for (const json& one : from["views"])
        if (auto view = view_of(one)) result.push_back(std::move(*view));
    return result;
}

void Memory::write_views(const std::vector<std::string>& dems,
                         const std::vector<SavedView>& views) const {
    ordered_json list = ordered_json::array();
    for (const SavedView& view : views)
        list.push_back(json_of(view));
    write_whole(views_file(dems), {{"dems", dems}, {"views", list}});
}

std::vector<std::string> absolute_names(std::vector<std::string> dems) {
    for (std::string& dem : dems) {
        std::error_code error;
        if (!fs::exists(dem, error)) continue;
        // The working folder may have been deleted.
        const fs::path whole = fs::absolute(dem, error);
        if (!error) dem = whole.lexically_normal().string();
    }
    return dems;
}

std::string short_name(const std::vector<std::string>& dems) {
    std::string name = printable(std::filesystem::path(dems.front()).filename().string());
    if (name.empty()) name = printable(dems.front());
    if (dems.size() > 1)
        name = tr_format_plural("{1} and {0} more", "{1} and {0} more", dems.size() - 1, name);
    return name;
}

std::vector<std::string> dems_in(const fs::path& folder) {
    static constexpr std::array<std::string_view, 13> kEndings = {
        ".tif", ".tiff", ".asc", ".hgt", ".dem", ".dt0", ".dt1",
        ".dt2", ".img",  ".nc",  ".vrt", ".bil", ".flt"};
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_iterator it(folder, ignored), end; it != end; it.increment(ignored)) {
        if (ignored) break;
        const std::string ending = lower(it->path().extension().string());
        const bool is_dem = contains(kEndings, ending) && it->is_regular_file(ignored);
        if (is_dem) names.push_back(it->path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

std::string neighbour_in_folder(const std::string& dem, int by) {
    const fs::path here = fs::path(absolute_names({dem}).front());
    std::vector<std::string> names = dems_in(here.parent_path());
    const auto place = std::lower_bound(names.begin(), names.end(), here.filename().string());
    if (place == names.end() || *place != here.filename().string())
        names.insert(place, here.filename().string());
    if (names.size() < 2) return {};
    const auto at = std::ranges::find(names, here.filename().string());
    const auto count = static_cast<std::ptrdiff_t>(names.size());
    const std::ptrdiff_t next = (at - names.begin() + by + count) % count;
    return (here.parent_path() / names[static_cast<std::size_t>(next)]).string();
}

}  // namespace relevo::viewer
