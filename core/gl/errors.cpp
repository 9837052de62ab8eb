#include "gl/errors.h"

#include <algorithm>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"

namespace relevo::gl {
namespace {

constexpr std::size_t kLongestLabel = 255;  // GL_MAX_LABEL_LENGTH is 256 at least, with its end

}  // namespace

std::string error_name(unsigned error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return fmt::format("GL error 0x{:04x}", error);
    }
}

void expect_no_error(std::string_view before) {
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) failed(fmt::format("gl: before {}: {}", before, error_name(error)));
}

void set_label(unsigned kind, unsigned name, std::string_view label) {
    const std::size_t length = std::min(label.size(), kLongestLabel);
    glObjectLabel(kind, name, static_cast<GLsizei>(length), label.data());
}

}  // namespace relevo::gl
