#include "gl/vertex_array.h"

#include <epoxy/gl.h>

namespace relevo::gl {

void VertexArray::destroy(unsigned name) {
    glDeleteVertexArrays(1, &name);
}

VertexArray::VertexArray() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    handle_ = Handle<&VertexArray::destroy>(name);
}

void VertexArray::attributes(int binding, const Buffer& buffer, int first_location, int count,
                             int components, bool per_instance) {
    const GLuint name = handle_.name();
    const auto slot = static_cast<GLuint>(binding);
    const int bytes = components * static_cast<int>(sizeof(float));
    glVertexArrayVertexBuffer(name, slot, buffer.name(), 0, count * bytes);
    glVertexArrayBindingDivisor(name, slot, per_instance ? 1 : 0);
    for (int i = 0; i < count; ++i) {
        const auto location = static_cast<GLuint>(first_location + i);
        glEnableVertexArrayAttrib(name, location);
        glVertexArrayAttribFormat(name, location, components, GL_FLOAT, GL_FALSE,
                                  static_cast<GLuint>(i * bytes));
        glVertexArrayAttribBinding(name, location, slot);
    }
}

void VertexArray::indices(const Buffer& buffer) {
    glVertexArrayElementBuffer(handle_.name(), buffer.name());
}

void VertexArray::bind() const {
    glBindVertexArray(handle_.name());
}

}  // namespace relevo::gl
