#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

/// WebP with straight alpha. OpenImageIO 2.4 always divides colours by alpha when it writes WebP,
/// and multiplies them when it reads it.
namespace relevo::image {

/// @param image  RGBA
/// @returns the reason for failing, or nothing
std::string encode_webp(std::vector<std::byte>& bytes, const Image8& image, int quality);

/// @param image  RGBA of the size of the file's
std::string decode_webp(std::string_view bytes, Image8& image);

}  // namespace relevo::image
