#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "gl/fence.h"
#include "gl/handle.h"

namespace relevo::gl {

/// Memory for data that is new in every frame or draw. The device may still read what was written
/// before: each write goes to the next part of a ring, and waits only for the device to leave that
/// part.
class RingBuffer {
  public:
    explicit RingBuffer(std::string label) : label_(std::move(label)) {}

    /// A write's place. Valid until half of the ring has been written since, or until it grows.
    struct Place {
        unsigned buffer = 0;  ///< GL name; another one than before where the ring has grown
        std::size_t offset = 0, size = 0;  ///< [bytes]

        void bind_uniform(unsigned binding) const;  ///< as a uniform block
    };
    /// Copies bytes to an offset that is a multiple of `alignment`.
    /// @throws Error (Failed) if the device has no memory for them
    Place write(std::span<const std::byte> bytes, std::size_t alignment);

    /// Of uniform blocks.
    static std::size_t uniform_alignment();

  private:
    static constexpr std::size_t kParts = 4;

    void grow(std::size_t part_bytes);
    /// Moves to the beginning of the next part.
    void turn();

    static void destroy(unsigned name);
    std::string label_;
    Handle<&RingBuffer::destroy> handle_;
    std::byte* mapped_ = nullptr;
    std::size_t part_bytes_ = 0, part_ = 0, used_ = 0;  // used: of the current part
    std::array<Fence, kParts> left_;                    // inserted when a part was left
};

}  // namespace relevo::gl
