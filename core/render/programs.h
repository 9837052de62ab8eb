#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gl/program.h"
#include "render/core_passes.h"
#include "shader/stitch.h"

namespace relevo::render {

/// Source of one of a frame's programs.
struct ProgramText {
    std::string name;  ///< as in core_frame(): "terrain", "background_night"
    shader::Stitched stitched;
    std::string hash;  ///< SHA-256 of the sources of its stages

    static ProgramText of(std::string name, shader::Stitched stitched);
};

/// Address of core's parameter in core_params() of renderer.h.
inline constexpr const char* kNormalAddress = "terrain.normal";

struct ProgramOptions {
    bool vertex_normals = false;  ///< per vertex instead of per fragment
    bool overlay_raster = false;  ///< with an overlay: Terrain::set_overlay
    /// Shading writes display-referred colours directly, without a radiance target and the program
    /// "post".
    bool shown = false;
    bool antialias = true;
    bool deep = false;    ///< display-referred colours have 16 bits
    bool data = false;    ///< keeps the data of PixelData of readback.h
    bool albedo = false;  ///< and its albedo
    /// Terrain programs also write what audits read: SunSeen of readback.h.
    bool audited = false;
    bool orthographic = false;  ///< frames are of Camera::map
    /// For software renderers: slivers clipped at the near plane have heights of NaN, and filters
    /// have exact weights (shaders/lib/filtered.glsl).
    bool software = false;
    /// Ids of native effects. If there are any, the program "depth" draws the terrain's depth in
    /// orthographic views.
    std::vector<std::string> natives{};
};

/// The eye's night programs are used below this solar elevation [deg].
inline constexpr double kNight_deg = -3;

/// True if an effect draws the DEM as a block when seen from outside.
bool shows_block(const shader::StitchInput& input);

/// Programs of frames, and a frame graph for each side of the eye.
struct StitchedFrames {
    std::vector<ProgramText> programs;
    FrameGraph within;                  ///< for eyes over the ground
    std::optional<FrameGraph> outside;  ///< for eyes outside, if effects draw the DEM as a block

    /// Null if there is none of that name.
    const ProgramText* find(std::string_view program) const;
};

/// Stitches all programs of a frame. Passes read the samplers of their programs. Resources that
/// core does not define are provided externally, or by the native pass whose id they start with.
/// @throws Error as shader::stitch
StitchedFrames stitch_frames(const shader::CoreTexts& core, const shader::StitchInput& input,
                             const ProgramOptions& options);

/// The frame graphs in Graphviz's DOT language.
std::string graph_text(const StitchedFrames& frames);

/// Writes the sources as `<name>.vert.glsl` and `<name>.frag.glsl` or `<name>.comp.glsl`, and the
/// graphs as `frame.dot`.
/// @throws Error (BadInput) for Relevo's own shader folder, and as write_text
void dump_programs(const StitchedFrames& frames, const std::filesystem::path& folder,
                   bool overwrite);

/// Compiles and links. @throws Error (Failed) with the driver's log, in terms of the author's file
/// and line
gl::Program link_program(const ProgramText& text);
/// link_program() in two steps: several programs may compile concurrently.
gl::Program::Pending begin_program(const ProgramText& text);
gl::Program finish_program(gl::Program::Pending pending, const ProgramText& text);

}  // namespace relevo::render
