#pragma once

#include <cstddef>

#include "gl/buffer.h"
#include "gl/handle.h"

namespace relevo::gl {

/// Where a vertex program's inputs come from. The buffers must outlive it.
class VertexArray {
  public:
    VertexArray();

    /// Feeds inputs `first_location` ... from tightly packed floats, `components` each, `count`
    /// inputs interleaved. @param per_instance  one step an instance instead of one a vertex
    void attributes(int binding, const Buffer& buffer, int first_location, int count,
                    int components, bool per_instance);
    void indices(const Buffer& buffer);  ///< 16-bit
    void bind() const;

  private:
    static void destroy(unsigned name);
    Handle<&VertexArray::destroy> handle_;
};

}  // namespace relevo::gl
