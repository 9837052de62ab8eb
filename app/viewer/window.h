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

/// A key that was pressed, where no field of a panel takes it.
struct KeyPress {
    int key = 0;  ///< GLFW_KEY_...
    bool control = false, shift = false;
};

/// A window with panels in it, on the display there is.
class Window {
  public:
    /// @throws Error (NoDevice) without a display, or one that has no OpenGL
    explicit Window(const std::string& title);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    /// The context that it is drawn with, current on the thread that made the window.
    const gl::Context& context() const;

    /// @throws Error (NoDevice) where nothing tells of a display
    static void check_display();

    bool should_close() const;
    void close();
    /// Takes it off the display; what goes on goes on unseen.
    void hide();
    void set_title(const std::string& title);
    glm::ivec2 size_px() const;  ///< of what is drawn into
    glm::vec2 size() const;      ///< in the units of the mouse and of panels
    /// Pixels that are drawn for one of the mouse's units, for text that can be read.
    float scale() const;

    /// How panels look from the next frame on.
    /// @param text_px  height of letters, on a display of usual density
    void set_style(bool light, int text_px);
    /// Has panels show the letters of a text, of whatever script, from the next set_style() on.
    /// @returns whether there are any that they do not show yet
    bool want_letters(std::string_view text);

    /// Waits for input for so long at most, or for wake().
    void wait(double at_most_s);
    /// Whether clicks, keys or turns of the wheel have come since the last call. Panels need frames
    /// of their own for each: a click that is let go is taken where the mouse is by then.
    bool take_input();
    /// Ends a wait; from any thread.
    static void wake();

    /// Shows a picture from the next frame on.
    void take(const Picture& picture);
    /// Shows another picture on the left of a line, which has to be the same view; null: none.
    void take_before(const Picture* picture);
    /// The line's place, as a share of the window's width.
    float line() const;
    void set_line(float share);
    /// Draws the picture, and over it what `panels` draws with ImGui. @throws gl::DeviceLost
    void draw(const std::function<void()>& panels);

    std::vector<KeyPress> take_keys();
    std::vector<std::string> take_dropped_files();
    /// From the window's upper left corner, in the units of size().
    glm::vec2 mouse() const;
    int buttons() const;                 ///< of the mouse that are pressed now, a bit each
    bool is_down(int key) const;         ///< GLFW_KEY_..., pressed without Ctrl
    void copy(const std::string& text);  ///< to the clipboard

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::viewer
