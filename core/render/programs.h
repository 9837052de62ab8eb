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

/// One of the programs of a frame as text.
struct ProgramText {
    std::string name;  ///< as core_frame() has it: "terrain", "background_night"
    shader::Stitched stitched;
    std::string hash;  ///< SHA-256 of the text of both stages

    static ProgramText of(std::string name, shader::Stitched stitched);
};

struct ProgramOptions {
    bool vertex_normals = false;  ///< per vertex instead of per fragment
    bool draped = false;          ///< colours lie on the ground: Terrain::drape
    /// Shading ends in the colours of the frame, without a stored radiance and the program "post".
    bool shown = false;
    bool antialias = true;
    /// The ground's programs also write what audits read: SunSeen of renderer.h.
    bool audited = false;
    /// The device is a software renderer: its near plane cuts triangles to slivers whose heights
    /// are NaN, and the weights of its filters are exact (shaders/lib/filtered.glsl).
    bool software = false;
    /// Ids of native effects; with any there is "depth": the terrain as an orthographic view has
    /// it.
    std::vector<std::string> natives{};
};

/// Elevation of the sun, seen from the eye, below which it is night [deg].
inline constexpr double kNight_deg = -3;

/// Whether any of the effects shows the DEM as a block where it is seen from outside.
bool shows_block(const shader::StitchInput& input);

/// What frames are drawn by: every program, and the graph for each place of the eye.
struct StitchedFrames {
    std::vector<ProgramText> programs;
    FrameGraph within;                  ///< the eye is over the ground
    std::optional<FrameGraph> outside;  ///< where effects show the DEM as a block from there

    /// Null where there is none.
    const ProgramText* find(std::string_view program) const;
};

/// Stitches all programs of a frame. The passes read what their programs have samplers for; what is
/// no resource of core's is provided, by native passes where it bears their id.
/// @throws Error as shader::stitch
StitchedFrames stitch_frames(const shader::CoreTexts& core, const shader::StitchInput& input,
                             const ProgramOptions& options);

/// The graph of frames over the ground, and of those from outside if there are any, in Graphviz's
/// language.
std::string graph_text(const StitchedFrames& frames);

/// Writes every text as `<name>.vert.glsl` and `<name>.frag.glsl`, and the graph as `frame.dot`.
/// @throws Error (BadInput) for the folder of the program's own shaders, and as write_text
void dump_programs(const StitchedFrames& frames, const std::filesystem::path& folder,
                   bool overwrite);

/// Compiles and links. @throws Error (Failed) with what the driver says, in the author's file and
/// line
gl::Program link_program(const ProgramText& text);
/// The same in two steps: the driver may compile several programs at once.
gl::Program::Pending begin_program(const ProgramText& text);
gl::Program finish_program(gl::Program::Pending pending, const ProgramText& text);

}  // namespace relevo::render
