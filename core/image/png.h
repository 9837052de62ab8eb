#pragma once

#include <filesystem>

#include "image/image.h"

namespace relevo::image {

/// Writes a PNG with the sRGB chunk and `metadata` as iTXt, all of it but finish().
/// @throws Error (Failed)
void write_png(OutputFile& file, const Image8& image, const Metadata& metadata);

/// Reads any PNG as 8-bit values, palettes and low bit depths expanded. @throws Error (BadInput)
Image8 read_png(const std::filesystem::path& path, Metadata* metadata = nullptr);

}  // namespace relevo::image
