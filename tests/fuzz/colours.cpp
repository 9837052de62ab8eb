#include <string>

#include "chart/ramp.h"
#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kColours("colours", [](std::string_view bytes) {
    chart::read_ramp(file(bytes, "colours.txt"), 0, 100);
});

}  // namespace relevo::fuzz
