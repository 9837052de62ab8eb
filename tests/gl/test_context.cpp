#include <cstdlib>

#include <epoxy/gl.h>

#include "gl/context.h"
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
