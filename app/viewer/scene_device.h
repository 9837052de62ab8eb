#pragma once

#include <future>
#include <memory>
#include <string>

#include "gl/context.h"

namespace relevo::viewer {

/// How frames reach the window: RELEVO_PRESENT.
enum class Presentation {
    Auto,    ///< Shared if window and scene are on the same hardware; otherwise Copy
    Shared,  ///< contexts share objects: frames stay on the device
    Copy,    ///< frames are read by the CPU and uploaded to the window's device
};

/// @throws Error (Usage) for words other than "shared", "copy", "auto"
Presentation presentation_of_environment();

/// The device for scenes. Created before the window, with which some contexts share objects.
/// Thread-safe.
class SceneDevice {
  public:
    /// @param device  as session::Options
    explicit SceneDevice(std::string device, Presentation presentation = Presentation::Copy);

    /// Sets the window's context, which must outlive the contexts of scenes.
    void set_window(const gl::Context& window) const;
    /// Ends the wait of open() if no window can be opened.
    void give_up() const;

    struct Opened {
        gl::Context context;
        bool shares = false;  ///< with the window's context
    };
    /// Creates a context for a scene, current on the calling thread. Waits for the window if
    /// sharing is possible.
    /// @throws Error (NoDevice) as gl::Context, and if Shared is impossible
    Opened open() const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace relevo::viewer
