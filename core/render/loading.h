#pragma once

namespace relevo::render {

/// Whether a frame waits for the tile pages that it needs (Wait), or draws coarser ground while
/// missing ones are made in the background.
enum class Loading { Wait, Background };

}  // namespace relevo::render
