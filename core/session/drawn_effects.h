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
#include "session/marks.h"

namespace relevo::session {

/// What effects are selected by.
struct EffectsRequest {
    scene::Effects effects;
    std::vector<std::string> compared{};  ///< effects to compare, as in Options
    effect::GroundWords ground{};         ///< facts about the DEM; empty while it is unknown
    bool overlay_raster = false;          ///< an overlay covers the ground
    /// The overlay shows sunlight of its own time: cast shadows are off unless enabled by id.
    bool hides_shadows = false;
    bool allow_unmet = false;  ///< as in Options
    bool constants = false;    ///< StitchInput::constants
    bool mapped = false;       ///< by a map of land cover
    bool houses = false;       ///< found by heights

    /// True if only parameter values may differ.
    bool has_selection_of(const EffectsRequest& other) const;
    bool operator==(const EffectsRequest&) const = default;
};

/// Loaded effects with their renderer. A comparison has a second selection, drawn in the other
/// half.
class DrawnEffects {
  public:
    using OptionsOf = std::function<render::RendererOptions()>;

    /// Reads plugins, presets and their files. Needs no device.
    /// @param report  logs differences from what was asked for
    /// @throws Error (BadInput) as ActiveEffects, and for an effect that the request names and that
    ///     lacks a requirement, unless `allow_unmet`
    static DrawnEffects load(EffectsRequest request, bool report);

    /// Switches effects by facts about the DEM. Call it before compile().
    void take_ground(const effect::GroundWords& words);
    /// Switches off effects whose textures exceed the device's limits.
    void fit(const gl::DeviceInfo& device);
    /// Reads the files of marks and creates the renderers.
    /// @param earlier  marks of the effects that were drawn before
    /// @throws Error as load_marks() and render::Renderer
    void compile(gl::Context& context, const OptionsOf& options,
                 const std::vector<LoadedMarks>& earlier);

    /// Takes the parameter values of a request if nothing else differs and no file has changed.
    /// @returns true if it now draws that request; else nothing has changed
    /// @throws Error (BadInput) as effect::apply_settings
    bool take(const EffectsRequest& request);
    void resize(int width_px, int height_px);
    void render(render::Terrain& terrain, const render::Ground& ground,
                const render::FrameInputs& inputs, render::PassTimes* times = nullptr);
    /// Whether native modules draw. They may fail at their first frame.
    bool has_modules() const;
    bool has_lines() const;  ///< whether an effect reads a file of lines
    /// As render::Renderer, for both halves.
    bool is_watched() const;
    void release_targets();

    const EffectsRequest& request() const { return request_; }
    const ActiveEffects& effects() const { return *effects_; }
    const ActiveEffects& others() const { return *others_; }
    render::Renderer& renderer() const { return *renderer_; }
    /// Renderer of a comparison's other half, else null.
    render::Renderer* without() const { return without_.get(); }
    /// Marks of effects(), and of others().
    const std::vector<LoadedMarks>& marks() const { return marks_; }
    const std::vector<LoadedMarks>& other_marks() const { return other_marks_; }

  private:
    struct Half {
        ActiveEffects& effects;
        render::Renderer* renderer;
        bool report;
    };
    std::vector<Half> halves() const;
    void stamp_files();

    EffectsRequest request_;
    FileStamps files_;
    std::unique_ptr<ActiveEffects> effects_, others_;
    std::unique_ptr<render::Renderer> renderer_, without_;  // point into these effects
    std::vector<LoadedMarks> marks_, other_marks_;          // the same
};

/// The most recently drawn selections. Toggling an effect twice reads, links and uploads nothing
/// again.
class RecentEffects {
  public:
    /// Removes and returns an entry that can draw a request; nullopt without one.
    std::optional<DrawnEffects> take(const EffectsRequest& request);
    /// Adds effects that are no longer drawn and frees their render targets.
    void keep(DrawnEffects drawn);

  private:
    static constexpr std::size_t kMost = 3;
    std::list<DrawnEffects> kept_;  // most recent first
};

}  // namespace relevo::session
