#pragma once

#include <cstddef>
#include <cstdint>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/ring_buffer.h"

namespace relevo::gl {

/// Where a vertex program's inputs come from. The buffers must outlive it.
class VertexArray {
  public:
    VertexArray();

    /// Feeds inputs `first_location` ... from tightly packed floats, `components` each, `count`
    /// inputs interleaved. @param per_instance  one step an instance instead of one a vertex
    void attributes(int binding, const Buffer& buffer, int first_location, int count,
                    int components, bool per_instance);
    /// The same from memory that feed() names.
    void attributes(int binding, int first_location, int count, int components, bool per_instance);
    /// Inputs of a binding stay the same for all instances of a draw, which Draw::first_instance
    /// selects.
    void hold(int binding) const;
    /// @param stride  from one vertex or instance to the next [bytes]
    void feed(int binding, const RingBuffer::Place& place, int stride) const;
    void indices(const Buffer& buffer);  ///< 16-bit

    /// One draw of triangles, as glDrawElementsIndirect has it.
    struct Draw {
        std::uint32_t indices = 0, instances = 1, first_index = 0;
        std::int32_t first_vertex = 0;
        std::uint32_t first_instance = 0;
    };
    /// Draws all with one command. @param draws  written to a ring with an alignment of 4
    void draw(const RingBuffer::Place& draws) const;
    /// The same of points, whose size the vertex program sets.
    void draw_points(const RingBuffer::Place& draws) const;
    void bind() const;

  private:
    void draw(unsigned primitive, const RingBuffer::Place& draws) const;
    static void destroy(unsigned name);
    Handle<&VertexArray::destroy> handle_;
};

}  // namespace relevo::gl
