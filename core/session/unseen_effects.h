#pragma once

#include <string>
#include <vector>

#include "session/active_effects.h"

namespace relevo::session {

/// Whether an effect draws anything. @param outside  as below; false without walls and backdrop
bool is_seen(const effect::Effect& effect, bool outside);
/// Whether effects draw walls or a backdrop: else the DEM is seen in the air from anywhere.
bool have_block(const std::vector<const effect::Effect*>& effects);

/// Ids of effects that `asked` or a preset enables and that draw nothing in a view: their hooks are
/// those of the other side of the DEM, or `HAS_outside` omits what they do. Effects with more than
/// hooks, such as marks and instances, are taken to be seen.
/// @param outside  the DEM is seen from outside, as a map or a block
std::vector<std::string> unseen_effects(const ActiveEffects& effects, const scene::Effects& asked,
                                        bool outside);

/// What to say of them; empty if there are none.
std::string unseen_text(const std::vector<std::string>& ids, bool outside);

}  // namespace relevo::session
