#include "viewer/window.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <imgui.h>
#include <imgui_internal.h>

#include "base/error.h"
#include "base/watchdog.h"
#include "gl/context.h"
#include "gl/framebuffer.h"
#include "viewer/fonts.h"
#include "viewer/scene_thread.h"
#include "viewer/style.h"
#include "viewer/typing.h"

namespace relevo::viewer {
namespace {

constexpr int kWidth = 1280, kHeight = 800;
constexpr float kText_px = 16;  // text height that sizes of panels refer to

[[noreturn]] void no_display() {
    throw Error(ErrorCode::NoDevice,
                "view: no display to open a window on; relevo capture takes a picture "
                "without one");
}

/// Xlib calls exit() when the X server is gone, while other threads still draw, so that destructors
/// and exit handlers must not run. This ends the process at once with a message.
void end_where_the_display_goes() {
    // Writing to a server that is gone raises SIGPIPE before Xlib sees the error.
    std::signal(SIGPIPE, SIG_IGN);
    // The library that GLFW loads; never unloaded.
    void* const xlib = dlopen("libX11.so.6", RTLD_LAZY);
    if (!xlib) return;
    using Handler = int (*)(void* display);
    const auto set = reinterpret_cast<Handler (*)(Handler)>(dlsym(xlib, "XSetIOErrorHandler"));
    if (!set) return;
    set([](void*) -> int { end_program("view: the connection to the display was lost"); });
}

/// Closes the innermost menu, list or calendar; the focus returns to what it lies over.
void close_popup() {
    const int levels = ImGui::GetCurrentContext()->OpenPopupStack.Size;
    if (levels > 0) ImGui::ClosePopupToLevel(levels - 1, true);
}

/// The letter on a key in the user's keyboard layout, else the key itself.
int letter_of(int key, int scancode) {
    const char* const name = glfwGetKeyName(key, scancode);
    const bool is_letter = name && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0';
    return is_letter ? GLFW_KEY_A + (name[0] - 'a') : key;
}

/// Keys that repeat while held.
bool repeats(int key) {
    return key == GLFW_KEY_LEFT_BRACKET || key == GLFW_KEY_RIGHT_BRACKET || key == GLFW_KEY_Z ||
           key == GLFW_KEY_Y;
}

/// GLFW's last error message, for Error.
std::string& last_error() {
    static std::string text;
    return text;
}

/// True while there is a window to wake.
std::atomic<bool>& is_open() {
    static std::atomic<bool> open{false};
    return open;
}

/// A displayed frame on the window's device.
struct Shown {
    gl::Texture texture;                 // a copied frame
    std::shared_ptr<SharedFrame> frame;  // otherwise a shared frame
    std::optional<gl::Framebuffer> target;

    void take(const Picture& picture) {
        if (picture.shared) {
            target.reset();
            frame = picture.shared;
            frame->drawn.wait_on_device();
            target.emplace(std::initializer_list<const gl::Texture*>{&frame->colour}, nullptr,
                           "shown");
            return;
        }
        const gl::Extent extent{picture.width_px, picture.height_px, 1};
        if (!target || frame || texture.extent() != extent) {
            target.reset();
            frame.reset();
            texture =
                gl::Texture(gl::TextureKind::D2, gl::Format::RGBA8, extent, 1, "scene's picture");
            target.emplace(std::initializer_list<const gl::Texture*>{&texture}, nullptr, "shown");
        }
        texture.write(0, {0, 0, 0}, extent, std::as_bytes(std::span(picture.rgba)));
    }

