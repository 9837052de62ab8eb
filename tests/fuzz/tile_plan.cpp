#include "output/tile_plan.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    file(bytes, output::kPlanFile);
    output::read_plan(folder());
}
