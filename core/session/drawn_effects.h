#pragma once

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file_stamps.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "session/active_effects.h"

namespace relevo::session {

/// What a selection of effects is made for.
struct EffectsRequest {
    scene::Effects effects;
    std::vector<std::string> compared{};  ///< as Options
    effect::GroundWords ground{};         ///< of the DEM; none while it is not known
    bool draped = false;                  ///< an overlay lies on the ground
    /// The overlay shows the sun's light of a time of its own: cast shadows are off unless asked
    /// for.
    bool overlay_has_time = false;

    /// Whether it is the same but for values of parameters.
    bool has_selection_of(const EffectsRequest& other) const;
    bool operator==(const EffectsRequest& other) const;
};

/// Effects that have been read, with the renderer that draws them. Of a comparison, the effects of
/// its other half as well.
class DrawnEffects {
  public:
    using OptionsOf = std::function<render::RendererOptions()>;

    /// Reads plugins, presets and their files. No device is needed.
    /// @param aloud  logs what differs from what was asked for
    /// @throws Error (BadInput) as ActiveEffects
    static DrawnEffects load(EffectsRequest request, bool aloud);

    /// Switches effects by what the DEM has, before compile().
    void take_ground(const effect::GroundWords& words);
    /// Switches off what brings textures larger than the device takes.
    void fit(const gl::DeviceInfo& device);
    /// Makes the renderers. @throws Error as render::Renderer
    void compile(gl::Context& context, const OptionsOf& options);

    /// Takes other values of parameters if that is all in which a request differs and no file has
    /// changed since.
    /// @returns whether it draws that request now; else nothing has changed
    /// @throws Error (BadInput) as effect::apply_settings
    bool take(const EffectsRequest& request);
    /// Sets one parameter. @throws Error (BadInput) for a static one, and as shader::ParamStore
    void set(const std::string& address, const std::string& value);
    void resize(int width_px, int height_px);
    void render(render::Terrain& terrain, const render::Ground& ground,
                const render::FrameInputs& inputs, render::PassTimes* times = nullptr);
    /// Whether native modules draw, which may be refused at their first frame.
    bool has_modules() const;
    /// As render::Renderer, of both halves.
    bool is_watched() const;
    void release_targets();

    const EffectsRequest& request() const { return request_; }
    const ActiveEffects& effects() const { return *effects_; }
    const ActiveEffects& others() const { return *others_; }
    render::Renderer& renderer() const { return *renderer_; }
    /// Of a comparison's other half; else null.
    render::Renderer* without() const { return without_.get(); }

  private:
    struct Half {
        ActiveEffects& effects;
        render::Renderer* renderer;
        bool aloud;
    };
    std::vector<Half> halves() const;
    void stamp_files();

    EffectsRequest request_;
    FileStamps files_;
    std::unique_ptr<ActiveEffects> effects_, others_;
    std::unique_ptr<render::Renderer> renderer_, without_;  // refer to these
};

/// Selections that were drawn last, so that an effect which is toggled there and back needs nothing
/// read, stitched, linked or uploaded again.
class RecentEffects {
  public:
    /// Removes and returns one that draws a request now, if there is one.
    std::optional<DrawnEffects> take(const EffectsRequest& request);
    /// Keeps one that is not drawn any more, without the memory of its frames.
    void keep(DrawnEffects drawn);

  private:
    static constexpr std::size_t kMost = 3;
    std::list<DrawnEffects> kept_;  // the last one first
};

}  // namespace relevo::session
