#pragma once

#include <memory>
#include <string>
#include <vector>

#include "effect/selection.h"
#include "scene/scene.h"
#include "session/active_effects.h"
#include "sun/zone.h"
#include "viewer/navigation.h"
#include "viewer/settings.h"

namespace relevo::viewer {

/// What lies on the ground in true colours.
enum class OverlayKind {
    None,
    File,     ///< the scene's
    Day,      ///< sun hours of the shown day
    Week,     ///< likewise from Monday to Sunday
    Year,     ///< likewise
    Mask,     ///< what the sun reaches at the shown moment
    SkyView,  ///< how much of the sky is seen
};

struct OverlayChoice {
    OverlayKind kind = OverlayKind::None;
    double opacity = 1;

    bool operator==(const OverlayChoice&) const = default;
};

/// Everything that a person sets in the viewer, and that undo brings back.
struct Document {
    scene::Scene scene;  ///< DEMs, effects, exposure; place and time are the two below
    Pose pose;
    sun::Instant utc;
    sun::Zone zone;  ///< that dates and times are shown in
    OverlayChoice overlay;

    /// The scene with the camera and the moment, as files and the command line have it.
    /// @param land  of the pose
    scene::Scene whole(const Land& land) const;
};

SavedView saved_view(const Document& document, const Land& land, std::string name);
Pose pose_of(const SavedView& view, const Land& land);

/// What was, step by step.
class History {
  public:
    /// Remembers a state after it was changed; what had been undone is gone.
    void add(const Document& document);
    /// Whether camera or moment are not those of the state at hand.
    bool differs(const Document& document) const;
    bool can_undo() const { return at_ > 0; }
    bool can_redo() const { return at_ + 1 < states_.size(); }
    const Document& undo();  ///< the state before; only where can_undo()
    const Document& redo();  ///< the state after; only where can_redo()

  private:
    std::vector<Document> states_;
    std::size_t at_ = 0;
};

/// The effects there are and what is on, without a device: for panels.
struct EffectsModel : session::InstalledEffects {
    effect::Selection selection;  ///< points into registry

    using InstalledEffects::InstalledEffects;
    /// @param ground  what the DEM has; none: it may have all
    /// @throws Error (BadInput) as those who load and select
    static std::unique_ptr<EffectsModel> of(const scene::Effects& effects,
                                            const effect::GroundWords& ground = {});
};

/// The same with an effect on or off.
scene::Effects switched(scene::Effects effects, const std::string& id, bool on);
/// The same with a value of a parameter in the place of the one before.
scene::Effects with_value(scene::Effects effects, const std::string& address,
                          const std::string& value);
/// The same with what effects themselves say in the place of values that were set.
/// @param of  an effect's id, or the address of one of its parameters
scene::Effects without_values(scene::Effects effects, const std::string& of);

/// The command line that takes a scene's picture, quoted for a POSIX shell.
std::string capture_command(const scene::Scene& scene, const std::string& output);

}  // namespace relevo::viewer
