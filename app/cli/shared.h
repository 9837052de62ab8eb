#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

#include "base/files_in_use.h"
#include "dem/load.h"
#include "light/event_time.h"
#include "scene/view.h"
#include "sun/position.h"
#include "sun/refraction.h"
#include "sun/zone.h"

/// Options that several verbs take. Each struct adds its options to a verb, and makes a value of
/// core's from what was given.
namespace relevo::cli {

/// DEM... and how to read it.
struct DemArguments {
    std::vector<std::string> paths;
    dem::LoadOptions options;  ///< valid once the line has been parsed

    void add_to(CLI::App& verb);
    /// Adds the files that are named. @throws Error as FilesInUse::add_input
    void add_inputs(FilesInUse& files) const;
    /// Adds those that belong to them, where an output replaces a file: finding them takes time.
    void add_further_inputs(FilesInUse& files) const;
};

/// --time, --date and --tz.
struct TimeArguments {
    std::string time, date, zone;

    void add_to(CLI::App& verb);
    /// @throws Error (Usage) for --date or --tz without --time, which would say nothing
    bool given() const;
    /// First and last light hang on the terrain, and events without a place happen in its middle;
    /// all other times are known without it.
    bool needs_dem() const;
    /// Tells the user where a wall time was skipped or came twice.
    /// @throws Error (Usage, BadInput)
    sun::ParsedTime parse() const { return parse(light::TerrainAccess{}); }
    /// Events without a place happen in the middle of the DEM; first and last light are those of
    /// its posts.
    /// @param loaded  of the source, all its posts or means of them
    sun::ParsedTime parse_over(const dem::Source& source, const dem::Heightfield& loaded) const;
    /// Events without a place happen there.
    sun::ParsedTime parse_at(const geo::PlaceText& here) const { return parse({}, here); }

  private:
    sun::ParsedTime parse(const light::TerrainAccess& dem,
                          const std::optional<geo::PlaceText>& here = {}) const;
};

/// --refraction and --no-refraction.
struct RefractionArguments {
    std::string model = "standard";
    bool off = false;

    void add_to(CLI::App& verb);
    sun::Refraction at(const geo::Geodetic& place) const;
};

/// "azimuth 114.27, elevation 65.12 (65.13 with refraction)", in degrees; what is well below the
/// horizon has no refraction that anyone could see.
std::string sun_text(const sun::Position& position, const sun::Refraction& air);

/// Where the camera stands.
struct ViewArguments {
    std::string view, eye, look_at;
    std::optional<double> heading_deg, pitch_deg, fov_deg, focal_length_mm;
    double exaggeration = 1;

    void add_to(CLI::App& verb);
    /// Reads what can be read before any work is done. @throws Error (Usage)
    scene::View view_of() const;
};

/// A number with both ends included; else "expected 0.1 to 170 but got 500".
CLI::Validator in_range(double min, double max);

/// A whole number that an int holds; else "expected a whole number but got 1.5".
CLI::Validator whole_number();

/// JSON as the contract has it, two blanks a level. Text that is not UTF-8, such as a file's name,
/// has U+FFFD for what cannot be said.
std::string json_text(const nlohmann::ordered_json& json);

/// "1280x1024" as width and height. @throws Error (Usage)
glm::ivec2 parse_size(const std::string& text);

}  // namespace relevo::cli
