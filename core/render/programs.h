#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gl/program.h"
#include "shader/stitch.h"

namespace relevo::render {

/// One of the programs of a frame as text.
struct ProgramText {
    /// "geometry", "terrain", "background", "background_night" (if an effect wants `night`), "post"
    /// (not if shown), "edges", "antialias"; where effects show the DEM from outside as a block:
    /// "side", "backdrop", and if an effect wants `outside` "geometry_outside", "terrain_outside"
    std::string name;
    shader::Stitched stitched;
};

struct ProgramOptions {
    bool vertex_normals = false;  ///< per vertex instead of per fragment
    bool depth = false;           ///< also "depth": the terrain as an orthographic view sees it
    bool draped = false;          ///< colours lie on the ground: Terrain::drape
    /// Shading ends in the colours of the picture, without a stored radiance and the program
    /// "post".
    bool shown = false;
    /// The ground's programs also write what audits read: SunSeen of renderer.h.
    bool audited = false;
};

/// A capability word that core provides, to the background alone and while it is night: what is
/// only in a night's sky then is in a program of its own, and costs a day nothing.
inline constexpr const char* kNightWord = "night";
/// Elevation of the sun, seen from the eye, below which it is night [deg].
inline constexpr double kNight_deg = -3;

/// A capability word that core provides to the ground's programs while it is seen from outside as a
/// block: what is only within, such as air, costs a picture from outside nothing.
inline constexpr const char* kOutsideWord = "outside";
/// Of the names of the programs that have it.
inline constexpr const char* kOutsideEnding = "_outside";

/// The stored steps of the height, from the geometry to the terrain program: their sampler, and the
/// define that has the number of their output. There where a hook reads them.
inline constexpr const char* kHeightStepsTexture = "height_steps";
inline constexpr const char* kHeightStepsDefine = "HEIGHT_STEPS";

/// The define that has the number of the output that audits read.
inline constexpr const char* kAuditedDefine = "AUDITED";

/// Whether anything is drawn over the finished picture: by effects, or what is draped.
bool has_overlay(const shader::StitchInput& input, bool draped);

/// Whether any of the effects shows the DEM as a block where it is seen from outside.
bool shows_block(const shader::StitchInput& input);

/// Stitches all programs of a frame. @throws Error as shader::stitch
std::vector<ProgramText> stitch_programs(const shader::CoreTexts& core,
                                         const shader::StitchInput& input,
                                         const ProgramOptions& options);

/// Writes every text as `<name>.vert.glsl` and `<name>.frag.glsl`.
/// @throws Error (BadInput) for the folder of the program's own shaders, and as write_text
void dump_programs(const std::vector<ProgramText>& programs, const std::filesystem::path& folder,
                   bool overwrite);

struct LinkedProgram {
    gl::Program program;
    std::vector<shader::TextureUnit> textures;
};

/// Compiles and links. @throws Error (Failed) with what the driver says, in the author's file and
/// line
LinkedProgram link_program(const ProgramText& text);

}  // namespace relevo::render
