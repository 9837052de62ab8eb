#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/errors.h"

namespace relevo::gl {

/// One way to get a GL context without a window.
struct Device {
    int index = 0;         ///< as `--device` takes it
    std::string platform;  ///< "device" (an EGL device), "surfaceless", or "window"
    std::string
        description;  ///< what EGL says of it: render node, "software", extensions that matter
    bool software =
        false;  ///< a software renderer: EGL marks it, or an open context is known as one
};

/// The devices in the order in which they are tried: hardware first, then software, then the
/// surfaceless platform. Empty where EGL itself is missing. Of the surfaceless platform nothing is
/// known before a context is open.
std::vector<Device> list_devices();

/// Whether a renderer, by the name that GL gives it, is known to draw on the processor.
bool is_software_renderer(std::string_view renderer);

/// A device that was tried and would not do.
struct RefusedDevice {
    Device device;
    std::string reason;  ///< "has no OpenGL 4.5 core"
};

/// What GL says of itself once a context is current.
struct DeviceInfo {
    Device device;
    std::string renderer, vendor, version;
    int max_texture_units = 0;  ///< of a fragment program
    int max_texture_size = 0;   ///< [px]
    int max_picture_size = 0;   ///< that can be drawn at once, each way [px]
    int max_volume_size = 0;    ///< of a texture with three dimensions [px]
    int max_array_layers = 0;   ///< of an array texture
    int max_samples = 0;        ///< of a half-float colour target
    double max_anisotropy = 1;  ///< 1 where there is no anisotropic filter
};

/// That a software renderer draws as hardware would not do; empty where there was none.
std::string fall_back_notice(std::span<const RefusedDevice> refused, const DeviceInfo& chosen);

struct ContextOptions {
    /// "auto", the index of a device, "software", or a part of a renderer's name ("nvidia").
    std::string device = "auto";
    /// A debug context: GL errors are collected and thrown by check_errors().
    bool debug = false;
};

/// An OpenGL 4.5 core context. One of its own has no window and is current on the thread that made
/// it, through EGL: the device platform, then the surfaceless one. Clip space has depth 0..1
/// (reversed-Z is the caller's).
///
/// Every other object of this layer needs a Context that lives longer than it does. Contexts share
/// the display of a device, with each other and with all else in the process, and leave it as it is
/// when they go.
class Context {
  public:
    /// Says so once where any device was asked for and a software one takes the place of hardware.
    /// @throws Error (NoDevice) with each device that was tried and why it would not do
    explicit Context(const ContextOptions& options = {});
    /// A context that someone else has made, such as a window's, and made current on this thread.
    /// It goes when they let it go.
    /// @param make_current  makes it current on the calling thread
    /// @throws Error (NoDevice) where it has no OpenGL 4.5 core
    static Context of_others(std::function<void()> make_current);
    /// A context of its own on the display of another one, which may be current on another thread:
    /// textures, buffers and fences of each are the other's as well. Current on this thread.
    /// @param other  must outlive it
    /// @throws Error (NoDevice) where the device makes none
    static Context sharing(const Context& other);
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;
    ~Context();

    const DeviceInfo& info() const;

    /// Makes it the one that this thread draws with, where others have been made since.
    /// @throws Error (Failed) where the device refuses
    void make_current();

    /// Whether both are of one EGL device, so that they can share.
    bool is_on_device_of(const Context& other) const;

    /// Throws what went wrong since the last call: what a debug context has collected, else the
    /// name of the first error.
    /// @throws DeviceLost; Error (Failed) `gl: message`
    void check_errors();

    /// Waits until the device has done everything asked so far.
    void finish();

  private:
    struct Impl;
    explicit Context(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::gl