    /// Copies the frame to the window.
    void draw(glm::ivec2 size_px, float share = 1) const {
        target->copy_to_window(size_px.x, size_px.y, share);
        if (frame) frame->shown = gl::Fence::insert();
    }
};

}  // namespace

namespace {

/// As large as usual, or as the screen has room for.
GLFWwindow* create(const std::string& title) {
    int left = 0, top = 0, width = 0, height = 0;
    float scale = 1;
    if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor()) {
        glfwGetMonitorWorkarea(monitor, &left, &top, &width, &height);
        glfwGetMonitorContentScale(monitor, &scale, nullptr);
    }
    const auto fitting = [&](int usual, int room) {
        const int most = static_cast<int>(static_cast<float>(room) / std::max(scale, 1.0f));
        return most > 0 ? std::min(usual, most) : usual;
    };
    return glfwCreateWindow(fitting(kWidth, width), fitting(kHeight, height), title.c_str(),
                            nullptr, nullptr);
}

}  // namespace

struct Window::Impl {
    GLFWwindow* handle = nullptr;
    glm::ivec2 size_px{1};
    glm::vec2 size{1};
    std::optional<gl::Context> context;
    Shown shown, before;
    float line = 0.5f;
    std::set<char32_t> letters;  // additional characters of panels
    std::vector<KeyPress> keys;
    std::set<int> held;  // pressed without Ctrl, even if Ctrl is released first
    Typing typing;
    std::vector<std::string> dropped;
    bool has_input = false;  // clicks or wheel events
    bool closes_popup = false;
    int frames = 0;  // until it is shown

    explicit Impl(const std::string& title) {
        glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
        end_where_the_display_goes();
        // If the display hangs while a window is created, Mesa waits forever.
        Watchdog watchdog;
        watchdog.start(patience(),
                       "view: the display does not answer; relevo capture takes a "
                       "picture without one");
        if (!glfwInit()) no_display();
        glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);  // until its first frame is there
        // By it desktops find the entry of the program, with its icon.
        glfwWindowHintString(GLFW_X11_CLASS_NAME, "relevo");
        glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "relevo");
        // Some drivers cannot report the loss of a device.
        for (const int robustness : {GLFW_LOSE_CONTEXT_ON_RESET, GLFW_NO_ROBUSTNESS}) {
            glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, robustness);
            handle = create(title);
            if (handle) break;
        }
        if (!handle) {
            const std::string why = last_error();
            glfwTerminate();
            throw Error(ErrorCode::NoDevice,
                        fmt::format("view: the display opens no window with OpenGL 4.5, {}; relevo "
                                    "capture takes a picture without one",
                                    why));
        }
        try {
            open();
        } catch (...) {
            close();
            throw;
        }
    }

    static Impl& of(GLFWwindow* window) {
        return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
    }

    void open() {
        context.emplace(gl::Context::of_others([this] { glfwMakeContextCurrent(handle); }));
        glfwSwapInterval(1);
        glfwSetWindowUserPointer(handle, this);
        measure();
        // ImGui's callbacks chain to these.
        glfwSetScrollCallback(
            handle, [](GLFWwindow* window, double, double) { of(window).has_input = true; });
        glfwSetDropCallback(handle, [](GLFWwindow* window, int count, const char** names) {
            Impl& self = of(window);
            self.dropped.assign(names, names + count);
        });
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().LogFilename = nullptr;
        ImGui_ImplGlfw_InitForOpenGL(handle, /*install_callbacks=*/true);
        // Instead of ImGui's, which type() calls.
        glfwSetKeyCallback(
            handle, [](GLFWwindow* window, int key, int scancode, int action, int mods) {
                of(window).typing.add({Typed::Kind::Key, key, scancode, action, mods});
            });
        glfwSetCharCallback(handle, [](GLFWwindow* window, unsigned letter) {
            of(window).typing.add({.kind = Typed::Kind::Letter, .letter = letter});
        });
        glfwSetMouseButtonCallback(
            handle, [](GLFWwindow* window, int button, int action, int mods) {
                of(window).has_input = true;
                if (action == GLFW_PRESS)
                    of(window).typing.add({Typed::Kind::Button, button, 0, action, mods});
            });
        ImGui_ImplOpenGL3_Init("#version 450 core");
        is_open() = true;
    }

    void type(const Typed& now) {
        if (now.kind == Typed::Kind::Letter) return ImGui_ImplGlfw_CharCallback(handle, now.letter);
        if (now.kind == Typed::Kind::Button)
            return ImGui_ImplGlfw_MouseButtonCallback(handle, now.key, now.action, now.mods);
        ImGui_ImplGlfw_KeyCallback(handle, now.key, now.scancode, now.action, now.mods);
        if (now.is_press() && !now.has_control()) held.insert(now.key);
        if (now.action == GLFW_RELEASE) held.erase(now.key);
        const int key = letter_of(now.key, now.scancode);
        if (now.is_press() || (now.action == GLFW_REPEAT && repeats(key)))
            keys.push_back({key, now.has_control(), (now.mods & GLFW_MOD_SHIFT) != 0});
    }

    void set_style(bool light, int text_px) {
        float scale = 1;
        glfwGetWindowContentScale(handle, &scale, nullptr);
        ImGui::GetIO().Fonts->Clear();
        load_fonts(static_cast<float>(text_px) * scale, letters);
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
        scale *= static_cast<float>(text_px) / kText_px;
        ImGuiStyle& style = ImGui::GetStyle();
        style = ImGuiStyle();
        style::set_colours(style, light);
        style.ScaleAllSizes(scale);
        style.WindowRounding = 6 * scale;
        style.FrameRounding = 3 * scale;
    }

    /// GLFW asks the display, where a window changes its size at any moment.
    void measure() {
        glm::ivec2 now(1);
        glfwGetWindowSize(handle, &now.x, &now.y);
        size = glm::vec2(glm::max(now, glm::ivec2(1)));
        glfwGetFramebufferSize(handle, &now.x, &now.y);
        size_px = glm::max(now, glm::ivec2(1));
    }

    void close() {
        is_open() = false;
        if (ImGui::GetCurrentContext()) {
            ImGui_ImplOpenGL3_Shutdown();
            ImGui_ImplGlfw_Shutdown();
            ImGui::DestroyContext();
        }
        shown = {};
        before = {};
        context.reset();
        glfwDestroyWindow(handle);
        glfwTerminate();
    }

    ~Impl() { close(); }

    void show(glm::ivec2 size) const {
        if (!shown.target) return;
        shown.draw(size);
        if (before.target) before.draw(size, line);
    }
};

