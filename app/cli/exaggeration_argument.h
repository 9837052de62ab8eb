#pragma once

#include <string>

#include "cli/shared.h"
#include "scene/scene.h"

namespace relevo::cli {

/// --exaggerate of commands that may choose it: a number, or auto.
struct ExaggerationArgument {
    std::string text;

    /// Before SceneArguments, which then add no option of this name.
    void add_to(Verb verb);
    /// Without a word it is auto, unless a file describes the scene. auto is 1 for scenes that may
    /// not choose, with a notice if it was given.
    void apply_to(scene::Scene& scene, bool is_described) const;
};

}  // namespace relevo::cli
