// The smallest window on a session: drag to orbit, scroll to zoom, left and right move the sun by
// half an hour, the slider thickens the haze, R reads the effects' files again. Takes a scene of
// `relevo capture --save-scene`.
#define GLFW_INCLUDE_NONE
#include <algorithm>
#include <cstdio>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "base/error.h"
#include "gl/framebuffer.h"
#include "session/active_effects.h"
#include "session/session.h"

namespace {

using relevo::session::Session;

/// What the next frame shows.
struct Shown {
    Session& session;
    relevo::scene::Scene scene;
    relevo::sun::Instant utc;
    relevo::session::Hints hints;
    std::string message;
};

void show(Shown& shown) {
    try {
        shown.session.show(shown.scene, shown.utc, shown.hints);
        if (shown.hints.reload_effects) shown.message = "effects read again";
    } catch (const relevo::Error& error) {
        shown.message = error.what();  // the last good program stays
    }
    shown.hints = {.exact = false};
}

/// The mouse where no widget takes it.
void orbit(relevo::scene::View& view) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse) return;
    view.orbit.zoom *= 1 + 0.2 * io.MouseWheel;
    if (io.MouseDown[0]) {
        view.orbit.azimuth_deg = *view.orbit.azimuth_deg + 0.3 * io.MouseDelta.x;
        view.orbit.elevation_deg =
            std::clamp(*view.orbit.elevation_deg + 0.3 * io.MouseDelta.y, 1.0, 89.0);
    }
}

void on_key(GLFWwindow* window, int key, int, int action, int) {
    auto& shown = *static_cast<Shown*>(glfwGetWindowUserPointer(window));
    if (action == GLFW_RELEASE) return;
    if (key == GLFW_KEY_LEFT) shown.utc = shown.utc + -1800.0;
    if (key == GLFW_KEY_RIGHT) shown.utc = shown.utc + 1800.0;
    shown.hints.reload_effects = key == GLFW_KEY_R;
}

void frame(GLFWwindow* window, Shown& shown) {
    Session& session = shown.session;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    float density = session.effects().values.value("haze.density")[0];
    if (ImGui::SliderFloat("haze", &density, 0, 0.5f))
        shown.scene.effects = relevo::scene::merge(
            shown.scene.effects, {.settings = {{"haze.density", std::to_string(density)}}});
    ImGui::TextUnformatted(session.sun_text().c_str());
    orbit(shown.scene.view);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    shown.scene.width_px = std::max(width, 1);
    shown.scene.height_px = std::max(height, 1);
    show(shown);
    session.draw_available();
    relevo::gl::Framebuffer({&session.texture()}, nullptr, "shown").copy_to_window(width, height);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSetWindowTitle(window, (session.sun_text() + " " + shown.message).c_str());
    glfwSwapBuffers(window);
}

}  // namespace

int main(int count, char** arguments) try {
    if (count != 2 || !glfwInit()) return std::puts("example_window SCENE.json, on a display"), 1;
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    GLFWwindow* const window = glfwCreateWindow(960, 640, "Relevo", nullptr, nullptr);
    const auto make_current = [&] { glfwMakeContextCurrent(window); };
    relevo::session::Options options;
    options.context = [&] { return relevo::gl::Context::of_others(make_current); };
    relevo::FilesInUse files;
    Session session(relevo::scene::read_scene(arguments[1]), options, files);
    ImGui::CreateContext();
    ImGui_ImplGlfw_InitForOpenGL(window, /*install_callbacks=*/true);
    ImGui_ImplOpenGL3_Init();
    Shown shown{session, session.scene(), session.time(), {.exact = false}, {}};
    glfwSetWindowUserPointer(window, &shown);
    glfwSetKeyCallback(window, on_key);
    for (; !glfwWindowShouldClose(window); glfwPollEvents())
        frame(window, shown);
} catch (const relevo::Error& error) {
    return std::puts(error.what()), 1;
}
