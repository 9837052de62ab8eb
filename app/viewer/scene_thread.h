#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/frame_block.h"
#include "scene/scene.h"
#include "session/session.h"
#include "sun/time.h"
#include "viewer/picture.h"
#include "viewer/scene_device.h"

/// The scene is drawn on a thread of its own, in a context of its own, so that the window never
/// waits for it.
namespace relevo::viewer {

/// What the window wants to see: the last word counts.
struct Wanted {
    std::optional<scene::View> view;  ///< none: the scene's
    double keep_above_m = 0;          ///< the eye is raised to be so far above the drawn ground
    std::optional<sun::Instant> utc;  ///< likewise
    int width_px = 1, height_px = 1;  ///< of the window
    scene::Insets insets;             ///< of its panels, for the scene's view
    bool moving = false;              ///< the hand moves the camera: rather soon than sharp
    bool sun_moving = false;          ///< likewise the sun: shadows may lag behind
};

/// A scene as it was opened.
struct Opened {
    /// A view of it without an eye of its own stands so that all is seen beside the panels.
    scene::Camera camera(const scene::View& view, double aspect, const scene::Insets& insets) const;

    std::shared_ptr<const session::LoadedDem> dem;
    render::Ground ground;
    scene::Scene scene;  ///< whose orbit has both angles
    scene::Outline outline;
    scene::GroundHeight aim_m;  ///< Session::heights_to_aim_at()
    sun::Instant utc;
    std::optional<chart::Legend> legend;  ///< of the scene's overlay
};

class SceneThread {
  public:
    /// Opens the scene and draws. Where the DEM takes long to read, first what stands in for it
    /// (session::LoadedDem::stands_in); all posts are then read beside, and take its place.
    /// @param device    that it is drawn on
    /// @param on_change called on that thread whenever there is something to fetch
    /// @param dem       the scene's, where it has been read already; else it is read
    SceneThread(scene::Scene scene, const SceneDevice& device, std::function<void()> on_change,
                std::shared_ptr<const session::LoadedDem> dem = {});
    SceneThread(const SceneThread&) = delete;
    SceneThread& operator=(const SceneThread&) = delete;
    /// Waits for the frame in work, or for the scene to be open: Discard does it beside.
    ~SceneThread();

    /// Once the scene is open; else null. Another one when all posts have taken the place of what
    /// stood in for them; its frame is the same.
    std::shared_ptr<const Opened> opened() const;
    /// Why it cannot be opened, or all of it not be read.
    /// @throws Error what opening threw
    void check() const;

    void want(const Wanted& wanted);
    /// Other effects, or the same read again from their files.
    void want_effects(const scene::Effects& effects);
    /// A value of a parameter that is not static.
    void want_value(const std::string& address, const std::string& value);

    /// All posts of the DEM, of which others stand in.
    void want_dem(std::shared_ptr<const session::LoadedDem> dem);

    /// Colours on the ground; null: none.
    void want_drape(std::shared_ptr<const render::Drape> drape);

    /// Whether there is nothing left to draw.
    bool rests() const;
    /// How often something was wanted.
    std::uint64_t wants() const;

    /// The newest picture that the device has finished, if it is newer than `number`. Called with
    /// the window's context current where frames are shared.
    std::shared_ptr<const Picture> newer_than(std::uint64_t number) const;
    /// What went wrong since the last call, such as a shader that no driver takes.
    std::optional<std::string> take_message();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::viewer
