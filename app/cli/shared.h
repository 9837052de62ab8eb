#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "dem/load.h"
#include "effect/selection.h"
#include "scene/camera.h"
#include "sun/zone.h"

/// Options that several verbs take.
namespace relevo::cli {

/// DEM... and how to read it.
struct DemArguments {
    std::vector<std::string> paths;
    std::string crs, unit;
    int band = 0;
    std::optional<double> nodata;

    void add_to(CLI::App& verb);
    dem::LoadOptions options() const;
};

/// --time and --tz.
struct TimeArguments {
    std::string time, zone;

    void add_to(CLI::App& verb, bool required);
    bool given() const { return !time.empty(); }
    /// Tells the user where a wall time was skipped or came twice.
    sun::ParsedTime parse() const;
};

/// --no-refraction and --refraction.
struct RefractionArguments {
    bool off = false;
    std::string model = "standard";

    void add_to(CLI::App& verb);
    sun::Refraction refraction(const geo::Geodetic& place) const;
};

/// Where the camera stands.
struct ViewArguments {
    std::string view, eye, look_at;
    std::optional<double> heading_deg, pitch_deg, fov_deg, focal_length_mm;
    double exaggerate = 1;

    void add_to(CLI::App& verb);
    /// @throws Error (Usage) for options that exclude each other or cannot be read; before any work
    void check() const;
    scene::Camera camera(const dem::Heightfield& dem, const geo::LocalFrame& frame,
                         std::span<const glm::dvec3> points, double aspect) const;
};

/// Which effects are on, with which values.
struct EffectArguments {
    std::vector<std::string> only, enable, disable, set, plugin_path;
    std::string preset;
    bool only_given = false;

    void add_to(CLI::App& verb);
};

/// "1280x1024" as width and height. @throws Error (Usage)
glm::ivec2 parse_size(const std::string& text);

}  // namespace relevo::cli
