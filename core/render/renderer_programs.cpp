#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "render/programs.h"
#include "render/renderer.h"

namespace relevo::render {
namespace {

/// "render: terrain: 13 of 16 texture units; bump.rock also serves as layering.rock"
std::string units_text(const ProgramText& program, int max_texture_units) {
    std::string text = fmt::format("render: {}: {} of {} texture units", program.name,
                                   program.stitched.textures.size(), max_texture_units);
    for (const shader::TextureUnit& unit : program.stitched.textures)
        if (!unit.also.empty())
            text +=
                fmt::format("; {} also serves as {}", unit.resource, fmt::join(unit.also, ", "));
    return text;
}

}  // namespace

StitchedFrames stitch(const EffectInputs& effects, const gl::DeviceInfo& info,
                      const RendererOptions& options) {
    shader::StitchInput input = effects.stitch;
    input.max_texture_units = info.max_texture_units;
    const shader::FolderTexts core(share_dir() / "shaders");
    const bool vertex_normals = input.values && input.values->find(kNormalAddress) &&
                                input.values->value(kNormalAddress)[0] == 1;
    if (vertex_normals && options.overlay_raster)
        bad_input(
            fmt::format("render: {}: vertex shows no overlay; remove the overlay or pass "
                        "--set {}=fragment",
                        kNormalAddress, kNormalAddress));
    ProgramOptions wanted{.vertex_normals = vertex_normals,
                          .overlay_raster = options.overlay_raster,
                          .shown = !options.radiance,
                          .antialias = options.antialias,
                          .deep = options.deep,
                          .data = options.data,
                          .albedo = options.albedo,
                          .audited = options.audited,
                          .orthographic = options.orthographic,
                          .software = info.device.software};
    for (const effect::NativeModule* const module : effects.modules)
        wanted.natives.push_back(module->id());
    StitchedFrames frames = stitch_frames(core, input, wanted);
    if (options.stitched) options.stitched(frames);
    for (const ProgramText& text : frames.programs)
        log::debug(units_text(text, info.max_texture_units));
    return frames;
}

}  // namespace relevo::render
