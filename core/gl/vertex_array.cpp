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
    attributes(binding, first_location, count, components, per_instance);
    feed(binding, {buffer.name(), 0, buffer.size()},
         count * components * static_cast<int>(sizeof(float)));
}

void VertexArray::attributes(int binding, int first_location, int count, int components,
                             bool per_instance) {
    const GLuint name = handle_.name();
    const auto slot = static_cast<GLuint>(binding);
    const int bytes = components * static_cast<int>(sizeof(float));
    glVertexArrayBindingDivisor(name, slot, per_instance ? 1 : 0);
    for (int i = 0; i < count; ++i) {
        const auto location = static_cast<GLuint>(first_location + i);
        glEnableVertexArrayAttrib(name, location);
        glVertexArrayAttribFormat(name, location, components, GL_FLOAT, GL_FALSE,
                                  static_cast<GLuint>(i * bytes));
        glVertexArrayAttribBinding(name, location, slot);
    }
}

void VertexArray::feed(int binding, const RingBuffer::Place& place, int stride) const {
    glVertexArrayVertexBuffer(handle_.name(), static_cast<GLuint>(binding), place.buffer,
                              static_cast<GLintptr>(place.offset), stride);
}

void VertexArray::hold(int binding) const {
    constexpr GLuint kMoreThanInstances = 1U << 30;
    glVertexArrayBindingDivisor(handle_.name(), static_cast<GLuint>(binding), kMoreThanInstances);
}

void VertexArray::indices(const Buffer& buffer) {
    glVertexArrayElementBuffer(handle_.name(), buffer.name());
}

void VertexArray::draw(const RingBuffer::Place& draws) const {
    draw(GL_TRIANGLES, draws);
}

void VertexArray::draw_points(const RingBuffer::Place& draws) const {
    glEnable(GL_PROGRAM_POINT_SIZE);
    draw(GL_POINTS, draws);
    glDisable(GL_PROGRAM_POINT_SIZE);
}

void VertexArray::draw(unsigned primitive, const RingBuffer::Place& draws) const {
    static_assert(sizeof(Draw) == 5 * sizeof(std::uint32_t));
    glBindVertexArray(handle_.name());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draws.buffer);
    glMultiDrawElementsIndirect(primitive, GL_UNSIGNED_SHORT,
                                reinterpret_cast<const void*>(draws.offset),
                                static_cast<GLsizei>(draws.size / sizeof(Draw)), 0);
}

void VertexArray::bind() const {
    glBindVertexArray(handle_.name());
}

}  // namespace relevo::gl
