#include "dem/guard.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

// The bytes are a file, and what others name.
const Target kGuard("guard", [](std::string_view bytes) {
    [[maybe_unused]] static const bool is_disarmed = (dem::disarm_gdal(), true);
    const AllowedName name(file(bytes, "mosaic.vrt").string());
    attempt([&] { dem::refuse_unreadable(std::string(bytes)); });
    dem::disarmed_driver_of(name);
    dem::refuse_unsafe_vrt(name);
});

}  // namespace relevo::fuzz
