#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "dem.h"
#include "dem/clip.h"
#include "dem/files_of.h"
#include "figure/horizons.h"
#include "figure/hours.h"
#include "figure/raster_run.h"
#include "figure/run.h"
#include "figure/shadow.h"
#include "options.h"
#include "session/words.h"

namespace relevo::c {
namespace {

std::string refraction_of(json::ObjectReader& reader) {
    return refraction_name(reader.string("refraction", "standard"), "options: ");
}

/// A raster of light that is asked for.
class FigureCall {
  public:
    /// @throws BadCall
    FigureCall(relevo_dem* dem, const relevo_progress* progress, const char** about)
        : dem_(dems().get(dem, "dem")),
          around_(dem_->around()),
          progress_(progress),
          about_(about) {
        if (about_) *about_ = nullptr;
    }
    virtual ~FigureCall() = default;
    FigureCall(const FigureCall&) = delete;
    FigureCall& operator=(const FigureCall&) = delete;

    /// Takes the options that all figures have.
    void take_common(json::ObjectReader& reader, figure::Figure& figure) {
        figure.terrestrial_refraction = number(reader, figure::kTerrestrialRefraction);
        if (reader.has("highest")) figure.highest_m = number(reader, figure::kHighest_m);
        const std::string clip = reader.string("clip", ""), crs = reader.string("clip_crs", "");
        if (!clip.empty()) clip_ = dem::parse_clip(clip, "options: clip");
        if (!crs.empty() && !clip_)
            reader.fail(reader.line_of("clip_crs"), "clip_crs", "needs clip");
        if (!crs.empty()) clip_->crs = geo::Crs::parse(crs, "options: clip_crs");
    }

    const dem::Posts& posts() {
        if (!around_) return dem_->posts();
        if (!nested_) nested_ = dem_->posts().in({around_, &around_->posts()});
        return *nested_;
    }
    /// The DEM, or the wider one around it.
    Dem& whole() { return around_ ? *around_ : *dem_; }
    light::TerrainAccess terrain() {
        return {.middle = [this] { return whole().grid().center(); },
                .posts = [this]() -> const dem::Posts& { return whole().posts(); }};
    }

    /// Does it, and says what came of it. @throws BadCall
    virtual void run(const figure::Figure& figure) = 0;

  protected:
    dem::Window window() const {
        return clip_ ? dem::window_of(dem_->grid(), *clip_, "options: clip")
                     : figure::whole_window(dem_->grid());
    }

    std::shared_ptr<Dem> dem_, around_;
    std::optional<dem::Posts> nested_;
    Progress progress_;
    const char** about_;
    std::optional<dem::Clip> clip_;
};

/// Values for the caller, made part by part.
class RasterCall : public FigureCall {
  public:
    /// @throws BadCall
    RasterCall(relevo_dem* dem, float* values, std::size_t count, const relevo_progress* progress,
               const char** about)
        : FigureCall(dem, progress, about), values_(&need(values, "values")), count_(count) {}

    void run(const figure::Figure& figure) override {
        const std::vector<output::RasterBand> bands = figure.bands();
        check_count("count", count_, band_size() * bands.size());
        const dem::Window window = this->window();
        if (clip_) std::fill_n(values_, count_, std::nanf(""));
        const dem::Posts& posts = this->posts();
        const std::optional<light::Beyond> beyond = figure.beyond(posts, window);
        if (beyond) log::warning(beyond->advice());
        const figure::PartMade made = figure::make_all(
            figure, posts, whole().grid().center(), window, dem_->named().dem.memory,
            [this](std::size_t band, const dem::Window& part, const Array2d<float>& values) {
                put(band, part, values);
            },
            [this](double share) { progress_.add(share); });
        if (!about_) return;
        nlohmann::ordered_json json{{"definition", made.definition}, {"holes", made.holes}};
        for (const output::RasterBand& band : bands)
            json["bands"].push_back({{"name", band.name}, {"unit", band.unit}});
        if (beyond) json["beyond"] = beyond->text(figure.would());
        for (const auto& [key, value] :
             figure::metadata_of(figure, posts, RELEVO_VERSION, made, window))
            json["metadata"][key] = value;
        *about_ = returned_text(json.dump());
    }

