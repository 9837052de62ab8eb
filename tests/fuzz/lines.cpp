#include "dem/lines.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kLines("lines", [](std::string_view bytes) {
    static const dem::Grid earth(360, 180, {-179.5, 1, 0, 89.5, 0, -1}, geo::Crs());
    const std::string path = file(bytes, "lines");
    attempt([&] { dem::read_lines(path, "tracks.file", "ele", earth); });
    dem::read_lines(path, "tracks.file", "", earth);
});

}  // namespace relevo::fuzz
