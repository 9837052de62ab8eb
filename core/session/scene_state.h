#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/frame_block.h"
#include "render/ground.h"
#include "scene/default_time.h"
#include "scene/scene.h"
#include "session/scene_weather.h"
#include "session/session.h"
#include "sun/position.h"
#include "sun/refraction.h"

namespace relevo::session {

/// Drawn shape of the ground, as displaced by effects.
struct DrawnShape {
    render::Displacement displacement;
    bool shows_block = false;  ///< a block below the ground, if the eye is outside of it
    bool has_air = false;      ///< air is drawn before the ground
    /// Height of the drawn ground on the vertical through the camera's eye [m], exaggerated;
    /// nullopt without ground, and for an eye above all of it.
    std::function<std::optional<double>(const scene::Camera&)> height_m;
};

/// A scene with its DEM, and the camera and sun derived from them. Needs no device.
class SceneState {
  public:
    /// @param draws_maps  scenes with Scene::ortho are drawn as maps; else by their view
    SceneState(scene::Scene given, bool draws_maps)
        : scene(std::move(given)), draws_maps_(draws_maps) {}

    /// Sets or replaces the DEM.
    void take_dem(std::shared_ptr<const LoadedDem> dem);
    /// Chooses the exaggeration, if the scene wants that. @param dem  that is or will be drawn
    void choose_exaggeration(const LoadedDem& dem);
    /// Updates exaggeration and exposure from the scene.
    /// @param other  true if the exaggeration or the DEM has changed
    void take_shape(bool other);
    /// Sets the time and recomputes the sun and the stars.
    void set_time(sun::Instant utc);
    /// Default time for the current camera. Sets time_reason().
    sun::Instant default_time();
    /// Sets the camera. Chooses the angles that an orbit leaves open and stores them in the scene.
    /// @throws Error (BadInput) as scene::make_camera
    void look(scene::View view, const DrawnShape& shape);
    /// Warns if the scene's eye is below the drawn ground.
    void warn_of_eye(const DrawnShape& shape) const;

    /// Points that orbits fit into the frame.
    scene::Outline outline(const DrawnShape& shape);
    /// The eye, if the sun is described as seen from there, as in `relevo sun position`. nullopt if
    /// it is described for the DEM's centre: for orbits and for eyes above 100 km.
    std::optional<geo::Geodetic> eye() const;
    /// From the eye to the ground below it, in aerial views to the nearest part of the DEM's box,
    /// as drawn. nullopt for other views, and above voids.
    std::optional<double> nearest_ground_m() const;
    /// Sentences on synthetic detail that effects add and that is visible from the current camera.
    /// @param post_spacing_m  east-west and north-south
    std::vector<std::string> synthetic_detail(const ActiveEffects& effects,
                                              glm::dvec2 post_spacing_m) const;
    /// As in Session.
    std::string place_text() const;
    std::string sun_text() const;
    std::string view_reason() const { return framing_ ? framing_->reason() : std::string(); }
    const std::string& time_reason() const { return time_reason_; }

    const std::shared_ptr<const LoadedDem>& dem() const { return dem_; }
    const render::Ground& ground() const { return *ground_; }
    sun::Instant utc() const { return utc_; }
    /// The DEM's centre at its middle height.
    geo::Geodetic middle() const;

    bool is_map() const { return draws_maps_ && scene.ortho; }

    /// Of the scene at a place, for the model of the scene and its weather.
    sun::Refraction refraction(const geo::Geodetic& place) const;

    scene::Scene scene;
    std::optional<SceneWeather> weather;  ///< of the scene; set_time() applies its air
    render::FrameInputs inputs;           ///< of the next frame
    /// Least height above the drawn ground for eyes with an absolute height [m]; nullopt:
    /// unconstrained.
    std::optional<double> keep_above_m;

  private:
    /// Inputs of an integrated refraction.
    struct Air {
        std::string model;
        geo::Geodetic place;
        std::optional<weather::StationAir> measured;
        bool operator==(const Air&) const = default;
    };
    struct MovedPoints {
        render::Displacement by;
        std::vector<glm::dvec3> points;
    };
    /// Points of the ground as displaced by effects; the same for every camera.
    const std::vector<glm::dvec3>& moved_points(const render::Displacement& displacement);

    bool draws_maps_;
    std::shared_ptr<const LoadedDem> dem_;
    std::optional<render::Ground> ground_;
    sun::Instant utc_;
    sun::Position position_;
    std::optional<Air> air_of_;
    sun::Refraction air_ = sun::Refraction::none();
    render::GroundToShow to_show_;
    std::optional<MovedPoints> moved_;  // from to_show_
    std::optional<scene::DefaultDay> day_;
    std::optional<scene::Framing> framing_;  // of the last view with an open angle
    std::string time_reason_;
};

}  // namespace relevo::session
