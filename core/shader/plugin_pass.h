#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/pixel_format.h"

namespace relevo::shader {

/// Size of what a pass writes or visits: texels of a texture, or elements of a buffer.
struct PassSize {
    double scale = 1;  ///< of the frame's width and height, a power of two; 0: fixed size
    int width = 1, height = 1, depth = 1;  ///< fixed size; a buffer has `width` elements
};

/// A texture or buffer that a plugin computes by its function `<id>_pass_<name>`. Samplers of other
/// passes and of hooks read it.
struct PluginPass {
    enum class Kind {
        Full,     ///< `vec4 pass(in Texel t)` for each texel of a 2-D texture, drawn
        Volume,   ///< `vec4 pass(in Voxel v)` for each texel of a 3-D texture
        Compute,  ///< `void pass(in Invocation i)`, which stores what it likes
    };
    /// What is written.
    enum class Output { Texture, Texture3D, Floats, Uints };
    /// When it is computed.
    enum class When {
        Frame,    ///< in every frame
        Sun,      ///< when the sun has moved
        Changed,  ///< when one of `parameters` has changed
        Dem       ///< once for each DEM
    };

    std::string name;      ///< "blur"
    std::string resource;  ///< "bloom.blur": the sampler `bloom_blur` reads it
    std::string function;  ///< "bloom_pass_blur"
    Kind kind = Kind::Full;
    Output output = Output::Texture;
    PixelFormat format = PixelFormat::RGBA16F;
    PassSize size{};     ///< of what is written
    bool linear = true;  ///< filtering; else the nearest texel is read
    When when = When::Frame;
    std::vector<std::string> parameters{};  ///< addresses, for When::Changed
    int line = 0;                           ///< in plugin.json

    // Of passes that dispatch work groups: Volume and Compute.
    PassSize over{};                          ///< has an invocation for each texel or element
    std::string over_name{};                  ///< "frame", or a pass of the plugin; empty: its own
    std::array<int, 3> local_size{1, 1, 1};   ///< invocations of a work group
    std::array<int, 3> work_groups{0, 0, 0};  ///< a fixed number instead of `over`; 0: none

    bool is_buffer() const { return output == Output::Floats || output == Output::Uints; }
    /// "bloom_blur_out", by which a compute pass writes.
    std::string output_name() const {
        std::string result = resource + "_out";
        std::ranges::replace(result, '.', '_');
        return result;
    }
};

/// The head of a pass's function, with the name `pass`.
constexpr std::string_view signature_of(PluginPass::Kind kind) {
    constexpr std::array<std::string_view, 3> kHeads = {
        "vec4 pass(in Texel t)", "vec4 pass(in Voxel v)", "void pass(in Invocation i)"};
    return kHeads[static_cast<std::size_t>(kind)];
}

/// The word of a kind in plugin.json.
constexpr std::string_view word_of(PluginPass::Kind kind) {
    constexpr std::array<std::string_view, 3> kWords = {"full", "3d", "compute"};
    return kWords[static_cast<std::size_t>(kind)];
}

/// The type of samplers that read what a pass writes.
constexpr std::string_view sampler_of(PluginPass::Output output) {
    constexpr std::array<std::string_view, 4> kSamplers = {"sampler2D", "sampler3D",
                                                           "samplerBuffer", "usamplerBuffer"};
    return kSamplers[static_cast<std::size_t>(output)];
}

/// Formats of textures, by their names in plugin.json and in GLSL's image layouts.
struct PassFormat {
    PixelFormat format;
    std::string_view word;
};
inline constexpr std::array kPassFormats{
    PassFormat{PixelFormat::RGBA16F, "rgba16f"}, PassFormat{PixelFormat::RGBA32F, "rgba32f"},
    PassFormat{PixelFormat::RG16F, "rg16f"},     PassFormat{PixelFormat::RG32F, "rg32f"},
    PassFormat{PixelFormat::R16F, "r16f"},       PassFormat{PixelFormat::R32F, "r32f"},
    PassFormat{PixelFormat::RGBA8, "rgba8"}};

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

/// Limits that every device of OpenGL 4.5 keeps (tables 23.40, 23.53 and 23.65 of its
/// specification).
inline constexpr int kMaxLocalSide = 1024, kMaxLocalDepth = 64, kMaxLocalInvocations = 1024;
inline constexpr int kMaxWorkGroups = 65535;  // along an axis
inline constexpr int kMaxVolumeSide = 2048;
inline constexpr int kMaxBufferElements = 65536;
inline constexpr int kMaxSharedBytes = 32768;

}  // namespace relevo::shader
