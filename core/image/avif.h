#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

/// AVIF by libheif, which OpenImageIO is built on. Its own way takes no XMP, and no memory to write
/// to.
namespace relevo::image {

/// Why no AVIF can be written on this machine; empty where it can.
std::string avif_missing();

/// Encodes RGB or RGBA with the same resolution of colour as of brightness.
/// @param xmp      packet to add; may be empty
/// @param quality  1 to 100
/// @returns the reason for failing, or nothing
std::string encode_avif(std::vector<std::byte>& bytes, const Image8& image, std::string_view xmp,
                        int quality);

}  // namespace relevo::image
