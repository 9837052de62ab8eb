#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "effect/module_marks.h"
#include "effect/native_module.h"
#include "gl/context.h"
#include "image/image.h"
#include "render/effect_textures.h"
#include "render/frame_block.h"
#include "render/line_textures.h"
#include "render/pass_timers.h"
#include "render/readback.h"
#include "render/shared_resources.h"
#include "render/terrain.h"
#include "shader/param_store.h"

namespace relevo::render {

struct RendererOptions {
    int width_px = 1280;
    int height_px = 720;
    bool antialias = true;
    /// Stores linear radiance for read_radiance(). Otherwise shading writes display-referred
    /// colours directly, which saves a pass.
    bool radiance = true;
    /// Display-referred colours have 16 bits for read_output16(), not 8.
    bool deep = false;
    /// Frames are of Camera::map; else none is.
    bool orthographic = false;
    /// Stores the data for read_data().
    bool data = false;
    /// The same with PixelData::albedo.
    bool albedo = false;
    /// Draws an overlay: Terrain::set_overlay. Not with normals per vertex.
    bool overlay_raster = false;
    /// Whether the first frame is probably seen from outside the DEM. Programs of the other graph
    /// are linked when needed.
    bool outside = false;
    /// Stores the data for read_sun_seen().
    bool audited = false;
    /// Shared by renderers of the context; null: not shared.
    SharedResources* shared = nullptr;
    /// Fills targets with NaN before their first use, for tests.
    bool poison = false;
    /// Called with the sources before they are compiled.
    std::function<void(const StitchedFrames&)> stitched{};
};

/// The enabled effects.
struct EffectInputs {
    shader::StitchInput stitch;  ///< without its limit of texture units, which is the device's
    /// Within the device's limits (effect::check_limits). Need not outlive the constructor.
    std::vector<const effect::LoadedTexture*> textures;
    std::vector<LineSource> lines{};  ///< textures of kind `lines`
    std::vector<effect::DisplaceSpec> displaces;
    /// Of native effects; must outlive the renderer.
    std::vector<const effect::NativeModule*> modules;
};

/// Parameters of core: `terrain.normal`, fragment or vertex.
std::vector<shader::Param> core_params();

/// Stitches the programs of a Renderer with these effects and options.
/// @throws Error (BadInput) for a mistake in a plugin, with file and line; (Failed) for one in core
StitchedFrames stitch(const EffectInputs& effects, const gl::DeviceInfo& device,
                      const RendererOptions& options);

/// Draws frames with one selection of effects.
///
/// core_passes.h declares the passes of a frame.
class Renderer {
  public:
    /// Stitches and links the programs, and uploads textures.
    /// @throws Error (BadInput) for a frame size above the device's limit
    /// @throws Error (BadInput) for a mistake in a plugin, with file and line; (Failed) for one in
    ///     core
    Renderer(gl::Context& context, const EffectInputs& effects, const RendererOptions& options);
    ~Renderer();

    /// The sources that were compiled.
    const std::vector<ProgramText>& texts() const;

    /// Draws a frame into the renderer's own targets.
    /// @param times  if not null, receives the duration of each pass; software renderers then wait
    ///     after each
    void render_frame(Terrain& terrain, const Ground& ground, const FrameInputs& inputs,
                      PassTimes* times = nullptr);

    /// Height of the drawn ground on the vertical through the camera's eye [m], ellipsoidal and
    /// exaggerated. Does not change the last frame. nullopt without ground.
    std::optional<double> drawn_height_m(Terrain& terrain, const Ground& ground,
                                         const FrameInputs& inputs);

    /// Sets parameters for subsequent frames, except static ones and those of native modules.
    void set_values(const shader::ParamStore& values);
    /// Sets the size of subsequent frames.
    /// @throws Error (BadInput) above the device's limit
    void resize(int width_px, int height_px);
    /// Links programs that no frame has needed yet in the background: for night, and for the other
    /// side of the DEM's outline.
    void link_rest();
    /// Frees targets for renderers that share them. Discards the last frame; the next one allocates
    /// targets again.
    void release_targets();
    /// The last frame on the device: RGBA8, rows from the bottom.
    const gl::Texture& output() const;
    /// Depth of the last frame on the device: Depth32F, converted to metres by distance_m().
    const gl::Texture& depth() const;

    /// Depths of the last frame along the optical axis [m]: rows from the bottom, infinite in the
    /// sky.
    void read_depths(std::vector<float>& depths_m) const;

    /// Of the last frame's pixels with ground. Requires RendererOptions::audited.
    std::vector<SunSeen> read_sun_seen() const;

    /// True if frames depend on FrameInputs::seconds.
    bool is_animated() const;
    /// True if frames depend on climate (lib/climate.glsl).
    bool reads_climate() const;

    /// Marks that a native module has set for a list of its plugin's; null without any.
    std::shared_ptr<const effect::ModuleMarks> module_marks(const std::string& id,
                                                            const std::string& list) const;

    /// Bounds of displacement by its effects.
    Displacement displacement() const;
    /// True if its effects draw the DEM as a block when the eye is outside.
    bool shows_block() const;
    /// All parameters as of the last frame.
    const shader::ParamStore& values() const;
    int triangles() const;  ///< of terrain in the last frame
    /// True if some program has not been drawn with yet. Its first draw is watched and waits for
    /// the device.
    bool is_watched() const;
    /// The last frame as RGB, rows from the top.
    /// @param non_finite  if not null, receives count_non_finite()
    image::Image8 read_output(int* non_finite = nullptr) const;
    /// The same with 16 bits. Requires RendererOptions::deep.
    image::Image16 read_output16(int* non_finite = nullptr) const;
    /// What the last frame's pixels show. Requires RendererOptions::data.
    PixelData read_data() const;
    /// Pixels of the last frame that are NaN or infinite.
    NonFinite non_finite() const;
    /// Factor on the last frame's radiance before tone mapping.
    double exposure() const;
    /// The last frame as linear radiance before exposure and tone mapping: RGB, rows from the top.
    image::ImageF read_radiance(int* non_finite = nullptr) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
