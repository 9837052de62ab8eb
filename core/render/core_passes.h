#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/graph/graph.h"
#include "shader/stitch.h"

namespace relevo::render {

/// Capability word of core for the background at night. Code for the night sky is compiled into a
/// separate program and adds no cost by day.
inline constexpr const char* kNightWord = "night";

/// Capability word of core for the ground of a block seen from outside. Code for views from within,
/// such as air, adds no cost to these frames.
inline constexpr const char* kOutsideWord = "outside";

/// Capability words of core for the ground: 0 in the program of parts of the picture where no
/// ground has water, and no pixel is narrower on it than kNearPixel_m; else 1.
inline constexpr const char* kWaterWord = "water";
inline constexpr const char* kNearWord = "near";

/// Height differences between neighbouring pixels, from the geometry to the terrain program: the
/// sampler, and the define with the number of the output. Present if a hook reads them.
inline constexpr const char* kHeightStepsTexture = "height_steps";
inline constexpr const char* kHeightStepsDefine = "HEIGHT_STEPS";

/// Of a map, whose rays do not tell where ground is: the position of each pixel's ground, from the
/// geometry to the terrain program, and the define with the number of the output.
inline constexpr const char* kGroundPlaceTexture = "ground_place";
inline constexpr const char* kOrthographicDefine = "ORTHOGRAPHIC";

/// What passes of plugins read of the shaded ground, and the define with the number of the output.
/// Present if a plugin reads it.
inline constexpr const char* kSurfaceTexture = "surface";
inline constexpr const char* kSurfaceDefine = "SURFACE_OUTPUT";

/// The diffuse colour of the shaded ground, and the define with the number of the output.
inline constexpr const char* kAlbedoTexture = "albedo";
inline constexpr const char* kAlbedoDefine = "ALBEDO_OUTPUT";

/// Define with the number of the output for audits.
inline constexpr const char* kAuditedDefine = "AUDITED";

/// Determines the passes and programs of a frame.
struct FrameFacts {
    bool outside = false;                ///< the DEM is seen from outside, as a block
    bool wants_outside = false;          ///< effects want the word `outside`
    bool wants_night = false;            ///< effects want the word `night`
    bool beyond = false;                 ///< effects have the hook `beyond`
    bool wants_plain = false;            ///< effects want the words `water` or `near`
    bool radiance = false;               ///< stores linear radiance; else shading writes colours
    bool antialias = true;               ///< smooths silhouettes
    bool pixel_hooks = false;            ///< effects have the hook image, finish or overlay
    bool overlays = false;               ///< effects or a raster draw over the tone-mapped ground
    bool overlay_raster = false;         ///< the ground has an overlay: Terrain::set_overlay
    bool surface = false;                ///< plugins read core.normal or core.shadow
    bool deep = false;                   ///< display-referred colours have 16 bits, not 8
    bool data = false;                   ///< keeps what read_normals() and the like read
    bool albedo = false;                 ///< keeps the diffuse colour of the ground
    bool audited = false;                ///< the terrain pass also writes the data of SunSeen
    bool vertex_normals = false;         ///< computed per vertex, not per fragment
    bool displaced = false;              ///< effects displace the ground
    bool software = false;               ///< the device is a software renderer
    bool height_steps = false;           ///< hooks read what is stored for contours
    bool orthographic = false;           ///< frames are of Camera::map
    int varying_targets = 0;             ///< layers of stored varyings (shader::Stitched)
    std::vector<std::string> natives{};  ///< ids of native effects, in their order
    std::vector<shader::PluginPass> plugin_passes{};
    std::vector<shader::InstanceSet> instances{};
};

/// A program of core before stitching.
struct ProgramRecipe {
    std::string name;
    shader::ProgramRecipe recipe;
    std::string word{};  ///< capability word in addition to those of the effects; empty: none
    bool plain = false;  ///< without the words of the ground that is seen near or has water
};

/// The passes of a frame with their resources, and their programs.
struct CoreFrame {
    FrameGraph graph;
    std::vector<ProgramRecipe> programs;
};

/// Declares all passes of core; new ones are added here. A full-screen pass needs a Pass, its
/// Resource, a ProgramRecipe, and its GLSL in shaders/.
CoreFrame core_frame(const FrameFacts& facts);

}  // namespace relevo::render
