#include <string>

#include "dem/places.h"
#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kPoints("points", [](std::string_view bytes) {
    const std::string path = file(bytes, "points");
    attempt([&] { dem::read_points(path, "--points"); });
    attempt([&] { dem::read_points(path, "--points", "EPSG:32632"); });
    attempt([&] { dem::read_line(path, "--along"); });
    attempt([&] { dem::read_line(path, "--along", {}, 2); });
    dem::read_times(path, "--times", 1000);
});

}  // namespace relevo::fuzz
