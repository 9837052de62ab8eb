#pragma once

namespace relevo::render {

/// Whether a frame waits for the pages of the ground that it needs, or has coarser ground where
/// they are missing, while they are made beside it.
enum class Loading { Wait, Beside };

}  // namespace relevo::render
