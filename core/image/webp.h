#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

/// WebP with alpha, which it has straight. OpenImageIO 2.4 divides colours by alpha on the way to a
/// file and multiplies them on the way back, whatever it is told.
namespace relevo::image {

/// @param image  RGBA
/// @returns the reason for failing, or nothing
std::string encode_webp(std::vector<std::byte>& bytes, const Image8& image, int quality);

/// @param image  RGBA of the size of the file's
std::string decode_webp(const std::filesystem::path& path, Image8& image);

}  // namespace relevo::image
