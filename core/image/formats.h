#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

/// What the module `image_formats` offers: every format but PNG, through OpenImageIO. It is a
/// module of its own, loaded on first use, because OpenImageIO's libraries take 0.3 s to load.
namespace relevo::image {

struct FormatsModule {
    /// Each returns an empty text on success, else the reason for failing. Encoders fill memory: of
    /// a disk that is full some would say nothing.
    std::string (*encode8)(std::vector<std::byte>& bytes, const std::string& format, const Image8&,
                           const Metadata&);
    std::string (*encode_float)(std::vector<std::byte>& bytes, const std::string& format,
                                const ImageF&, const Metadata&);
    std::string (*read8)(const std::filesystem::path&, Image8&);
    std::string (*read_float)(const std::filesystem::path&, ImageF&);
};

/// The one function that the module exports.
extern "C" const FormatsModule* relevo_image_formats();

}  // namespace relevo::image
