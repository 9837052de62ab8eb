#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/shared.h"
#include "light/direct_light.h"
#include "light/drawing.h"
#include "sun/events.h"

/// What the verbs under `relevo sun` share.
namespace relevo::cli {

/// --at and --name.
struct PlaceArguments {
    std::string at, name;

    void add_to(CLI::App& verb);
    /// @throws Error (Usage)
    geo::PlaceText parse() const;
};

/// --date, or --from and --to, or --year; with --tz, by which days are counted.
struct DaysArguments {
    std::string date, from, to, zone;
    std::optional<int> year;

    void add_to(CLI::App& verb);
    bool given() const { return !date.empty() || !from.empty() || !to.empty() || year; }

    struct Days {
        sun::Date first, last;
        sun::Zone zone;
        bool single = false;  ///< --date
    };
    /// @throws Error (Usage) for no date or too many, (BadInput) for a day that is none, dates
    ///     backwards, a year that is not computed, a date without zone
    Days parse() const;
};

/// --limb, --refraction, --eye-height, --dip: what rising and shining mean.
struct LightArguments {
    RefractionArguments refraction;
    std::optional<std::string> limb;
    std::optional<double> eye_height_m, dip_deg;

    /// @param terrain  the verb takes a DEM, and a dip only counts beside it
    void add_to(CLI::App& verb);
    void add_rule_to(CLI::App& verb);

    /// Over a level horizon: the Naval Observatory's, unless an option says otherwise.
    sun::RiseRule rule(const geo::Geodetic& place) const;
    light::LightOptions light(const geo::Geodetic& place) const;

  private:
    CLI::Option* refraction_option_ = nullptr;
};

/// -k, --highest and the eye, for verbs that look at the terrain.
struct HorizonArguments {
    double refraction = 0.13;
    std::optional<double> highest_m;

    void add_to(CLI::App& verb);
    light::HorizonOptions options(const geo::PlaceText& at,
                                  const std::optional<double>& eye_height_m) const;
    /// Warns of directions in which the blocking ridge may lie beyond the DEM.
    std::vector<light::OpenSector> check(const light::TerrainHorizon& horizon,
                                         const std::vector<light::HorizonPoint>& profile) const;
};

/// -o, --overwrite, --scale, --csv, --json.
struct OutputArguments {
    std::string path;
    std::vector<std::string> endings;  ///< that the verb writes
    double scale = 1.5;
    bool overwrite = false, csv = false, json = false;

    void add_to(CLI::App& verb, const std::vector<std::string>& endings_of_verb);
    /// Before any work is done. @throws Error (Usage) for an unknown ending, (BadInput) for a path
    /// that cannot be written
    void check() const;
    /// "svg"; empty without -o.
    std::string ending() const;
    bool is_drawing() const { return ending() == "svg" || ending() == "png"; }

    void write(const light::Drawing& drawing) const;
    void write(const std::string& text) const;
    void write(const nlohmann::ordered_json& object) const;
};

/// "46.55,8.56" as --at takes it, whole.
nlohmann::ordered_json place_json(const geo::Geodetic& place);

/// An angle in degrees, rounded to 0.04 milliarcseconds: 236.9, not 236.89999999999998.
double angle_deg(double angle_rad);

/// The moment in UTC with milliseconds, or null.
nlohmann::ordered_json utc_json(const std::optional<sun::Instant>& utc);

/// A direction in words of the compass rose: "ESE".
const char* compass_point(double azimuth_deg);

/// "05:25:12", by the clock of the zone.
std::string clock_text(sun::Instant utc, const sun::Zone& zone);

/// "8:23:05", of any length.
std::string hours_text(double seconds);

/// Lines of a CSV file before its header: what the figures mean.
std::string csv_remarks(const std::vector<std::string>& remarks);

}  // namespace relevo::cli
