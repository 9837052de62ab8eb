#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "effect/native_module.h"
#include "gl/context.h"
#include "image/image.h"
#include "render/effect_textures.h"
#include "render/frame_block.h"
#include "render/pass_timers.h"
#include "render/readback.h"
#include "render/shared_resources.h"
#include "render/terrain.h"
#include "shader/param_store.h"

namespace relevo::render {

struct RendererOptions {
    int width_px = 1280;
    int height_px = 1024;
    bool antialias = true;
    /// Keep the linear radiance for read_radiance(). Without it shading ends in the colours of the
    /// picture at once, which saves a pass over it.
    bool radiance = true;
    /// Draw what lies on the ground: Terrain::drape. Not with normals per vertex.
    bool draped = false;
    /// Whether the first frame is expected to be seen from outside the DEM: programs of the other
    /// case are made when it comes.
    bool outside = false;
    /// Keep what the ground's program makes of the sun's light, for read_sun_seen().
    bool audited = false;
    /// What renderers of the context share; null: it has its own.
    SharedResources* shared = nullptr;
    /// Memory of the graph is filled with NaN where a resource begins: a test's.
    bool poison = false;
    /// Called with the programs' texts before a driver sees them, if there is one.
    std::function<void(const StitchedFrames&)> stitched{};
};

/// The enabled effects, as drawing needs them.
struct EffectInputs {
    shader::StitchInput stitch;  ///< its units are the device's, whatever is set
    /// No larger than the device takes (effect::check_limits). Need not outlive the constructor.
    std::vector<const effect::LoadedTexture*> textures;
    std::vector<effect::DisplaceSpec> displaces;
    /// Of native effects; must outlive the renderer.
    std::vector<const effect::NativeModule*> modules;
};

/// Core's own parameters, beside those of plugins: `terrain.normal`, fragment or vertex.
std::vector<shader::Param> core_params();

/// Stitches the programs that a Renderer with these effects and options draws with.
/// @throws Error (BadInput) for a plugin's mistake, in its file and line; (Failed) for core's
StitchedFrames stitch(const EffectInputs& effects, const gl::DeviceInfo& device,
                      const RendererOptions& options);

/// Draws frames with one selection of effects.
///
/// core_passes.h declares the passes of a frame.
class Renderer {
  public:
    /// Stitches and compiles the programs, and loads the textures they read.
    /// @throws Error (BadInput) for a picture that the device cannot draw at once
    /// @throws Error (BadInput) for a plugin's mistake, in its file and line; (Failed) for core's
    Renderer(gl::Context& context, const EffectInputs& effects, const RendererOptions& options);
    ~Renderer();

    /// The texts that were compiled.
    const std::vector<ProgramText>& texts() const;

    /// Draws a frame into the renderer's own target.
    /// @param times  filled with what each pass took if not null, which makes the device wait for
    /// each
    void render_frame(Terrain& terrain, const Ground& ground, const FrameInputs& inputs,
                      PassTimes* times = nullptr);

    /// Height of the ground as a frame of these inputs would draw it on the vertical through the
    /// camera's eye [m]: ellipsoidal, exaggerated. The last frame stays. None where no ground is
    /// drawn.
    std::optional<double> drawn_height_m(Terrain& terrain, const Ground& ground,
                                         const FrameInputs& inputs);

    /// Takes the values of parameters, static ones and those of native modules left out, from the
    /// next frame on.
    void set_values(const shader::ParamStore& values);
    /// Frames have these sides from the next one on.
    /// @throws Error (BadInput) for a picture that the device cannot draw at once
    void resize(int width_px, int height_px);
    /// Begins to link, in the background, the programs that no frame so far has needed: of nights,
    /// and of eyes outside the DEM or within.
    void link_rest();
    /// Gives the memory of its frames to renderers that share it. The last frame is gone; the next
    /// one takes memory again.
    void release_targets();
    /// The last frame on the device, RGBA8, rows from below.
    const gl::Texture& picture() const;
    /// Its depths on the device, Depth32F: distance_m() has metres.
    const gl::Texture& depth() const;

    /// How far the last frame's ground is from the eye, along the direction it looks in [m]: row
    /// after row from below, infinity where there is sky.
    void read_depths(std::vector<float>& depths_m) const;

    /// Of the last frame's pixels that show ground; RendererOptions::audited.
    std::vector<SunSeen> read_sun_seen() const;

    /// Whether what it draws hangs on the climate (lib/climate.glsl).
    bool reads_climate() const;

    /// How far its effects move the ground.
    Displacement displacement() const;
    /// Whether its effects show the DEM as a block where the eye is outside of it.
    bool shows_block() const;
    /// Of all parameters, as the last frame was drawn.
    const shader::ParamStore& values() const;
    int triangles() const;  ///< of terrain in the last frame
    /// Whether some program has not been drawn with yet. Its first draw is under a watch and waits
    /// for the device.
    bool is_watched() const;
    /// The last frame as RGB, rows from the top.
    /// @param not_numbers  filled, if not null, with count_not_numbers()
    image::Image8 read_picture(int* not_numbers = nullptr) const;
    /// The last frame before exposure and tone mapping: linear radiance, RGB.
    image::ImageF read_radiance(int* not_numbers = nullptr) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::render
