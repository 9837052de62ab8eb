#include "overlay/camera_photo.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

const Target kCameraPhoto("camera_photo", [](std::string_view bytes) {
    overlay::camera_photo(file(bytes, "photo.jpg"));
});

}  // namespace relevo::fuzz
