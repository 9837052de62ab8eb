#pragma once

#include <cstdint>

#include "base/window.h"
#include "dem/posts.h"

namespace relevo::dem {

/// A hash of heights and their places, for windows of a DEM whose hashes are added: the sum over
/// all posts of hash(row) * hash(column) * hash(height), modulo 2^64; holes add nothing.
/// @param view    has the window
/// @param window  of the whole DEM
std::uint64_t content_of(const Posts::View& view, const Window& window);

/// The same of posts of one height, as fast however many there are.
std::uint64_t content_of(float height_m, const Window& window);

}  // namespace relevo::dem
