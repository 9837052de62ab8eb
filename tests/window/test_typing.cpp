// What frames get of the keyboard.
#include <string>
#include <string_view>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "viewer/typing.h"

namespace relevo::viewer {
namespace {

constexpr int kControl = GLFW_KEY_LEFT_CONTROL, kErase = GLFW_KEY_BACKSPACE;

Typed key(int code, int action, int mods = 0) {
    return {.kind = Typed::Kind::Key, .key = code, .action = action, .mods = mods};
}

/// Presses and releases, and the letter that follows.
void tap(Typing& typing, int code, int mods = 0) {
    typing.add(key(code, GLFW_PRESS, mods));
    if (code < GLFW_KEY_ESCAPE && mods == 0)
        typing.add({.kind = Typed::Kind::Letter, .letter = static_cast<unsigned>(code)});
    typing.add(key(code, GLFW_RELEASE, mods));
}

void tap_with_control(Typing& typing, int code) {
    typing.add(key(kControl, GLFW_PRESS));
    tap(typing, code, GLFW_MOD_CONTROL);
    typing.add(key(kControl, GLFW_RELEASE, GLFW_MOD_CONTROL));
}

/// What frames get: "^" for Ctrl, "<" for Backspace, "'A" for a letter, "-A" for a release; "|"
/// ends a frame, "*" for a click.
std::string frames(Typing& typing, bool in_text) {
    std::string text;
    for (int frame = 0; typing.is_waiting() && frame < 100; ++frame) {
        for (int call = 0; call < 2; ++call)  // the second one gives nothing
            typing.hand_over(in_text, [&](const Typed& now) {
                if (now.kind == Typed::Kind::Button) return text += '*', void();
                const bool is_letter = now.kind == Typed::Kind::Letter;
                if (is_letter) text += '\'';
                if (!is_letter && now.action == GLFW_RELEASE) text += '-';
                const int code = is_letter ? static_cast<int>(now.letter) : now.key;
                text += code == kControl ? '^' : code == kErase ? '<' : static_cast<char>(code);
            });
        text += '|';
        typing.frame();
    }
    return text;
}

TEST(Typing, AKeyAfterOneWithCtrlIsWithoutIt) {
    Typing typing;
    tap_with_control(typing, GLFW_KEY_A);
    tap(typing, kErase);
    EXPECT_EQ(frames(typing, /*in_text=*/true), "^A|-A-^||<|-<|");
}

TEST(Typing, AFieldGetsAWordAtOnceAndItsKeysOneByOne) {
    Typing typing;
    for (const char letter : std::string_view("ABBA"))
        tap(typing, letter);
    tap(typing, kErase);
    tap(typing, kErase);
    tap(typing, GLFW_KEY_C);
    tap_with_control(typing, GLFW_KEY_A);
    EXPECT_EQ(frames(typing, /*in_text=*/true), "A'A-AB'B-BB'B-BA'A-A<|-<|<|-<C'C-C|^A|-A-^|");
}

// The wheel that is turned meanwhile has it.
TEST(Typing, ShiftAfterAKeyWithCtrlDoesNotWait) {
    Typing typing;
    tap_with_control(typing, GLFW_KEY_S);
    typing.add(key(GLFW_KEY_LEFT_SHIFT, GLFW_PRESS));
    int shift_at = -1;
    for (int frame = 0; frame < 3; ++frame, typing.frame())
        typing.hand_over(false, [&](const Typed& now) {
            if (now.key == GLFW_KEY_LEFT_SHIFT) shift_at = frame;
        });
    EXPECT_EQ(shift_at, 1);
}

TEST(Typing, AShortcutIsAFramesOnly) {
    Typing typing;
    tap(typing, GLFW_KEY_N);
    tap(typing, GLFW_KEY_T);
    EXPECT_EQ(frames(typing, /*in_text=*/false), "N'N|-NT'T|-T|");
}

// A key that repeats is not late because frames are slow.
TEST(Typing, RepeatsComeTogether) {
    Typing typing;
    typing.add(key(GLFW_KEY_RIGHT_BRACKET, GLFW_PRESS));
    for (int i = 0; i < 3; ++i)
        typing.add(key(GLFW_KEY_RIGHT_BRACKET, GLFW_REPEAT));
    EXPECT_EQ(frames(typing, /*in_text=*/false), "]|]]]|");
}

TEST(Typing, WaitsForAFieldThatIsClicked) {
    Typing typing;
    typing.add({Typed::Kind::Button, GLFW_MOUSE_BUTTON_LEFT, 0, GLFW_PRESS});
    EXPECT_TRUE(typing.awaits(GLFW_MOUSE_BUTTON_LEFT));
    tap(typing, GLFW_KEY_A);
    EXPECT_EQ(frames(typing, /*in_text=*/true), "*|||A'A-A|");
}

}  // namespace
}  // namespace relevo::viewer
