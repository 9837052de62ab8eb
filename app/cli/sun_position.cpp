#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "cli/shared.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "geo/format.h"
#include "geo/geodetic.h"
#include "sun/position.h"

namespace relevo::cli {
void add_sun_position(CLI::App& sun_verb) {
    struct Arguments {
        std::string at;
        TimeArguments time;
        RefractionArguments refraction;
        bool json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *sun_verb.add_subcommand("position", "Where the sun stands");
    verb.add_option("--at", arguments->at, "Place: LAT,LON[,H]")->required();
    arguments->time.add_to(verb);
    verb.get_option("--time")->required();
    arguments->refraction.add_to(verb);
    verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.callback([arguments] {
        const geo::PlaceText at = geo::parse_place(arguments->at, "--at");
        if (at.above_ground)
            bad_usage("--at: a height above the ground needs a DEM; give one above sea level");
        const sun::ParsedTime when = session::parse(arguments->time.moment(), {}, at);
        const sun::Position position = sun::position(when.utc, at.place);
        const sun::Refraction air = arguments->refraction.at(at.place);
        const double apparent_deg = degrees(air.apparent_rad(position.elevation_rad));
        const double azimuth_deg = degrees(position.azimuth_rad);
        if (arguments->json) {
            nlohmann::ordered_json json = {
                {"utc", sun::to_iso(when.utc, 3)},
                {"azimuth_deg", azimuth_deg},
                {"elevation_deg", degrees(position.elevation_rad)},
                {"apparent_elevation_deg", apparent_deg},
                {"refraction", air.description()},
                {"distance_au", position.distance_au},
                {"declination_deg", degrees(position.declination_rad)},
                {"right_ascension_deg", degrees(position.right_ascension_rad)},
                {"semidiameter_deg", degrees(position.semidiameter_rad)},
                {"equation_of_time_min", position.equation_of_time_s / 60}};
            add_assumption(json, when.assumption);
            fmt::print("{}", json_text(json));
            return;
        }
        fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(at.place),
                   at.place.height_m);
        fmt::print("time                {}  ({})\n", sun::to_iso(when.utc, when.zone),
                   sun::to_iso(when.utc));
        fmt::print("azimuth             {:9.4f} deg  {}\n", azimuth_deg,
                   compass_point(azimuth_deg));
        fmt::print("elevation           {:9.4f} deg  geometric, without air\n",
                   degrees(position.elevation_rad));
        fmt::print("apparent elevation  {:9.4f} deg  {}\n", apparent_deg, air.description());
        fmt::print("distance            {:9.6f} au\n", position.distance_au);
        fmt::print("declination         {:9.4f} deg\n", degrees(position.declination_rad));
        fmt::print("equation of time    {:9.3f} min\n", position.equation_of_time_s / 60);
    });
}

}  // namespace relevo::cli
