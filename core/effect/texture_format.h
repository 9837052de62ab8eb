#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <relevo/plugin.h>

#include "base/pixel_format.h"

namespace relevo::effect {

/// The format of a RELEVO_FORMAT_ number; none for other numbers.
constexpr std::optional<PixelFormat> texture_format(std::int32_t number) {
    struct Row {
        std::int32_t number;
        PixelFormat format;
    };
    constexpr std::array kRows{Row{RELEVO_FORMAT_R32F, PixelFormat::R32F},
                               Row{RELEVO_FORMAT_RG32F, PixelFormat::RG32F},
                               Row{RELEVO_FORMAT_RGBA32F, PixelFormat::RGBA32F},
                               Row{RELEVO_FORMAT_RG16F, PixelFormat::RG16F},
                               Row{RELEVO_FORMAT_RGBA16F, PixelFormat::RGBA16F},
                               Row{RELEVO_FORMAT_DEPTH32F, PixelFormat::Depth32F},
                               Row{RELEVO_FORMAT_R16F, PixelFormat::R16F},
                               Row{RELEVO_FORMAT_RGBA8, PixelFormat::RGBA8}};
    for (const Row& row : kRows)
        if (row.number == number) return row.format;
    return std::nullopt;
}

/// Floats of a texel that a module may read; 0 if it may not read the format.
constexpr int readable_floats(PixelFormat format) {
    const PixelLayout& layout = layout_of(format);
    return layout.kind == ChannelKind::Float && layout.channel_bytes == 4 ? layout.channels : 0;
}

}  // namespace relevo::effect
