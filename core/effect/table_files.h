#pragma once

#include <filesystem>

#include "image/ktx.h"

namespace relevo::effect {

/// Sides of tables in files are at most this long.
inline constexpr int kMaxTableSide = 4096;

/// A table of numbers, a texel of R32F each: columns along s, lines along t.
///
/// Numbers are parted by commas, semicolons, tabs or spaces. A first line without numbers is a
/// heading; lines that begin with # are skipped.
/// @param file  empty: one texel of 0
/// @throws Error (BadInput) `plugin: FILE:LINE: ...` for what is not a finite number, lines of
///     different lengths, a file without lines, and more than kMaxTableSide lines or columns
image::TextureData read_table(const std::filesystem::path& file);

/// A table of colours by colours, as Adobe's .cube files have it (LUT_3D_SIZE): RGBA32F, red along
/// s, green along t, blue along r. Source: Adobe, Cube LUT Specification 1.0 (2013).
/// @param file  empty: one texel of black
/// @throws Error (BadInput) `plugin: FILE:LINE: ...` for a file without a size from 2 to 128, with
///     another domain than 0 to 1, or with too few or too many colours
image::TextureData read_cube(const std::filesystem::path& file);

}  // namespace relevo::effect
