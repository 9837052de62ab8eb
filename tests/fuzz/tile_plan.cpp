#include "output/tile_plan.h"

#include <cstdlib>
#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

// A plan that is read is written as it was, and its grid is cut into tiles.
const Target kTilePlan("tile_plan", [](std::string_view bytes) {
    file(bytes, output::kPlanFile);
    output::foreign_plan_files(folder());
    const std::optional<output::TilePlan> plan = output::read_plan(folder());
    if (!plan) return;
    output::write_plan(folder(), *plan);
    const std::optional<output::TilePlan> again = output::read_plan(folder());
    if (!again || again->tiles != plan->tiles || again->digest != plan->digest) std::abort();
    output::stamp_of(plan->dems);
    const dem::Window whole{0, 0, plan->grid.columns(), plan->grid.rows()};
    const auto tiles = output::tiles_of(plan->grid, whole, 1 + (whole.columns + whole.rows) / 16);
    if (output::share_of(tiles.size(), 1, 1).second != tiles.size()) std::abort();
});

}  // namespace relevo::fuzz