  private:
    std::size_t band_size() const {
        return static_cast<std::size_t>(dem_->grid().columns()) *
               static_cast<std::size_t>(dem_->grid().rows());
    }
    void put(std::size_t band, const dem::Window& part, const Array2d<float>& values) {
        float* const to = values_ + band * band_size();
        for (int row = 0; row < part.rows; ++row)
            std::ranges::copy(
                values.row(row),
                to + part.column + std::ptrdiff_t{part.row + row} * dem_->grid().columns());
    }

    float* values_;
    std::size_t count_;
};

/// A folder of tiles, or what the work takes.
class TilesCall : public FigureCall {
  public:
    TilesCall(relevo_dem* dem, const char* figure, const char* options, const char* files,
              const relevo_progress* progress, const char** about)
        : FigureCall(dem, progress, about) {
        Options given(files, "relevo_tiles");
        json::ObjectReader& reader = given.reader();
        options_.output = reader.string("folder", "");
        if (options_.output.empty()) {
            options_.purpose = figure::RasterRunOptions::Purpose::Estimate;
        } else {
            options_.overwrite = reader.boolean("overwrite", false);
            options_.tiles.tiles =
                fmt::format("{:.0f}", reader.number("tiles", 512, 1, 1 << 20, true));
            if (reader.has("halo")) options_.tiles.halo_km = number(reader, figure::kHalo_km);
            options_.tiles.resume = reader.boolean("resume", false);
        }
        reader.finish();
        options_.version = RELEVO_VERSION;
        options_.command = fmt::format("relevo_tiles {} {}", figure, options ? options : "");
        options_.meaning = "relevo " RELEVO_VERSION "\n" + options_.command + "\n";
        options_.done = [this](double share) { progress_.add(share); };
    }

    void run(const figure::Figure& figure) override {
        const scene::Scene& named = dem_->named();
        const bool is_make = options_.purpose == figure::RasterRunOptions::Purpose::Make;
        FilesInUse files;
        if (is_make) check_files(named.dems, files);
        const std::string stamp = is_make ? figure::stamp_of_dem(named.dems, named.dem) : "";
        const figure::RasterGround ground{
            dem::Posts::load(named.dems, named.dem), window(), named.dems, named.dem, false, stamp};
        figure::RasterRun run(options_, nullptr, files, ground, figure);
        run.make_all();
        nlohmann::ordered_json json;
        if (const figure::TileFolder* folder = run.folder()) {
            json = {{"made", run.todo().size()}, {"there", folder->there()}};
        } else {
            const figure::RasterEstimate found = run.estimate();
            json = {{"posts", found.posts},
                    {"parts", found.parts},
                    {"memory_mib", found.memory_mib},
                    {"computing_s", found.computing_s},
                    {"sampled_share", found.sampled_share},
                    {"threads", found.threads},
                    {"bands", found.bands},
                    {"result_bytes", found.result_bytes}};
        }
        if (about_) *about_ = returned_text(json.dump());
    }

  private:
    void check_files(const std::vector<std::string>& paths, FilesInUse& files) {
        if (dem_->is_of_memory())
            bad_input("folder: tiles are of a DEM of files; this one is in memory");
        dem::add_named(paths, files);
        dem::add_all(paths, files);
        std::vector<std::filesystem::path> results = output::plan_files(options_.output);
        results.emplace_back(options_.output);
        files.check_planned(results, "folder");
        if (!options_.overwrite) figure::check_plan_files(options_.output);
    }

