#include "gl/buffer.h"

#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/errors.h"

namespace relevo::gl {
namespace {

unsigned create(std::size_t size, const void* bytes, std::string_view label) {
    GLuint name = 0;
    expect_no_error(label);
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(size), bytes, GL_DYNAMIC_STORAGE_BIT);
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR && size > 0) {
        glDeleteBuffers(1, &name);
        failed(
            fmt::format("GL buffer: {}: the device has no {:.1f} MiB for it ({}); take a device "
                        "with more",
                        label, static_cast<double>(size) / (1 << 20), error_name(error)));
    }
    set_label(GL_BUFFER, name, label);
    return name;
}

}  // namespace

void Buffer::destroy(unsigned name) {
    glDeleteBuffers(1, &name);
}

Buffer::Buffer(std::size_t size, std::string_view label)
    : handle_(create(size, nullptr, label)), size_(size) {}

Buffer::Buffer(std::span<const std::byte> bytes, std::string_view label)
    : handle_(create(bytes.size(), bytes.data(), label)), size_(bytes.size()) {}

void Buffer::write(std::span<const std::byte> bytes, std::size_t offset) {
    assert(offset + bytes.size() <= size_);
    glNamedBufferSubData(name(), static_cast<GLintptr>(offset),
                         static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void Buffer::read(std::span<std::byte> bytes, std::size_t offset) const {
    assert(offset + bytes.size() <= size_);
    glGetNamedBufferSubData(name(), static_cast<GLintptr>(offset),
                            static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void Buffer::bind_uniform(unsigned binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, name());
}

void Buffer::bind_storage(unsigned binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name());
}

void Buffer::fill(float value) {
    glClearNamedBufferData(name(), GL_R32F, GL_RED, GL_FLOAT, &value);
}

void BufferTexture::destroy(unsigned name) {
    glDeleteTextures(1, &name);
}

BufferTexture::BufferTexture(const Buffer& buffer, PixelFormat format, std::string_view label) {
    assert(format == PixelFormat::R32F || format == PixelFormat::R32UI);
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
    handle_ = Handle<&BufferTexture::destroy>(name);
    set_label(GL_TEXTURE, name, label);
    glTextureBuffer(name, format == PixelFormat::R32F ? GL_R32F : GL_R32UI, buffer.name());
}

void BufferTexture::bind(unsigned unit) const {
    glBindTextureUnit(unit, name());
}

}  // namespace relevo::gl
