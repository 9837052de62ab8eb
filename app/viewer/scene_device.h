#pragma once

#include <future>
#include <memory>
#include <string>

#include "gl/context.h"

namespace relevo::viewer {

/// How the window gets the frames of a scene: RELEVO_PRESENT.
enum class Presentation {
    Auto,    ///< Shared where the window is on hardware, and the scene on the same; else Copy
    Shared,  ///< from contexts that share with the window's: frames stay on the device
    Copy,    ///< read by the processor and written to the window's device
};

/// @throws Error (Usage) for another word than "shared", "copy", "auto" or none
Presentation presentation_of_environment();

/// The device that scenes are drawn on. Made before the window, whose context some of them share.
/// May be used by several threads.
class SceneDevice {
  public:
    /// @param device  as session::Options
    explicit SceneDevice(std::string device, Presentation presentation = Presentation::Copy);

    /// The window's context, once it is open; must outlive the contexts of scenes.
    void set_window(const gl::Context& window) const;
    /// The window will not open: open() does not wait for it any more.
    void give_up() const;

    struct Opened {
        gl::Context context;
        bool shares = false;  ///< with the window's
    };
    /// Opens a context for a scene, current on the calling thread. Waits for the window if that may
    /// share.
    /// @throws Error (NoDevice) as gl::Context, and where Shared is asked for and cannot be
    Opened open() const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace relevo::viewer
