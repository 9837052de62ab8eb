#include "climate/land_cover.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kLandCover("land_cover", [](std::string_view bytes) {
    climate::LandCoverTable::read(file(bytes, "classes.csv"));
});

}  // namespace relevo::fuzz
