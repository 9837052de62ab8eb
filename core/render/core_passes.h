#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/graph/graph.h"
#include "shader/stitch.h"

namespace relevo::render {

/// A capability word that core provides, to the background alone and while it is night: what is
/// only in a night's sky then is in a program of its own, and costs a day nothing.
inline constexpr const char* kNightWord = "night";

/// A capability word that core provides to the ground's programs while it is seen from outside as a
/// block: what is only within, such as air, costs a frame from outside nothing.
inline constexpr const char* kOutsideWord = "outside";

/// The stored steps of the height, from the geometry to the terrain program: their sampler, and the
/// define that has the number of their output. There where a hook reads them.
inline constexpr const char* kHeightStepsTexture = "height_steps";
inline constexpr const char* kHeightStepsDefine = "HEIGHT_STEPS";

/// The define that has the number of the output that audits read.
inline constexpr const char* kAuditedDefine = "AUDITED";

/// What decides which passes and programs a frame has.
struct FrameFacts {
    bool outside = false;         ///< the DEM is seen from outside, as a block
    bool wants_outside = false;   ///< effects want the word `outside`
    bool wants_night = false;     ///< effects want the word `night`
    bool radiance = false;        ///< linear radiance is stored; else shading ends in colours
    bool antialias = true;        ///< silhouettes are smoothed
    bool pixel_hooks = false;     ///< effects have hooks for all pixels: image, finish or overlay
    bool overlays = false;        ///< effects or a raster draw over the tone-mapped ground
    bool draped = false;          ///< a raster lies on the ground: Terrain::drape
    bool audited = false;         ///< the terrain pass also writes what SunSeen has
    bool vertex_normals = false;  ///< per vertex instead of per fragment
    bool displaced = false;       ///< effects move the ground
    bool software = false;        ///< as ProgramOptions
    bool height_steps = false;    ///< hooks read height_dx_m or height_dy_m
    int varying_targets = 0;      ///< layers of stored varyings: shader::Stitched
    std::vector<std::string> natives{};  ///< ids of native effects, in their order
};

/// A program of core's before it is stitched.
struct ProgramRecipe {
    std::string name;
    shader::ProgramRecipe recipe;
    std::string word{};  ///< a capability that it has beside those of the effects; empty: none
};

/// The passes of a frame, what they read and write, and their programs.
struct CoreFrame {
    FrameGraph graph;
    std::vector<ProgramRecipe> programs;
};

/// Declares core's passes: the one place to add one. A full-screen pass needs a Pass, its Resource
/// and a ProgramRecipe; GLSL goes into shaders/.
CoreFrame core_frame(const FrameFacts& facts);

}  // namespace relevo::render
