#pragma once

#include <algorithm>

#include <glm/vec2.hpp>

#include "image/image.h"

/// Rectangles of images. Corners are upper left ones [px].
namespace relevo::session {

/// A rectangle of an image as one of its own.
template <typename T>
image::Pixels<T> cut_out(const image::Pixels<T>& whole, const glm::ivec2& corner,
                         const glm::ivec2& size) {
    image::Pixels<T> part(size.x, size.y, whole.channels);
    for (int y = 0; y < size.y; ++y)
        std::copy_n(whole.row(corner.y + y) + corner.x * whole.channels, size.x * whole.channels,
                    part.row(y));
    return part;
}

/// Puts an image into a larger one of as many channels.
template <typename T>
void put(const image::Pixels<T>& part, const glm::ivec2& corner, image::Pixels<T>& whole) {
    for (int y = 0; y < part.height; ++y)
        std::copy_n(part.row(y), part.width * part.channels,
                    whole.row(corner.y + y) + corner.x * whole.channels);
}

}  // namespace relevo::session
