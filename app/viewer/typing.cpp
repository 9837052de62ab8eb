#include "viewer/typing.h"

#include <algorithm>
#include <set>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace relevo::viewer {
namespace {

/// Until a text field that a click or a key with Ctrl opens has the keyboard.
constexpr int kHeld_frames = 3;

bool is_modifier(int key) {
    return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

bool is_control(int key) {
    return key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL;
}

}  // namespace

bool Typed::is_press() const {
    return kind == Kind::Key && action == GLFW_PRESS;
}

bool Typed::has_control() const {
    return (mods & GLFW_MOD_CONTROL) != 0;
}

bool Typing::awaits(int button) const {
    return std::ranges::any_of(waiting_, [&](const Typed& typed) {
        return typed.kind == Typed::Kind::Button && typed.key == button;
    });
}

void Typing::hand_over(bool in_text, const std::function<void(const Typed&)>& take) {
    if (awaits_frame_) return;
    std::set<int> released;
    bool is_full = false, has_letter = false;
    for (; !waiting_.empty(); waiting_.pop_front()) {
        const Typed& next = waiting_.front();
        const bool is_letter = next.kind == Typed::Kind::Letter;
        const bool is_key = next.is_press() && !is_modifier(next.key);
        // A text field takes letters, and not their keys.
        const bool is_command =
            is_key && (!in_text || next.has_control() || next.key >= GLFW_KEY_ESCAPE);
        if (holds_ > 0 && (is_letter || is_key)) return;
        if (is_full && !is_letter) return;
        if (has_letter && next.is_press() && is_control(next.key)) return;
        if (is_command && released.contains(next.key)) return;
        take(next);
        awaits_frame_ = true;
        has_letter = has_letter || is_letter;
        is_full = is_full || is_command || next.kind == Typed::Kind::Button;
        if (next.kind == Typed::Kind::Key && next.action == GLFW_RELEASE) released.insert(next.key);
        if (next.kind == Typed::Kind::Button || (is_command && next.has_control()))
            holds_ = kHeld_frames;
    }
}

void Typing::frame() {
    awaits_frame_ = false;
    holds_ = std::max(holds_ - 1, 0);
}

}  // namespace relevo::viewer
