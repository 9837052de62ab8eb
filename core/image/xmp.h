#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

/// Texts in pictures as XMP (ISO 16684-1): those whose keyword begins with `relevo:`, each a
/// property of the namespace https://relevo.invalid/ns/1.0/, which names nothing but itself; and
/// those that begin with `GPano:`, properties of Google's Photo Sphere XMP Metadata.
namespace relevo::image {

bool is_xmp_keyword(std::string_view keyword);

/// The packet of the keywords that go into XMP; empty where there are none.
std::string xmp_packet(const Metadata& metadata);

/// The texts of the packet in a file of any format, which XMP has be found by its first words; none
/// where there is no packet.
Metadata texts_in_xmp(std::string_view file);

/// A longer packet does not go into a JPEG: of a segment's 65535 bytes less its length and name.
inline constexpr std::size_t kLongestXmpOfJpeg = 65502;

/// Puts a packet into an encoded picture. @returns why it cannot be, or nothing
/// Sources: XMP Specification Part 3 (Adobe, 2020), 1.1.3; WebP Container Specification (Google).
std::string add_xmp_to_jpeg(std::vector<std::byte>& file, std::string_view packet);
std::string add_xmp_to_webp(std::vector<std::byte>& file, std::string_view packet, int width_px,
                            int height_px);

}  // namespace relevo::image
