#include "climate/land_cover.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    climate::LandCoverTable::read(file(bytes, "classes.csv"));
}
