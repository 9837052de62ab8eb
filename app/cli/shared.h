#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "dem/load.h"
#include "scene/view.h"
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
};

/// --time and --tz.
struct TimeArguments {
    std::string time, zone;

    void add_to(CLI::App& verb);
    bool given() const { return !time.empty(); }
    /// Tells the user where a wall time was skipped or came twice. @throws Error (Usage)
    sun::ParsedTime parse() const;
};

/// --refraction and --no-refraction.
struct RefractionArguments {
    std::string model = "standard";
    bool off = false;

    void add_to(CLI::App& verb);
    sun::Refraction at(const geo::Geodetic& place) const;
};

/// Where the camera stands.
struct ViewArguments {
    std::string view, eye, look_at;
    std::optional<double> heading_deg, pitch_deg, fov_deg, focal_length_mm;
    double exaggeration = 1;

    void add_to(CLI::App& verb);
    /// Reads what can be read before any work is done. @throws Error (Usage)
    scene::View view_of() const;
};

/// "1280x1024" as width and height. @throws Error (Usage)
glm::ivec2 parse_size(const std::string& text);

}  // namespace relevo::cli
