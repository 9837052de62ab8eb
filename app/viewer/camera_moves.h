#pragma once

#include <cstddef>
#include <optional>

#include "viewer/file_place.h"
#include "viewer/find_sheet.h"
#include "viewer/parts.h"
#include "viewer/sun_over.h"

namespace relevo::viewer {

/// Views and times that commands go to: the whole DEM, places, saved views, the moon. Changes the
/// document's pose and time.
class CameraMoves {
  public:
    explicit CameraMoves(const Parts& parts) : parts_(parts) {}

    /// The pose of a view that leaves room for the panels.
    Pose pose_in(const scene::View& view) const;
    /// Shows the whole DEM in this window.
    void go_home();
    /// Notes that the camera does.
    void note_home();
    void forget_home() { home_.reset(); }
    bool is_home() const { return home_ == parts_.state.document.pose; }
    /// After the window was resized: the whole DEM stays in view if the camera shows that.
    void fit_home();

    /// Carries out a command that moves the camera or the time; ignores others.
    void move(Command command);
    void choose_point(const glm::dvec3& point_m);
    /// @param i  of State::views
    void go_to_view(std::size_t i);
    /// Looks at a place of the ground, and chooses it.
    void go_to_place(const FoundPlace& found);
    /// Looks at a place of the ground from no farther than single posts can be seen.
    void look_down_at(const geo::Geodetic& place);
    /// Looks at the middle of what a file holds on the DEM, unless some of it is in view.
    void show(const FilePlace& place);
    /// When the body next stands over the point, or the moon rises: goes there once it is known.
    /// @param point  none: asks for the moon's next rise by night
    void ask_over_point(sun::Body body, const std::optional<geo::Geodetic>& point);
    void poll_sun_over();
    bool looks_for_time() const { return sun_over_.is_looking(); }

  private:
    /// Stands on the chosen point, or looks at it.
    void move_to_point(Command command);
    /// @param is_up  it stands over the terrain horizon
    void look_to_moon(bool is_up);
    /// A place on the drawn ground; NaN in voids.
    glm::dvec3 drawn_m(geo::Geodetic place) const;
    bool is_in_view(const glm::dvec3& point_m) const;
    /// The whole DEM, from its side and from above.
    Whole whole_views() const;

    Parts parts_;
    SunOver sun_over_;
    std::optional<Pose> home_;  // of the whole DEM,
    glm::vec2 home_size_{0};    // in a window of this size
};

}  // namespace relevo::viewer
