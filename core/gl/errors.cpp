#include "gl/errors.h"

#include <algorithm>
#include <array>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"

namespace relevo::gl {
namespace {

constexpr std::size_t kLongestLabel = 255;  // GL_MAX_LABEL_LENGTH is 256 at least, with its end

}  // namespace

std::string error_name(unsigned error) {
    constexpr std::array kNames = {
        std::pair(GL_INVALID_ENUM, "GL_INVALID_ENUM"),
        std::pair(GL_INVALID_VALUE, "GL_INVALID_VALUE"),
        std::pair(GL_INVALID_OPERATION, "GL_INVALID_OPERATION"),
        std::pair(GL_INVALID_FRAMEBUFFER_OPERATION, "GL_INVALID_FRAMEBUFFER_OPERATION"),
        std::pair(GL_OUT_OF_MEMORY, "GL_OUT_OF_MEMORY"),
        std::pair(GL_CONTEXT_LOST, "GL_CONTEXT_LOST")};
    for (const auto& [number, name] : kNames)
        if (static_cast<unsigned>(number) == error) return name;
    return fmt::format("GL error 0x{:04x}", error);
}

void throw_if_lost() {
    if (glGetGraphicsResetStatus() == GL_NO_ERROR) return;
    const GLubyte* const renderer = glGetString(GL_RENDERER);
    throw DeviceLost(fmt::format(
        "gl: {} was lost: its driver has reset it, after a fault or after a command that took too "
        "long",
        renderer ? reinterpret_cast<const char*>(renderer) : "the device"));
}

void expect_no_error(std::string_view before) {
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) throw_if_lost();
    if (error != GL_NO_ERROR) failed(fmt::format("gl: before {}: {}", before, error_name(error)));
}

void set_label(unsigned kind, unsigned name, std::string_view label) {
    const std::size_t length = std::min(label.size(), kLongestLabel);
    glObjectLabel(kind, name, static_cast<GLsizei>(length), label.data());
}

}  // namespace relevo::gl
