#pragma once

#include <optional>
#include <string>

#include "cli/effects.h"
#include "cli/shared.h"
#include "scene/scene.h"

namespace relevo::cli {

/// A raster on the ground: --overlay and how it is shown.
struct OverlayArguments {
    std::string file, colours, range, title;
    std::optional<int> band;
    std::optional<double> opacity;

    void add_to(CLI::App& verb);
    /// Puts what was given in the place of what a scene says. @throws Error (Usage)
    void apply_to(scene::Scene& scene) const;
};

/// What stands on a picture: --stamp and its texts.
struct StampArguments {
    std::string stamps, title, attribution;
    bool no_legend = false;

    void add_to(CLI::App& verb);
    /// Puts what was given in the place of what a scene says. @throws Error (Usage)
    void apply_to(scene::Stamps& stamps) const;
};

/// Everything that a scene is made of: DEM..., --scene, and what else decides about a picture.
struct SceneArguments {
    DemArguments dem;
    TimeArguments time;
    RefractionArguments refraction;
    ViewArguments view;
    EffectArguments effects;
    OverlayArguments overlay;
    StampArguments stamps;
    std::string file, size, holes;
    std::optional<double> exposure_ev, pixel_error;
    bool trust = false;  ///< --trust: Trust

    /// @param with_file  there is --scene
    void add_to(CLI::App& verb, bool with_file = true);
    /// Puts what was given in the place of what a scene says. @throws Error as those who read
    void apply_to(scene::Scene& scene) const;
    /// The scene of --scene, if there is one, with what else was given in the place of its own.
    /// @throws Error as those who read
    scene::Scene scene() const;
};

}  // namespace relevo::cli
