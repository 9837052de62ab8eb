#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "effect/registry.h"
#include "effect/selection.h"
#include "render/programs.h"
#include "shader/param_store.h"

namespace relevo::test {

using Ids = std::vector<std::string>;

/// Every effect of the plugins' folder, and every selection of them whose programs are tried.
class Shipped {
  public:
    const effect::Registry registry = effect::Registry::load_installed();

    shader::ParamStore values() const;

    /// None, each alone with what it requires, all that may be on at once, and those but one.
    std::map<std::string, effect::Switches> selections() const;

    /// As many effects as may be on at once, in every way: with each the others that no word of it
    /// excludes.
    std::set<Ids> everything() const;

  private:
    /// With all others on, clouds and one of some effects of maps need more than the 32 textures of
    /// a device: an error says so.
    static bool too_many_textures(const Ids& ids, const std::string& id);
};

/// The programs of a selection's frames, as a renderer stitches them. No device is needed.
render::StitchedFrames stitched(const effect::Selection& selection,
                                const shader::ParamStore& values,
                                const render::ProgramOptions& options, bool constants = false);

}  // namespace relevo::test
