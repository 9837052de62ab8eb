#pragma once

#include <array>
#include <cstddef>

namespace relevo {

/// How a texel is stored, in files of textures and on the device. Multi-byte values are of the
/// machine; files have them little-endian.
enum class PixelFormat {
    R8,
    RG8,
    RGBA8,
    Srgb8A8,  ///< R, G, B in sRGB encoding, read as linear; A linear
    R16,
    RG16Snorm,
    RG16UI,
    R16F,
    RG16F,
    RGBA16F,
    R32F,
    RG32F,
    RGBA32F,
    R32UI,
    RGBA32UI,
    Depth32F,
    Stencil8,
};

/// What the bits of a channel mean.
enum class ChannelKind {
    Unorm,  ///< 0..1 in whole steps
    Snorm,  ///< -1..1 in whole steps
    Whole,  ///< a whole number, not negative
    Float,  ///< IEEE, a half where it has two bytes
};

struct PixelLayout {
    PixelFormat format;
    int channels;
    int channel_bytes;
    ChannelKind kind;

    constexpr int bytes() const { return channels * channel_bytes; }
};

/// The one table of formats, in the order of their names. What a layer knows of them beside this,
/// GL's or Vulkan's number, stands in a table of its own by PixelFormat.
inline constexpr std::array kPixelLayouts{
    PixelLayout{PixelFormat::R8, 1, 1, ChannelKind::Unorm},
    PixelLayout{PixelFormat::RG8, 2, 1, ChannelKind::Unorm},
    PixelLayout{PixelFormat::RGBA8, 4, 1, ChannelKind::Unorm},
    PixelLayout{PixelFormat::Srgb8A8, 4, 1, ChannelKind::Unorm},
    PixelLayout{PixelFormat::R16, 1, 2, ChannelKind::Unorm},
    PixelLayout{PixelFormat::RG16Snorm, 2, 2, ChannelKind::Snorm},
    PixelLayout{PixelFormat::RG16UI, 2, 2, ChannelKind::Whole},
    PixelLayout{PixelFormat::R16F, 1, 2, ChannelKind::Float},
    PixelLayout{PixelFormat::RG16F, 2, 2, ChannelKind::Float},
    PixelLayout{PixelFormat::RGBA16F, 4, 2, ChannelKind::Float},
    PixelLayout{PixelFormat::R32F, 1, 4, ChannelKind::Float},
    PixelLayout{PixelFormat::RG32F, 2, 4, ChannelKind::Float},
    PixelLayout{PixelFormat::RGBA32F, 4, 4, ChannelKind::Float},
    PixelLayout{PixelFormat::R32UI, 1, 4, ChannelKind::Whole},
    PixelLayout{PixelFormat::RGBA32UI, 4, 4, ChannelKind::Whole},
    PixelLayout{PixelFormat::Depth32F, 1, 4, ChannelKind::Float},
    PixelLayout{PixelFormat::Stencil8, 1, 1, ChannelKind::Whole},
};

constexpr const PixelLayout& layout_of(PixelFormat format) {
    return kPixelLayouts[static_cast<std::size_t>(format)];
}

static_assert([] {
    for (std::size_t i = 0; i < kPixelLayouts.size(); ++i)
        if (kPixelLayouts[i].format != static_cast<PixelFormat>(i)) return false;
    return kPixelLayouts.back().format == PixelFormat::Stencil8;
}());

}  // namespace relevo
