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

/// The whole DEM, from its side and from above.
struct Whole {
    Pose home, above;
};

/// What mouse, wheel and held keys do to the camera, the sun and the line of a comparison.
class Hand {
  public:
    /// @param window, state  outlive this
    Hand(Window& window, State& state) : window_(window), state_(state) {}

    /// From now on the ground is looked up in this picture.
    void see(std::shared_ptr<const Picture> picture) { picture_ = std::move(picture); }
    /// Takes what has come since the last call.
    /// @param comparing  there is a line that can be dragged
    /// @param new_input  ImGui has taken clicks in since then
    void act(double passed_s, bool comparing, bool new_input);
    /// Moves that a key or a menu asks for. @returns whether it is one
    /// @param whole  finds the whole DEM; called for moves that show it alone
    bool move(Command command, const std::function<Whole()>& whole);
    /// Lets go, and lets nothing glide on.
    void rest();

    /// Whether something moves that no input is needed for.
    bool is_moving() const { return glides() || keys_held_; }
    /// Whether a drag, a glide or a held key goes on.
    bool is_busy() const { return dragging_ || is_moving(); }
    /// Whether the last act() moved the camera.
    bool has_moved() const { return has_moved_; }
    bool is_walking() const { return walking_; }
    /// Ground that was clicked since the last call.
    std::optional<glm::dvec3> take_click() { return std::exchange(clicked_, std::nullopt); }

    /// The ground of the picture that is shown.
    std::optional<glm::dvec3> ground_at(glm::vec2 at_px) const;

  private:
    enum class Drag { Pan, Orbit, Look, Sun, Line };

    double aspect() const;
    glm::dvec2 in_view(glm::vec2 at_px) const;
    glm::dvec3 hold(glm::vec2 at_px) const;
    double height_above_ground() const;
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
    std::optional<glm::dvec3> clicked_;
    glm::vec2 pressed_px_{0}, last_px_{0};
    glm::dvec3 held_{0}, zoom_at_{0};
    double zoom_left_ = 0;  // natural logarithm of what is still to be zoomed
    glm::dvec2 glide_deg_a_s_{0};
    bool walking_ = false, keys_held_ = false, has_moved_ = false;
};

}  // namespace relevo::viewer
