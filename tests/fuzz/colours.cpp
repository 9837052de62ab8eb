#include <limits>
#include <string>

#include "chart/ramp.h"
#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kColours("colours", [](std::string_view bytes) {
    attempt([&] { chart::named_ramp(bytes, 0, 100).at(40); });
    const chart::Ramp ramp = chart::read_ramp(file(bytes, "colours.txt"), 0, 100);
    for (const double value : {-1e300, 0.0, 40.0, 1e300, std::numeric_limits<double>::quiet_NaN()})
        ramp.at(value);
});

}  // namespace relevo::fuzz
