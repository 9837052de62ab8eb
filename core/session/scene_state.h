#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/frame_block.h"
#include "render/ground.h"
#include "scene/moment.h"
#include "scene/scene.h"
#include "session/session.h"
#include "sun/position.h"
#include "sun/refraction.h"

namespace relevo::session {

/// The ground as the effects that are on draw it.
struct DrawnShape {
    render::Displacement displacement;
    bool shows_block = false;  ///< a block below the ground where the eye is outside of it
    /// Height of the drawn ground below a camera's eye [m], exaggerated; none where the eye is
    /// above all ground.
    std::function<std::optional<double>(const scene::Camera&)> height_m;
};

/// A scene with its DEM, and the camera and the sun that follow from them. No device is needed.
class SceneState {
  public:
    explicit SceneState(scene::Scene given) : scene(std::move(given)) {}

    /// Takes a DEM, for the first time or in place of another one.
    void take_dem(std::shared_ptr<const LoadedDem> dem);
    /// Takes exaggeration and exposure from the scene.
    /// @param other  the exaggeration or the ground has changed
    void take_shape(bool other);
    /// Moves the sun.
    void set_time(sun::Instant utc);
    /// The time of a scene that gives none, for its camera. Sets time_reason().
    sun::Instant default_time();
    /// Moves the camera. Angles that an orbit leaves open are chosen and written to the scene.
    /// @throws Error (BadInput) as scene::make_camera
    void look(scene::View view, const DrawnShape& shape);
    /// Warns where the scene's eye is below the drawn ground.
    void warn_of_eye(const DrawnShape& shape) const;

    /// What orbits fit into the picture.
    scene::Outline outline(const DrawnShape& shape);
    /// The eye if the sun is described as seen from there, as `relevo sun position` has it. None
    /// where it is described for the DEM's centre: of orbits, and of eyes very high up.
    std::optional<geo::Geodetic> eye() const;
    /// Detail that effects add to the DEM and that the camera is near enough to show: sentences.
    std::vector<std::string> synthetic_detail(const ActiveEffects& effects,
                                              glm::dvec2 post_spacing_m) const;
    /// As Session.
    std::string place_text() const;
    std::string sun_text() const;
    std::string view_reason() const { return framing_ ? framing_->reason() : std::string(); }
    const std::string& time_reason() const { return time_reason_; }

    const std::shared_ptr<const LoadedDem>& dem() const { return dem_; }
    const render::Ground& ground() const { return *ground_; }
    sun::Instant utc() const { return utc_; }
    /// The middle of the DEM's ground, at the middle of its heights.
    geo::Geodetic middle() const;

    scene::Scene scene;
    render::FrameInputs inputs;  ///< of the next frame
    /// Eyes with a height of their own are raised so far above the drawn ground [m]; none: not.
    std::optional<double> keep_above_m;

  private:
    /// Refraction that was integrated for a model and a place.
    struct Air {
        std::string model;
        geo::Geodetic place;
        bool operator==(const Air&) const = default;
    };
    struct MovedPoints {
        render::Displacement by;
        std::vector<glm::dvec3> points;
    };
    /// The ground's points where effects move them: the same for every camera.
    const std::vector<glm::dvec3>& moved_points(const render::Displacement& displacement);

    std::shared_ptr<const LoadedDem> dem_;
    std::optional<render::Ground> ground_;
    sun::Instant utc_;
    sun::Position position_;
    std::optional<Air> air_of_;
    sun::Refraction air_ = sun::Refraction::none();
    render::GroundToShow to_show_;
    std::optional<MovedPoints> moved_;  // of to_show_
    std::optional<scene::DefaultDay> day_;
    std::optional<scene::Framing> framing_;  // of the last view that left an angle open
    std::string time_reason_;
};

}  // namespace relevo::session
