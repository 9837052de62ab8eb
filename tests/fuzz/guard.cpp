#include "dem/guard.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    dem::refuse_unsafe_vrt(AllowedName(file(bytes, "mosaic.vrt").string()));
}
