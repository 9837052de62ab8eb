#pragma once

#include <memory>
#include <string>
#include <vector>

#include "effect/selection.h"
#include "scene/film_job.h"
#include "scene/scene.h"
#include "session/active_effects.h"
#include "sun/zone.h"
#include "viewer/navigation.h"
#include "viewer/settings.h"

namespace relevo::viewer {

/// The raster that colours the ground.
enum class OverlayKind {
    None,
    File,         ///< the scene's
    Hours,        ///< sun hours of a period
    FirstLight,   ///< first direct sun of the displayed day
    LastLight,    ///< last direct sun of the displayed day
    Irradiation,  ///< clear-sky irradiation of a period
    Mask,         ///< sunlit or in shadow at the displayed time
    SkyView,      ///< sky-view factor
};

/// The days of sun hours and of irradiation.
enum class OverlayPeriod {
    Day,   ///< the displayed day
    Week,  ///< from Monday to Sunday
    Year,
    Range,  ///< OverlayChoice::first to last
};

struct OverlayChoice {
    OverlayKind kind = OverlayKind::None;
    OverlayPeriod period = OverlayPeriod::Day;
    sun::Date first{}, last{};  ///< of a Range, both included
    double opacity = 1;
    bool lit = false;      ///< as scene::Overlay
    bool shadows = false;  ///< as scene::Overlay
    bool visible = true;

    /// Whether it shows the sun hours of the displayed day.
    bool shows_day() const {
        return visible && kind == OverlayKind::Hours && period == OverlayPeriod::Day;
    }
    /// Whether it can be of any period.
    bool has_period() const {
        return kind == OverlayKind::Hours || kind == OverlayKind::Irradiation;
    }

    bool operator==(const OverlayChoice&) const = default;
};

/// The choice of a scene's overlay.
OverlayChoice choice_of(const scene::Overlay& overlay);

/// Everything that the user sets and that undo restores.
struct Document {
    scene::Scene scene;  ///< DEMs, effects, exposure; its view and time are not used
    Pose pose;
    sun::Instant utc;
    sun::Zone zone;  ///< of displayed dates and times
    OverlayChoice overlay;

    /// The scene with this pose and time, for files and command lines.
    /// @param land  of the pose
    scene::Scene whole(const Land& land) const;
};

SavedView saved_view(const Document& document, const Land& land, std::string name);
Pose pose_of(const SavedView& view, const Land& land);

/// Installed effects and the selection of active ones, for panels. Needs no device.
struct EffectsModel : session::InstalledEffects {
    effect::Selection selection;  ///< points into registry
    /// Ids of active effects that draw nothing within the DEM, and nothing from outside.
    std::vector<std::string> unseen_within{}, unseen_outside{};

    using InstalledEffects::InstalledEffects;
    /// @param ground  of the DEM; empty: unknown, no effect is excluded
    /// @throws Error (BadInput) if effects cannot be loaded or selected
    static std::unique_ptr<EffectsModel> of(const scene::Effects& effects,
                                            const effect::GroundWords& ground = {});
};

/// A copy with an effect switched on or off.
scene::Effects switched(scene::Effects effects, const std::string& id, bool on);
/// A copy with a parameter set to `value`.
scene::Effects with_value(scene::Effects effects, const std::string& address,
                          const std::string& value);
/// Whether a parameter, or one of an effect, has a value of its own. @param of  as below
bool has_values(const scene::Effects& effects, const std::string& of);
/// A copy with default values.
/// @param of  an effect's id, or the address of one parameter
scene::Effects without_values(scene::Effects effects, const std::string& of);

/// As one word of a POSIX shell.
std::string quoted(const std::string& word);
/// The command line that renders a scene to the file `output`, quoted for a POSIX shell.
std::string capture_command(const scene::Scene& scene, const std::string& output);
/// The command line that writes the ground as a mesh, or as a solid for printing.
std::string mesh_command(scene::Scene scene, const std::string& output, double error_m,
                         bool is_solid);
/// The command line that makes a film which `relevo film` knows: without views.
std::string film_command(const scene::Scene& scene, const scene::FilmJob& film);

}  // namespace relevo::viewer
