#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/command.h"
#include "viewer/state.h"
#include "viewer/window.h"

namespace relevo::viewer {

/// A click on the picture.
struct Click {
    std::optional<glm::dvec3> point_m;  ///< none: there is no ground
    bool asks_for_menu = false;         ///< by the right button
};

/// Home view of the whole DEM, and from above.
struct Whole {
    Pose home, above;
    double in_view = 0;  ///< fraction of the DEM's ground within the current picture, 0 to 1
};

/// Moves the camera, the sun and a comparison's dividing line by mouse, wheel and held keys.
class Hand {
  public:
    /// @param window, state  outlive this
    Hand(Window& window, State& state) : window_(window), state_(state) {}

    /// Sets the displayed image, whose depths give the ground under the mouse; null: none.
    void see(std::shared_ptr<const Picture> picture) { picture_ = std::move(picture); }
    /// Processes the input since the last call.
    /// @param comparing  there is a dividing line to drag
    /// @param new_input  ImGui has processed mouse events since the last call
    void act(double passed_s, bool comparing, bool new_input);
    /// Carries out a command that moves the camera. @returns false: `command` is another one, or
    /// there is no ground to walk on
    /// @param whole  called only for commands that show the whole DEM
    bool move(Command command, const std::function<Whole()>& whole);
    /// Ends drags, glides and walking.
    void rest();

    /// Whether the camera moves without new input.
    bool is_moving() const { return glides() || keys_held_; }
    /// True while a drag, a glide or a held key continues.
    bool is_busy() const { return dragging_ || is_moving(); }
    /// Whether the last act() moved the camera.
    bool has_moved() const { return has_moved_; }
    bool is_walking() const { return walking_; }
    /// Stands on the ground at a point, and walks from there. @returns false: there is none
    bool stand_at(const glm::dvec3& point_m);
    std::optional<Click> take_click() { return std::exchange(clicked_, std::nullopt); }

    /// The ground at a place of the displayed image.
    std::optional<glm::dvec3> ground_at(glm::vec2 at_px) const;

  private:
    enum class Drag { Pan, Orbit, Look, Sun, Line };

    double aspect() const;
    glm::dvec2 in_view(glm::vec2 at_px) const;
    glm::dvec3 hold(glm::vec2 at_px) const;
    double height_above_ground() const;
    std::optional<glm::dvec3> start_of_walk();
    bool walk_or_fly();
    void stop_gliding();
    bool glides() const;
    void press(glm::vec2 mouse, bool comparing);
    void scroll(glm::vec2 mouse);
    void drag(glm::vec2 mouse, double passed_s);
    void drag_sun(glm::vec2 mouse);
    void glide(double passed_s);
    void fly_by_keys(double passed_s);
    void hover(glm::vec2 mouse);
    double drawn_height_m(const glm::dvec3& point_m) const;
    void slope_at(Cursor& cursor) const;

    Window& window_;
    State& state_;
    std::shared_ptr<const Picture> picture_;
    std::optional<Drag> dragging_;
    std::optional<Click> clicked_;
    std::optional<geo::Geodetic> walked_from_;  // the chosen point at which the last walk began
    glm::vec2 pressed_px_{0}, last_px_{0};
    glm::dvec3 held_{0}, zoom_at_{0};
    double zoom_left_ = 0;  // natural logarithm of the remaining zoom factor
    glm::dvec2 glide_deg_a_s_{0};
    bool walking_ = false, keys_held_ = false, has_moved_ = false;
};

}  // namespace relevo::viewer
