#pragma once

#include <deque>
#include <functional>

namespace relevo::viewer {

/// An event of the keyboard, or the press of a mouse button, as GLFW reports it.
struct Typed {
    enum class Kind { Key, Letter, Button } kind = Kind::Key;
    int key = 0;  ///< or mouse button
    int scancode = 0, action = 0, mods = 0;
    unsigned letter = 0;

    bool is_press() const;
    bool has_control() const;
};

/// Hands what was typed to the frames, in order. ImGui looks at keys once a frame, and at letters
/// before them (its queue of events came with version 1.87). So a frame gets letters and then one
/// key that writes no letter. The rest waits for the next frame: no key is lost, comes before an
/// earlier one, or is taken with another key's Ctrl.
class Typing {
  public:
    void add(const Typed& typed) { waiting_.push_back(typed); }
    bool is_waiting() const { return !waiting_.empty(); }
    /// Whether a button of the mouse was pressed after what frames have got.
    bool awaits(int button) const;
    /// Hands over what the next frame gets. Nothing until frame() after a call that did.
    /// @param in_text  a text field has the keyboard
    void hand_over(bool in_text, const std::function<void(const Typed&)>& take);
    /// A frame took it.
    void frame();

  private:
    std::deque<Typed> waiting_;
    bool awaits_frame_ = false;
    int holds_ = 0;  // so many frames
};

}  // namespace relevo::viewer
