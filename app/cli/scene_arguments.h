#pragma once

#include <string>

#include "cli/effects.h"
#include "cli/shared.h"
#include "scene/scene.h"
#include "session/trust.h"

namespace relevo::cli {

/// A raster on the ground: --overlay and how it is shown.
struct OverlayArguments {
    std::string file, colours, range;

    void add_to(Verb verb);
    /// Puts what was given in the place of what a scene says.
    /// @param more  options that need an overlay were given, too  @throws Error (Usage)
    void apply_to(scene::Scene& scene, bool more) const;
};

/// Everything that a scene is made of: DEM..., --scene, and what else decides about a picture.
struct SceneArguments {
    DemArguments dem;
    TimeArguments time;
    RefractionArguments refraction;
    ViewArguments view;
    EffectArguments effects;
    OverlayArguments overlay;
    OptionArguments values;
    std::string file, size, stamps;
    bool trust = false;  ///< --trust

    /// @param with_file  there is --scene
    void add_to(Verb verb, bool with_file = true);
    /// Puts what was given in the place of what a scene says. @throws Error as those who read
    void apply_to(scene::Scene& scene) const;
    /// What the command line names, and whether it trusts the names in files.
    session::Named named() const;
    /// The scene of --scene, if there is one, with what else was given in the place of its own.
    /// @throws Error as those who read
    scene::Scene scene() const;

  private:
    /// @throws Error (Usage) for options that exclude each other
    void check_map(const scene::Scene& result) const;
    void apply_stamps_to(scene::Stamps& result) const;
    void apply_size_to(scene::Scene& result) const;
};

}  // namespace relevo::cli
