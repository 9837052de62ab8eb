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
    /// Of the DEM that is open. nullopt: as it was opened, all of it in view.
    std::optional<scene::Scene> scene;
    sun::Instant utc{};               ///< of `scene`
    int width_px = 1, height_px = 1;  ///< of the window, instead of the scene's
    scene::Insets insets;             ///< of its panels, for views of the whole DEM
    /// As session::Hints.
    std::optional<double> keep_above_m;
    std::optional<session::LaidOverlay> overlay;
    bool keeps_seconds = false;  ///< effects that move are as in the scene; else they go on
    bool moving = false;  ///< the user moves the camera: a quick frame is better than a sharp one
    bool sun_moving = false;  ///< the user moves the sun: shadows may lag behind as well
    int effects_read = 0;     ///< one more than before: files of effects are read again

    bool operator==(const Wanted&) const = default;
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

    /// Effects that fail leave those before, with a message. opened() is replaced for another
    /// exaggeration.
    void want(const Wanted& wanted);
    /// Replaces a preview with the complete DEM.
    void want_dem(std::shared_ptr<const session::LoadedDem> dem);

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
