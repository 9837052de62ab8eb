#include "dem/guard.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kGuard("guard", [](std::string_view bytes) {
    dem::refuse_unsafe_vrt(AllowedName(file(bytes, "mosaic.vrt").string()));
});

}  // namespace relevo::fuzz