    figure::RasterRunOptions options_;
};

/// Suns of "times", each named by its time.
void take_suns(const json::Value& times, const std::string& zone, FigureCall& call,
               json::ObjectReader& reader, figure::Shadow& figure) {
    if (times.items.empty()) reader.fail(times.line, "times", "expected a list of one or more");
    const sun::Zone of = session::zone_of(zone, call.terrain().middle()).zone;
    for (const json::Value& time : times.items) {
        if (time.kind != json::Value::Kind::Number)
            reader.fail(times.line, "times", "expected numbers");
        const sun::Instant utc = instant_of(time.number);
        figure.suns.push_back(
            figure::sun_over_middle(call.whole().posts(), utc, figure.refraction));
        figure.names.push_back(sun::to_iso(utc, of));
    }
}

void shadow(FigureCall& call, json::ObjectReader& reader) {
    const json::Value* const times = reader.take("times");
    scene::TimeSpec spec;
    spec.at = reader.string("time", "");
    spec.date = reader.string("date", "");
    spec.zone = reader.string("zone", "");
    const std::string sun = reader.string("sun", "");
    if ((times != nullptr) + !spec.at.empty() + !sun.empty() != 1)
        reader.fail(reader.line(), "", "expected one of time, times and sun");
    if (spec.at.empty() && !spec.date.empty())
        reader.fail(reader.line_of("date"), "date", "needs an event in time");
    if (!sun.empty() && (!spec.zone.empty() || reader.has("refraction")))
        reader.fail(reader.line_of("sun"), "sun",
                    "is a direction as seen, without zone and refraction");
    figure::Shadow figure;
    figure.soft = reader.boolean("soft", false);
    call.take_common(reader, figure);
    figure.refraction = sun.empty() ? refraction_of(reader) : "";
    reader.finish();
    if (times) {
        take_suns(*times, spec.zone, call, reader, figure);
    } else if (!sun.empty()) {
        figure.suns = {figure::sun_as_seen(sun, call.whole().grid())};
    } else {
        const sun::ParsedTime when = session::parse(spec, call.terrain());
        figure.suns = {figure::sun_over_middle(call.whole().posts(), when.utc, figure.refraction)};
    }
    call.run(figure);
}

struct Days {
    std::string from, to;  ///< both included
};

/// "date", or "from" and "to", or "year".
Days days_of(json::ObjectReader& reader) {
    const std::string date = reader.string("date", "");
    const Days days{reader.string("from", ""), reader.string("to", "")};
    const int year =
        static_cast<int>(reader.number("year", 0, sun::kFirstYear, sun::kLastYear, true));
    const int given = !date.empty() + (!days.from.empty() || !days.to.empty()) + (year != 0);
    if (given != 1 || days.from.empty() != days.to.empty())
        reader.fail(reader.line(), "", "expected one of date, from and to, or year");
    if (!date.empty()) return {date, date};
    if (year != 0) return {fmt::format("{}-01-01", year), fmt::format("{}-12-31", year)};
    return days;
}

/// From the beginning of the first day to the end of the last one.
sun::TimeSpan time_of(const Days& days, const sun::Zone& zone) {
    const sun::Date first = sun::parse_date(days.from), last = sun::parse_date(days.to);
    if (last < first)
        bad_input(fmt::format("relevo_sun_hours: from: {} is after {}", days.from, days.to));
    return {zone.day(first).begin, zone.day(last).end};
}

/// @throws Error (BadInput) for unknown bands, and for two of one name
void take_bands(json::ObjectReader& reader, figure::Hours& figure) {
    const std::vector<std::string> bands = reader.strings("bands");
    const auto refuse = [&](const std::string& why) {
        reader.fail(reader.line_of("bands"), "bands", why);
    };
    for (const std::string& band : bands)
        if (!contains(figure::Hours::all_words(), band))
            refuse(fmt::format("expected some of {} but got {}",
                               fmt::join(figure::Hours::all_words(), ", "), band));
    if (!bands.empty()) figure.words = bands;
    const std::string repeated = figure.repeated_word();
    if (!repeated.empty()) refuse(repeated + " is named twice");
}

/// Tilt and azimuth of a plane; none: the ground's.
std::optional<light::Plane> plane_of(json::ObjectReader& reader) {
    const bool tilted = reader.has("tilt"), faces = reader.has("azimuth");
    const light::Plane plane{radians(number(reader, figure::kTilt_deg)),
                             radians(number(reader, figure::kAzimuth_deg))};
    if (faces && !tilted) reader.fail(reader.line_of("azimuth"), "azimuth", "needs tilt");
    if (!faces && plane.tilt_rad > 0)
        reader.fail(reader.line_of("tilt"), "tilt", "needs azimuth, where the plane faces");
    if (!tilted) return std::nullopt;
    return plane;
}

void sun_hours(FigureCall& call, json::ObjectReader& reader) {
    figure::Hours figure;
    const Days days = days_of(reader);
    const std::string zone = reader.string("zone", "");
    take_bands(reader, figure);
    figure.step_s = number(reader, figure::kStep_s);
    for (const char* key : {"linke", "albedo", "tilt", "azimuth"})
        if (reader.has(key) && !figure.has_irradiation())
            reader.fail(reader.line_of(key), key,
                        "needs one of the bands global, beam, diffuse, reflected");
    figure.irradiation.linke = number(reader, figure::kLinke);
    figure.irradiation.albedo = number(reader, figure::kAlbedo);
    figure.irradiation.plane = plane_of(reader);
    call.take_common(reader, figure);
    figure.refraction = refraction_of(reader);
    reader.finish();
    figure.zone = session::zone_of(zone, call.terrain().middle()).zone;
    figure.time = time_of(days, figure.zone);
    call.run(figure);
}

void sky_view(FigureCall& call, json::ObjectReader& reader) {
    figure::SkyView figure;
    figure.directions = static_cast<int>(number(reader, figure::kSkyDirections, true));
    figure.level = reader.boolean("level", false);
    call.take_common(reader, figure);
    reader.finish();
    call.run(figure);
}

void horizons(FigureCall& call, json::ObjectReader& reader) {
    figure::Horizons figure;
    figure.directions = static_cast<int>(number(reader, figure::kHorizonDirections, true));
    call.take_common(reader, figure);
    reader.finish();
    call.run(figure);
}

using Make = void (*)(FigureCall&, json::ObjectReader&);

/// @throws Error (BadInput) for an unknown figure
Make maker_of(std::string_view figure) {
    if (figure == "shadow") return shadow;
    if (figure == "sun_hours") return sun_hours;
    if (figure == "sky_view") return sky_view;
    if (figure == "horizons") return horizons;
    bad_input(fmt::format(
        "figure: expected one of shadow, sun_hours, sky_view, horizons but got {}", figure));
}

/// @param function  of the interface
template <auto make>
relevo_result raster(const char* function, relevo_dem* dem, const char* text, float* values,
                     size_t count, const relevo_progress* progress, const char** about) {
    return guarded(function, [&] {
        RasterCall call(dem, values, count, progress, about);
        Options options(text, function);
        make(call, options.reader());
    });
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_shadow(relevo_dem* dem, const char* options, float* lit, size_t count,
                            const relevo_progress* progress, const char** about) {
    return c::raster<c::shadow>("relevo_shadow", dem, options, lit, count, progress, about);
}

relevo_result relevo_sun_hours(relevo_dem* dem, const char* options, float* values, size_t count,
                               const relevo_progress* progress, const char** about) {
    return c::raster<c::sun_hours>("relevo_sun_hours", dem, options, values, count, progress,
                                   about);
}

relevo_result relevo_sky_view(relevo_dem* dem, const char* options, float* share, size_t count,
                              const relevo_progress* progress, const char** about) {
    return c::raster<c::sky_view>("relevo_sky_view", dem, options, share, count, progress, about);
}

relevo_result relevo_horizons(relevo_dem* dem, const char* options, float* elevation_deg,
                              size_t count, const relevo_progress* progress, const char** about) {
    return c::raster<c::horizons>("relevo_horizons", dem, options, elevation_deg, count, progress,
                                  about);
}

relevo_result relevo_tiles(relevo_dem* dem, const char* figure, const char* options,
                           const char* files, const relevo_progress* progress,
                           const char** answer) {
    return c::guarded("relevo_tiles", [&] {
        const c::Make make = c::maker_of(&c::need(figure, "figure"));
        c::TilesCall call(dem, figure, options, files, progress, answer);
        c::Options given(options, "relevo_tiles");
        make(call, given.reader());
    });
}
