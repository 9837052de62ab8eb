#include "output/tile_plan.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kTilePlan("tile_plan", [](std::string_view bytes) {
    file(bytes, output::kPlanFile);
    output::read_plan(folder());
});

}  // namespace relevo::fuzz
