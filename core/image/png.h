#pragma once

#include <cstddef>
#include <filesystem>

#include "image/image.h"

namespace relevo::image {

/// libpng does not read a longer text back [bytes]: PNG_USER_CHUNK_MALLOC_MAX is 8,000,000.
inline constexpr std::size_t kLongestTextOfPng = 7'900'000;

/// Writes a PNG with the sRGB chunk and `metadata` as iTXt, all of it but finish().
/// @throws Error (Failed)
void write_png(OutputFile& file, const Image8& image, const Metadata& metadata);

/// Reads any PNG as 8-bit values, palettes and low bit depths expanded. @throws Error (BadInput)
Image8 read_png(const std::filesystem::path& path, Metadata* metadata = nullptr);

}  // namespace relevo::image
