#include "dem/camera_photo.h"

#include <string>

#include "fuzz/fuzz.h"

void relevo::fuzz::read(std::string_view bytes) {
    dem::camera_photo(file(bytes, "photo.jpg"));
}
