#include <array>
#include <cstdlib>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "gl/context.h"
#include "gl/hidden_libraries.h"
#include "gl/texture.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::gl {
namespace {

TEST(Context, OpensWithoutADisplay) {
    unsetenv("DISPLAY");
    const Context context;
    EXPECT_NE(context.info().renderer, "");
    EXPECT_EQ(context.info().version.substr(0, 3), "4.5");
    EXPECT_GE(context.info().max_texture_units, 16);
}

TEST(Context, SoftwareCanBeAskedFor) {
    const Context context({.device = "software"});
    EXPECT_NE(context.info().renderer.find("llvmpipe"), std::string::npos);
    EXPECT_TRUE(context.info().device.software);
}

TEST(Context, SaysWhichDevicesItTried) {
    const std::string message = test::error_of([] { Context context({.device = "voodoo"}); });
    const std::size_t count = list_devices().size();
    EXPECT_EQ(message.substr(0, message.find('\n')),
              "exit 4: gl: no GL device: none of the " + std::to_string(count) +
                  " found is \"voodoo\" and can draw with OpenGL 4.5 core");
    EXPECT_NE(message.find(" is llvmpipe"), std::string::npos);
    EXPECT_NE(message.find("; see `relevo doctor`"), std::string::npos);
}

TEST(Context, KnowsASoftwareRendererWhateverThePlatform) {
    // EGL marks its devices; of the surfaceless platform only the renderer's name tells.
    for (const Device& device : list_devices()) {
        const Context context({.device = std::to_string(device.index)});
        EXPECT_EQ(context.info().device.software,
                  context.info().renderer.find("llvmpipe") != std::string::npos)
            << device.platform;
    }
    for (const char* renderer : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "SWR (LLVM 11)",
                                 "zink (llvmpipe (LLVM 15))", "Google SwiftShader",
                                 "Software Rasterizer", "GDI Generic", "Apple Software Renderer"})
        EXPECT_TRUE(is_software_renderer(renderer)) << renderer;
    for (const char* renderer :
         {"NVIDIA H100/PCIe/SSE2", "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
          "AMD Radeon RX 6800 (navi21, LLVM 15.0.6, DRM 3.49)"})
        EXPECT_FALSE(is_software_renderer(renderer)) << renderer;
}

TEST(Context, SaysThatSoftwareTakesThePlaceOfHardwareThatWouldNotDo) {
    const std::vector<RefusedDevice> refused{
        {{.index = 0, .platform = "device", .description = "/dev/dri/renderD128"},
         "has no OpenGL 4.5 core"},
        {{.index = 1, .platform = "device", .description = "software renderer", .software = true},
         "does not open"}};
    DeviceInfo chosen;
    chosen.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
    chosen.device.software = true;
    EXPECT_EQ(fall_back_notice(refused, chosen),
              "gl: llvmpipe (LLVM 15.0.6, 256 bits) draws, on the processor, as device 0 "
              "(/dev/dri/renderD128) has no OpenGL 4.5 core");
    EXPECT_EQ(fall_back_notice(std::span(refused).subspan(1), chosen), "");
    chosen.device.software = false;
    EXPECT_EQ(fall_back_notice(refused, chosen), "");
}

TEST(Context, MissingLibrariesAreAMessage) {
    using Case = std::pair<std::vector<std::string>, const char*>;
    for (const auto& [hidden, missing] :
         {Case{{"libEGL"}, "libEGL.so.1"}, Case{{"libOpenGL", "libGL."}, "libOpenGL.so.0"}}) {
        const test::HiddenLibraries none(hidden);
        EXPECT_TRUE(list_devices().empty());
        EXPECT_EQ(test::error_of([] { Context context; }),
                  fmt::format("exit 4: gl: no GL device: there is no {}; install Mesa's software "
                              "renderer (libegl1, libopengl0, libegl-mesa0, libgl1-mesa-dri)",
                              missing));
    }
    const Context context({.device = "software"});  // and they are back
}

TEST(Context, GoesWithoutTakingAnotherAlong) {
    std::optional<Context> first(std::in_place, ContextOptions{.device = test::gl_device()});
    std::optional<Context> second(std::in_place, ContextOptions{.device = test::gl_device()});
    const auto draws = [] {
        Texture texture(TextureKind::D2, Format::R32F, {1, 1, 1}, 1, "one");
        const std::array written{0.25f};
        std::array read{0.0f};
        texture.write(0, {0, 0, 0}, {1, 1, 1}, std::as_bytes(std::span(written)));
        texture.read(0, std::as_writable_bytes(std::span(read)));
        return read == written;
    };
    // One that is not current goes, and the current one stays so.
    first.reset();
    EXPECT_TRUE(draws());
    // The current one goes, and the display stays there for the next.
    Context third({.device = test::gl_device()});
    second.reset();
    EXPECT_TRUE(draws());
}

TEST(Context, TellsOfErrorsAlsoWithoutADebugContext) {
    Context context({.device = test::gl_device()});
    glEnable(GL_TEXTURE_WRAP_S);
    EXPECT_EQ(test::error_of([&] { context.check_errors(); }), "exit 1: gl: GL_INVALID_ENUM");
    context.check_errors();
}

TEST(Context, TurnsGlErrorsIntoFailures) {
    Context context({.debug = true});
    context.check_errors();
    glEnable(GL_TEXTURE_WRAP_S);  // no capability
    const std::string message = test::error_of([&] { context.check_errors(); });
    EXPECT_EQ(message.substr(0, 12), "exit 1: gl: ");
    EXPECT_NE(message.find("GL_INVALID_ENUM"), std::string::npos);
    context.check_errors();  // told once
}

}  // namespace
}  // namespace relevo::gl
