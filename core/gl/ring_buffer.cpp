#include "gl/ring_buffer.h"

#include <algorithm>
#include <cstring>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/errors.h"

namespace relevo::gl {
namespace {

constexpr std::size_t kLeastPart_bytes = 16384;
constexpr std::size_t kWritesInPart = 8;  // of the size that made it grow
constexpr auto kPatience = std::chrono::milliseconds(1000);

std::size_t rounded_up(std::size_t value, std::size_t step) {
    return (value + step - 1) / step * step;
}

}  // namespace

void RingBuffer::Place::bind_uniform(unsigned binding) const {
    glBindBufferRange(GL_UNIFORM_BUFFER, binding, buffer, static_cast<GLintptr>(offset),
                      static_cast<GLsizeiptr>(size));
}

RingBuffer::Place RingBuffer::write(std::span<const std::byte> bytes, std::size_t alignment) {
    // Offsets of any alignment are counted from the buffer's beginning.
    const auto begin = [&] { return rounded_up(part_ * part_bytes_ + used_, alignment); };
    const std::size_t needed = bytes.size() + alignment;
    if (needed > part_bytes_)
        grow(kWritesInPart * needed);
    else if (begin() + bytes.size() > (part_ + 1) * part_bytes_)
        turn();
    const std::size_t offset = begin();
    std::memcpy(mapped_ + offset, bytes.data(), bytes.size());
    used_ = offset + bytes.size() - part_ * part_bytes_;
    return {handle_.name(), offset, bytes.size()};
}

std::size_t RingBuffer::uniform_alignment() {
    GLint alignment = 1;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    return static_cast<std::size_t>(std::max(alignment, 1));
}

void RingBuffer::grow(std::size_t part_bytes) {
    // The device keeps the memory of a deleted buffer for as long as it reads it.
    part_bytes_ = std::max(part_bytes, kLeastPart_bytes);
    part_ = used_ = 0;
    left_ = {};
    constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto size = static_cast<GLsizeiptr>(kParts * part_bytes_);
    expect_no_error(label_);
    GLuint name = 0;
    glCreateBuffers(1, &name);
    handle_ = Handle<&RingBuffer::destroy>(name);
    glNamedBufferStorage(name, size, nullptr, kAccess);
    mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(name, 0, size, kAccess));
    if (glGetError() != GL_NO_ERROR || !mapped_)
        failed(
            fmt::format("GL buffer: {}: the device has no {:.1f} MiB for it; take a device "
                        "with more",
                        label_, static_cast<double>(size) / (1 << 20)));
    set_label(GL_BUFFER, name, label_);
}

void RingBuffer::turn() {
    left_[part_] = Fence::insert();
    part_ = (part_ + 1) % kParts;
    used_ = 0;
    // Commands of the same frame may read a part after it was left. The fence before the last one
    // is behind those that read this part.
    const Fence& behind = left_[(part_ + kParts - 2) % kParts];
    while (!behind.wait(kPatience)) {
    }
}

void RingBuffer::destroy(unsigned name) {
    glDeleteBuffers(1, &name);
}

}  // namespace relevo::gl
