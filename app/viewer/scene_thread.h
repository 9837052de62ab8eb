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

/// Draws the scene on its own thread in its own context, so that the window never waits for it.
namespace relevo::viewer {

/// What the window requests. The latest request replaces earlier ones.
struct Wanted {
    std::optional<scene::View> view;  ///< nullopt: the scene's
    /// Least height of the eye above the drawn ground [m]; nullopt: not raised.
    std::optional<double> keep_above_m = 0;
    std::optional<sun::Instant> utc;          ///< nullopt: the scene's
    std::optional<double> exposure_ev;        ///< nullopt: the scene's
    std::optional<scene::Backdrop> backdrop;  ///< nullopt: the scene's
    std::optional<double> seconds;    ///< of effects that move; nullopt: they move by themselves
    int width_px = 1, height_px = 1;  ///< of the window
    scene::Insets insets;             ///< of its panels, for the scene's view
    bool moving = false;  ///< the user moves the camera: a quick frame is better than a sharp one
    bool sun_moving = false;  ///< the user moves the sun: shadows may lag behind as well
};

/// Colours on the ground.
struct LaidOverlay {
    std::shared_ptr<const render::OverlayRaster> raster;  ///< null: none
    bool without_shadows = false;                         ///< as Session::set_overlay()

    bool operator==(const LaidOverlay&) const = default;
};

/// An open scene.
struct Opened {
    /// Camera of a view. Orbits are placed so that all ground is visible next to the panels.
    scene::Camera camera(const scene::View& view, double aspect, const scene::Insets& insets) const;

    std::shared_ptr<const session::LoadedDem> dem;
    render::Ground ground;
    scene::Scene scene;  ///< both angles of its orbit are set
    scene::Outline outline;
    scene::GroundHeight aim_m;  ///< Session::heights_to_aim_at()
    sun::Instant utc;
    std::optional<chart::Legend> legend;  ///< of the scene's overlay
};

class SceneThread {
  public:
    /// Opens the scene and draws it. If reading the DEM takes long, a preview is drawn first
    /// (session::LoadedDem::is_preview), while the complete DEM loads in the background.
    /// @param device    the device to draw on
    /// @param on_change called on this thread when there is something to fetch
    /// @param dem       the scene's DEM if it has been read, else null
    SceneThread(scene::Scene scene, const SceneDevice& device, std::function<void()> on_change,
                std::shared_ptr<const session::LoadedDem> dem = {});
    SceneThread(const SceneThread&) = delete;
    SceneThread& operator=(const SceneThread&) = delete;
    /// Waits for the current frame, or until the scene is open. Discard does so in the background.
    ~SceneThread();

    /// The open scene, or null. Replaced when the complete DEM replaces a preview, and for another
    /// exaggeration; the frame of reference stays the same.
    std::shared_ptr<const Opened> opened() const;
    /// @throws Error if opening, or reading the complete DEM, has failed
    void check() const;

    void want(const Wanted& wanted);
    /// Requests other effects, or to reload their files.
    void want_effects(const scene::Effects& effects);
    /// Sets a parameter that is not static.
    void want_value(const std::string& address, const std::string& value);

    /// Sets the vertical exaggeration. opened() is replaced.
    void want_exaggeration(double exaggeration);
    /// Replaces a preview with the complete DEM.
    void want_dem(std::shared_ptr<const session::LoadedDem> dem);

    void want_overlay(LaidOverlay overlay);

    /// True if there is nothing left to draw.
    bool rests() const;
    /// Number of requests so far.
    std::uint64_t wants() const;

    /// The newest frame that the device has finished, if its number is greater than `number`. If
    /// frames are shared, call it with the window's context current.
    std::shared_ptr<const Picture> newer_than(std::uint64_t number) const;
    /// The latest failure since the last call, such as a shader that does not compile.
    std::optional<std::string> take_message();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::viewer
