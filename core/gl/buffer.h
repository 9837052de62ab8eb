#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "base/pixel_format.h"
#include "gl/handle.h"

namespace relevo::gl {

/// Memory on the device, of a size fixed when it is made.
class Buffer {
  public:
    Buffer() = default;
    /// Room for `size` bytes that write() fills.
    Buffer(std::size_t size, std::string_view label);
    /// A copy of `bytes`; write() may replace them.
    Buffer(std::span<const std::byte> bytes, std::string_view label);

    template <typename T>
    static Buffer of(std::span<const T> values, std::string_view label) {
        return Buffer(std::as_bytes(values), label);
    }

    /// Replaces the bytes from `offset` on.
    void write(std::span<const std::byte> bytes, std::size_t offset = 0);
    /// Reads bytes back; waits for the device.
    void read(std::span<std::byte> bytes, std::size_t offset = 0) const;

    void bind_uniform(unsigned binding) const;  ///< as a uniform block
    void bind_storage(unsigned binding) const;  ///< as a shader storage block
    /// Sets all of it to one number.
    void fill(float value);

    std::size_t size() const { return size_; }
    unsigned name() const { return handle_.name(); }

  private:
    static void destroy(unsigned name);
    Handle<&Buffer::destroy> handle_;
    std::size_t size_ = 0;
};

/// A view of a buffer by which samplerBuffer or usamplerBuffer reads it.
class BufferTexture {
  public:
    BufferTexture() = default;
    /// @param format  of its elements: R32F or R32UI
    /// @pre the buffer outlives this, and has at most 65536 elements, which every device takes
    BufferTexture(const Buffer& buffer, PixelFormat format, std::string_view label);

    void bind(unsigned unit) const;
    unsigned name() const { return handle_.name(); }

  private:
    static void destroy(unsigned name);
    Handle<&BufferTexture::destroy> handle_;
};

}  // namespace relevo::gl
