#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/context.h"

struct GLFWwindow;

namespace relevo::viewer {

struct Picture;

/// A key press that no text field has taken.
struct KeyPress {
    int key = 0;  ///< GLFW_KEY_...
    bool control = false, shift = false;
};

/// A window with panels on the display.
class Window {
  public:
    /// @throws Error (NoDevice) without a display or OpenGL
    explicit Window(const std::string& title);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    /// The window's context, current on the thread that created it.
    const gl::Context& context() const;

    /// @throws Error (NoDevice) if the environment names no display
    static void check_display();

    bool should_close() const;
    void close();
    void keep_open();  ///< after a request to close it
    /// Hides the window; the program continues.
    void hide();
    void set_title(const std::string& title);
    glm::ivec2 size_px() const;  ///< of the framebuffer, at the end of the last wait()
    glm::vec2 size() const;      ///< then, too: in units of mouse and panels
    /// Pixels per unit of the mouse, for legible text.
    float scale() const;

    /// Sets the style of panels from the next frame on.
    /// @param text_px  text height on a display of usual density
    void set_style(bool light, int text_px);
    /// Adds the characters of a text to those that panels show, from the next set_style() on.
    /// @returns true if any is new
    bool want_letters(std::string_view text);

    /// Waits for input or wake(), at most this long.
    void wait(double at_most_s);
    /// True if clicks, keys or wheel events came since the last call. Panels need one frame for
    /// each: ImGui uses the mouse's position at the frame, not at the event.
    bool take_input();
    /// Ends wait(). Thread-safe.
    static void wake();

    /// Sets the displayed frame.
    void take(const Picture& picture);
    /// The displayed frame's texture; 0: none yet.
    unsigned texture() const;
    /// Sets the frame left of the dividing line, of the same view; null: none.
    void take_before(const Picture* picture);
    /// Position of the dividing line as a fraction of the window's width.
    float line() const;
    void set_line(float share);
    /// Draws the frame, and the ImGui panels over it. @throws gl::DeviceLost
    void draw(const std::function<void()>& panels);

    /// Without those that the panels take.
    std::vector<KeyPress> take_keys();
    /// Has arrows, Enter, Space and Esc move through the panels.
    /// @param panel  that has the focus; null: what has it now
    void give_keys_to(const char* panel);
    void take_keys_back();
    bool panels_have_keys() const;
    std::vector<std::string> take_dropped_files();
    /// From the window's upper left corner, in units of size().
    glm::vec2 mouse() const;
    int buttons() const;                 ///< pressed mouse buttons, one bit each
    bool is_down(int key) const;         ///< GLFW_KEY_..., pressed without Ctrl
    void copy(const std::string& text);  ///< to the clipboard

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::viewer
