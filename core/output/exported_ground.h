#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "dem/fill_holes.h"
#include "dem/heightfield.h"
#include "dem/source.h"

namespace relevo::output {

/// A DEM as pictures show it, for files of other programs.
struct ExportedGround {
    /// Columns run eastwards, rows southwards (dem::north_up_of). Small voids are filled, the
    /// others NaN; heights are exaggerated, those of the description are not.
    dem::Heightfield field;
    glm::ivec2 dem_posts{0};  ///< columns and rows of the DEM, in that order
    double exaggeration = 1;
    std::int64_t voids = 0;    ///< posts of `field` that have no height
    std::string holes_text{};  ///< what became of voids; empty without any
};

struct ExportOptions {
    dem::Holes holes = dem::Holes::Fill;
    double exaggeration = 1;
    /// Columns and rows of the result; none: those of the DEM. Fewer than the DEM's are means over
    /// equal parts of it, more are bilinear between its first and its last posts.
    std::optional<glm::ivec2> size{};
    std::string remedy{};  ///< of a DEM that does not fit into memory: "--size 4097x4097"
};

/// Reads a DEM, all of its posts unless fewer are asked for: nothing is averaged unasked.
/// @throws Error (BadInput) as dem::load(), and for more posts than `how` keeps
ExportedGround read_ground(const dem::Source& source, const dem::LoadOptions& how,
                           const ExportOptions& options);

/// A field on the same ground with another number of posts, from the first to the last: bilinear;
/// the nearest height where a void takes part.
dem::Heightfield stretched(const dem::Heightfield& field, const glm::ivec2& size);

}  // namespace relevo::output
