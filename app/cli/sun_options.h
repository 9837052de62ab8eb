#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files_in_use.h"
#include "base/held_notices.h"
#include "chart/drawing.h"
#include "cli/shared.h"
#include "dem/posts.h"
#include "geo/format.h"
#include "light/point/direct_light.h"
#include "light/point/doubt.h"
#include "light/point/horizon.h"
#include "sun/events.h"

/// What the verbs under `relevo sun` and `relevo moon` share.
namespace relevo::cli {

/// --at, --name and --eye-height; --at-crs.
struct PlaceArguments {
    std::string at, name, crs;
    std::optional<double> eye_height_m;

    void add_to(Verb verb);
    /// --at-crs, for an --at in its coordinates.
    void add_crs_to(Verb verb);
    /// @throws Error (Usage), (BadInput) for a CRS that is not known, a place outside of it
    geo::PlaceText parse() const;
};

/// --date, or --from and --to, or --year; and --tz, by which days are counted.
struct DaysArguments {
    std::string date, from, to, zone;
    std::optional<int> year;

    void add_to(Verb verb);
    /// --year and --tz alone, for what takes a whole year.
    void add_year_to(Verb verb);
    bool given() const { return !date.empty() || !from.empty() || !to.empty() || year; }

    struct Days {
        sun::Date first, last;
        sun::Zone zone;
        std::string assumption;  ///< of the zone; empty where none was made
        bool single = false;     ///< --date
    };
    /// @param place  whose zone is taken where --tz names none
    /// @param tell   the user which zone that is
    /// @throws Error (Usage) for no date or too many, (BadInput) for a day that is none, dates
    ///     backwards, a year that is not computed, and as session::zone_of
    Days parse(const geo::Geodetic& place, bool tell = true) const;
};

/// Reads --step of time, "3min" or minutes alone.
/// @throws Error (Usage) where it is none, or not within the bounds
double step_s_of(const std::string& step, double least_s, double most_s);

/// --limb, --refraction, --dip: what rising and shining mean.
struct LightArguments {
    sun::Body body = sun::Body::Sun;  ///< what rises and shines; set before add_to()
    RefractionArguments refraction;
    std::optional<std::string> limb;
    std::optional<double> dip_deg;

    void add_to(Verb verb);
    /// --dip, where rising over a level horizon is asked for.
    void add_dip_to(Verb verb);

    /// Over a level horizon: the Naval Observatory's, unless an option says otherwise.
    /// @param eye_height_m  --eye-height
    /// @throws Error (Usage) for --dip together with --eye-height
    sun::RiseRule rule(const geo::Geodetic& place, const std::optional<double>& eye_height_m) const;
    light::LightOptions light(const geo::Geodetic& place,
                              const std::optional<double>& eye_height_m) const;
};

/// The DEM, and the horizon of a place on it.
struct TerrainView {
    TerrainView(dem::Posts posts, const geo::Geodetic& place, const light::HorizonOptions& options)
        : dem(std::move(posts)), horizon(dem, place, options) {}

    const dem::Posts dem;
    const light::TerrainHorizon horizon;  // refers to dem
};

/// DEM..., -k and --highest, for verbs that look at the terrain from a place.
struct TerrainArguments {
    DemArguments dem;
    double refraction = figure::kTerrestrialRefraction.value;
    std::optional<double> highest_m;

    void add_to(Verb verb);
    bool given() const { return !dem.paths.empty(); }
    /// @throws Error as dem::load
    dem::Posts load() const {
        const log::HeldNotices notices;
        return dem::Posts::load(dem.paths, dem.options());
    }
    /// How the horizon of a place is looked at.
    /// @param eye_height_m  --eye-height
    /// @throws Error (Usage) where the place has a height too
    light::HorizonOptions horizon(const geo::PlaceText& at,
                                  const std::optional<double>& eye_height_m) const;
    /// Loads the DEM. @throws Error as dem::load and light::TerrainHorizon
    std::unique_ptr<TerrainView> view_from(const PlaceArguments& place) const;
};

/// Warns, once each, of directions in which the blocking ridge may lie beyond the DEM, and of those
/// in which it may stand in a hole.
void warn_of(const light::Doubt& doubt);

/// "from azimuth 64 (ENE) to 88 (E), and at azimuth 97 (E)", of directions that a reader tells
/// apart; empty without any.
std::string sectors_text(const std::vector<light::Sector>& sectors);

nlohmann::ordered_json sectors_json(const std::vector<light::Sector>& sectors);
nlohmann::ordered_json spans_json(const std::vector<sun::TimeSpan>& spans);

constexpr int kDoubtDirections = 1440;  ///< of a profile that doubts are looked for in

/// What a verb has to say, in each of its forms; each is made only where it is asked for.
struct Forms {
    std::function<chart::Drawing()> drawing;
    std::function<std::string()> csv;
    std::function<nlohmann::ordered_json()> json;
    std::function<void()> print;  ///< on standard output, for people
};

/// -o, --overwrite, --scale, --csv, --json.
struct OutputArguments : ResultArguments {
    double scale = 1.5;
    bool csv = false, json = false;

    void add_to(Verb verb, const std::vector<std::string>& endings_of_verb);
    /// Opens the file that -o names, before any work is done. Null without -o.
    /// @param dem  what the verb reads besides
    /// @throws Error (Usage) for an unknown ending, and as FilesInUse
    OutputFile* open(FilesInUse& files, const DemArguments& dem) const;
    bool is_drawing() const { return ending() == "svg" || ending() == "png"; }

    /// Writes the file that -o names, and on standard output what --csv or --json ask for; without
    /// any of them the text for people.
    /// @param file  as open() gave it
    void deliver(const Forms& forms, OutputFile* file) const;
};

/// "46.55,8.56" as --at takes it, whole.
nlohmann::ordered_json place_json(const geo::Geodetic& place);

/// Puts `assumptions` into an object, where there is one.
void add_assumption(nlohmann::ordered_json& json, const std::string& assumption);

/// An angle in degrees, rounded to 0.04 milliarcseconds: 236.9, not 236.89999999999998.
double angle_deg(double angle_rad);

/// The time in UTC with milliseconds, or null.
nlohmann::ordered_json utc_json(const std::optional<sun::Instant>& utc);

using geo::compass_point;

/// "05:25:12", by the clock of the zone.
std::string clock_text(sun::Instant utc, const sun::Zone& zone);

/// "8:23:05", of any length.
std::string hours_text(double seconds);

/// Lines of a CSV file before its header: what the figures mean.
std::string csv_remarks(const std::vector<std::string>& remarks);

}  // namespace relevo::cli
