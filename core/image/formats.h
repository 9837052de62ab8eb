#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/allowed_name.h"
#include "image/image.h"

/// What the module `image_formats` offers: every format but PNG, through OpenImageIO. It is a
/// module of its own, loaded on first use, because OpenImageIO's libraries take 0.3 s to load.
namespace relevo::image {

/// A picture with longer sides, or that takes more memory, is not read.
inline constexpr std::uint64_t kMaxSide_px = 32768;
inline constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{1} << 30;

/// Why a picture of that size is not read; empty where it is.
/// @param pixel_bytes  of all channels
inline std::string size_fault(std::uint64_t width_px, std::uint64_t height_px,
                              std::uint64_t pixel_bytes) {
    if (width_px > 0 && height_px > 0 && width_px <= kMaxSide_px && height_px <= kMaxSide_px &&
        width_px * height_px * pixel_bytes <= kMaxPictureBytes)
        return {};
    return "expected 1 to " + std::to_string(kMaxSide_px) + " pixels a side and at most " +
           std::to_string(kMaxPictureBytes >> 20) + " MiB of them but got " +
           std::to_string(width_px) + " x " + std::to_string(height_px);
}

struct FormatsModule {
    /// Each returns an empty text on success, else the reason for failing. Encoders fill memory: of
    /// a disk that is full some would say nothing.
    std::string (*encode)(std::vector<std::byte>& bytes, const std::string& format, const Picture&,
                          const Metadata&, int quality);
    std::string (*read8)(const AllowedName&, Image8&);
    std::string (*read_float)(const AllowedName&, ImageF&);
    std::string (*read_layers)(const AllowedName&, std::vector<Channel>&);
    std::string (*read_exr_texts)(const AllowedName&, Metadata&);
    /// Why a format cannot be written on this machine; empty where it can.
    std::string (*missing)(const std::string& format);
};

/// The one function that the module exports.
extern "C" const FormatsModule* relevo_image_formats();

}  // namespace relevo::image