Window::Window(const std::string& title) : impl_(std::make_unique<Impl>(title)) {}
Window::~Window() = default;

const gl::Context& Window::context() const {
    return *impl_->context;
}

void Window::check_display() {
    const auto is_set = [](const char* name) {
        const char* const value = std::getenv(name);
        return value && *value;
    };
    if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) no_display();
}

bool Window::should_close() const {
    return glfwWindowShouldClose(impl_->handle);
}

void Window::close() {
    glfwSetWindowShouldClose(impl_->handle, GLFW_TRUE);
}

void Window::keep_open() {
    glfwSetWindowShouldClose(impl_->handle, GLFW_FALSE);
}

void Window::hide() {
    glfwHideWindow(impl_->handle);
    glfwPollEvents();
}

void Window::set_style(bool light, int text_px) {
    impl_->set_style(light, text_px);
}

bool Window::want_letters(std::string_view text) {
    const std::size_t before = impl_->letters.size();
    impl_->letters.merge(unusual_letters(text));
    return impl_->letters.size() != before;
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(impl_->handle, title.c_str());
}

glm::ivec2 Window::size_px() const {
    return impl_->size_px;
}

float Window::scale() const {
    float scale = 1;
    glfwGetWindowContentScale(impl_->handle, &scale, nullptr);
    return scale;
}

void Window::wait(double at_most_s) {
    if (at_most_s > 0)
        glfwWaitEventsTimeout(at_most_s);
    else
        glfwPollEvents();
    impl_->measure();
}

bool Window::take_input() {
    return std::exchange(impl_->has_input, false) || impl_->typing.is_waiting();
}

void Window::wake() {
    if (is_open()) glfwPostEmptyEvent();
}

void Window::take(const Picture& picture) {
    impl_->shown.take(picture);
}

