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
#include "report/asked.h"
#include "report/doubts.h"
#include "report/json_parts.h"

/// What the verbs under `relevo sun` and `relevo moon` share.
namespace relevo::cli {

/// --at, --name and --eye-height; --at-crs, for an --at in its coordinates.
struct PlaceArguments {
    std::string at, name, crs;
    std::optional<double> eye_height_m;

    void add_to(Verb verb);
    /// @throws Error (Usage), (BadInput) for a CRS that is not known, a place outside of it
    geo::PlaceText parse() const;
};

/// --date, or --from and --to, or --year; and --tz, by which days are counted.
struct DaysArguments : report::DaysText {
    void add_to(Verb verb);
    /// --year and --tz alone, for what takes a whole year.
    void add_year_to(Verb verb);
    /// @param tell  the user which zone is taken where --tz names none
    /// @throws Error as report::DaysText::parse and session::zone_of
    report::Days parse(const geo::Geodetic& place, bool tell = true) const;
};

/// What is wrong with --tilt (a number or `ground`) and with --azimuth of a plane; empty: nothing.
std::string fault_of_tilt(const std::string& text);
std::string fault_of_azimuth(const std::string& text);

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

    report::View view() const;
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
    /// How a place is looked from.
    /// @param eye_height_m  --eye-height
    /// @param light         LightArguments::view()
    report::View view(const std::optional<double>& eye_height_m, report::View light = {}) const;
};

/// What a verb has to say, in each of its forms; each is made only where it is asked for.
struct Forms {
    std::function<chart::Drawing()> drawing;
    std::function<std::string()> csv;
    std::function<nlohmann::ordered_json()> json;
    std::function<void()> print;  ///< on standard output, for people
};

/// Opens a file that -o names, before any work is done.
/// @param dem  what the verb reads besides
/// @throws Error (Usage) for an unknown ending, and as FilesInUse
OutputFile* open_result(const ResultArguments& result, FilesInUse& files, const DemArguments& dem);

/// A file that -o names, and in small letters its ending, by which it has its form.
struct OpenResult {
    std::string ending;
    OutputFile* file;
};
using OpenResults = std::vector<OpenResult>;

/// -o, once or several times, --overwrite, --scale, --csv, --json.
struct OutputArguments {
    std::vector<std::string> paths, endings;  ///< as given; what the verb writes
    bool overwrite = false;
    double scale = 1.5;
    bool csv = false, json = false;
    std::string schema;  ///< of the verb's JSON

    void add_to(Verb verb, const std::vector<std::string>& endings_of_verb);
    /// Opens the files that -o names, before any work is done.
    /// @param dem  what the verb reads besides
    /// @throws Error (Usage) for an unknown ending, and as FilesInUse
    OpenResults open(FilesInUse& files, const DemArguments& dem) const;
    /// Whether one of them has that ending.
    bool has(std::string_view ending) const;
    bool has_drawing() const { return has("svg") || has("png"); }

    /// Writes them, and on standard output what --csv or --json ask for; without any of these the
    /// text for people. The files appear together or not at all.
    /// @param results  as open() gave them
    void deliver(const Forms& forms, const OpenResults& results) const;
};

using geo::compass_point;
using report::angle_deg;
using report::hours_text;

/// "05:25:12", by the clock of the zone.
std::string clock_text(sun::Instant utc, const sun::Zone& zone);

/// Lines of a CSV file before its header: what the figures mean.
std::string csv_remarks(const std::vector<std::string>& remarks);

}  // namespace relevo::cli
