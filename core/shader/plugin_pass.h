#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/pixel_format.h"

namespace relevo::shader {

/// A texture that a plugin computes. Its function `vec4 <id>_pass_<name>(in Texel t)` is called for
/// each texel. Samplers of other passes and of hooks read it.
struct PluginPass {
    /// When the texture is computed.
    enum class When {
        Frame,    ///< in every frame
        Sun,      ///< when the sun has moved
        Changed,  ///< when one of `parameters` has changed
        Dem       ///< once for each DEM
    };

    std::string name;      ///< "blur"
    std::string resource;  ///< "bloom.blur": the sampler `bloom_blur` reads it
    std::string function;  ///< "bloom_pass_blur"
    PixelFormat format = PixelFormat::RGBA16F;
    double scale = 1;           ///< of the frame's width and height, a power of two; 0: fixed size
    int width = 1, height = 1;  ///< fixed size [texels]
    bool linear = true;         ///< filtering; else the nearest texel is read
    When when = When::Frame;
    std::vector<std::string> parameters{};  ///< addresses, for When::Changed
    int line = 0;                           ///< in plugin.json
};

/// A texture of core's that samplers of passes read, `//@ from(core.depth)`.
struct CoreTexture {
    std::string_view name;      ///< "core.ground_depth"
    std::string_view resource;  ///< of the frame graph: "depth@geometry"
};

inline constexpr std::array kCoreTextures{
    CoreTexture{"core.radiance", "radiance"},            // of all pixels: linear, exposed
    CoreTexture{"core.depth", "depth"},                  // of ground and walls
    CoreTexture{"core.ground_depth", "depth@geometry"},  // of ground, before it is shaded
    CoreTexture{"core.normal", "surface"},               // rgb: Surface::normal of ground
    CoreTexture{"core.shadow", "surface"},               // a: visible part of the sun on ground
};

}  // namespace relevo::shader