unsigned Window::texture() const {
    return impl_->shown.frame ? impl_->shown.frame->colour.name() : impl_->shown.texture.name();
}

void Window::take_before(const Picture* picture) {
    if (picture)
        impl_->before.take(*picture);
    else
        impl_->before = {};
}

float Window::line() const {
    return impl_->line;
}

void Window::set_line(float share) {
    impl_->line = share;
}

void Window::draw(const std::function<void()>& panels) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    // A press comes after what was typed before it.
    ImGuiIO& io = ImGui::GetIO();
    for (int button = 0; button < IM_ARRAYSIZE(io.MouseDown); ++button)
        if (impl_->typing.awaits(button)) io.MouseDown[button] = false;
    ImGui::NewFrame();
    impl_->typing.frame();
    panels();
    // After the panels: the same Esc must not also close the sheet that gets the focus back.
    if (std::exchange(impl_->closes_popup, false)) close_popup();
    const glm::ivec2 size = size_px();
    if (impl_->before.target) {
        const float x = impl_->line * ImGui::GetIO().DisplaySize.x;
        ImGui::GetBackgroundDrawList()->AddLine({x, 0}, {x, ImGui::GetIO().DisplaySize.y},
                                                style::kDivider, 2);
    }
    ImGui::Render();
    const auto present = [&] {
        impl_->show(size);
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        glfwSwapBuffers(impl_->handle);
    };
    present();
    // ImGui lays panels out before it draws them. A hidden window keeps no frame.
    constexpr int kSettled = 3;
    if (impl_->frames < kSettled && ++impl_->frames == kSettled) {
        glfwShowWindow(impl_->handle);
        present();
    }
    gl::throw_if_lost();
}

std::vector<KeyPress> Window::take_keys() {
    impl_->typing.hand_over(ImGui::GetIO().WantTextInput,
                            [&](const Typed& typed) { impl_->type(typed); });
    std::vector<KeyPress> keys = std::exchange(impl_->keys, {});
    if (ImGui::GetIO().WantTextInput) keys.clear();
    // Esc first ends what is active in the panels. ImGui closes popups only with its own keyboard.
    const bool has_popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup);
    const bool is_active = ImGui::IsAnyItemActive();
    if (has_popup || is_active) {
        const bool has_escape = std::erase_if(keys, [](const KeyPress& press) {
                                    return press.key == GLFW_KEY_ESCAPE;
                                }) > 0;
        if (has_escape && !is_active && !panels_have_keys()) impl_->closes_popup = true;
    }
    if (!panels_have_keys()) return keys;
    std::erase_if(keys, [&](const KeyPress& press) {
        const bool is_function = press.key >= GLFW_KEY_F1 && press.key <= GLFW_KEY_F25;
        if (press.key == GLFW_KEY_ESCAPE) take_keys_back();
        return !press.control && !is_function;
    });
    return keys;
}

void Window::give_keys_to(const char* panel) {
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    if (panel) ImGui::SetWindowFocus(panel);
}

void Window::take_keys_back() {
    ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::SetWindowFocus(nullptr);
}

bool Window::panels_have_keys() const {
    return (ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0;
}

std::vector<std::string> Window::take_dropped_files() {
    return std::exchange(impl_->dropped, {});
}

glm::vec2 Window::mouse() const {
    glm::dvec2 at(0);
    glfwGetCursorPos(impl_->handle, &at.x, &at.y);
    return glm::vec2(at);
}

int Window::buttons() const {
    int pressed = 0;
    for (const int button : {0, 1, 2})
        if (glfwGetMouseButton(impl_->handle, button) == GLFW_PRESS) pressed |= 1 << button;
    return pressed;
}

glm::vec2 Window::size() const {
    return impl_->size;
}

bool Window::is_down(int key) const {
    return !ImGui::GetIO().WantTextInput && !panels_have_keys() && impl_->held.contains(key);
}

void Window::copy(const std::string& text) {
    glfwSetClipboardString(impl_->handle, text.c_str());
}

}  // namespace relevo::viewer
