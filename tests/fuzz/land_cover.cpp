#include "climate/land_cover.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kLandCover("land_cover", [](std::string_view bytes) {
    attempt([&] { climate::LandCoverTable::named(std::string(bytes)); });
    const auto table = climate::LandCoverTable::read(file(bytes, "classes.csv"));
    climate::text_of(table.classes());
    climate::LandCoverTable::fitting(table.classes());
});

}  // namespace relevo::fuzz
