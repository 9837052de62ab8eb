#pragma once

#include <cstdint>
#include <string>

#include "base/array2d.h"

namespace relevo::dem {

/// What is done with holes where a DEM is drawn. Figures never see it.
enum class Holes {
    Fill,  ///< small ones are filled, larger ones covered in grey, those at the edge cut out
    Cut,   ///< all are cut out
    Mark,  ///< as Fill, and what is filled or covered is painted
};

/// Posts that a hole may be wide and high to be filled.
inline constexpr int kSmallHole_posts = 64;

/// What is done with ground that is less than three posts wide beside voids that are covered or cut
/// out: it would be drawn as needles.
enum class ThinGround { Kept, Dropped };

/// Values of FilledHoles::filled.
inline constexpr std::uint8_t kFilled = 1, kCovered = 2;

struct FilledHoles {
    Array2d<float> height_m;  ///< NaN in the holes that are left; empty if no post has changed
    Array2d<std::uint8_t>
        filled;  ///< kFilled or kCovered where it was, else 0; empty where none was
    std::int64_t filled_posts = 0, covered_posts = 0, cut_posts = 0;
    std::int64_t dropped_posts = 0;  ///< of thin ground: they have a height and are not drawn

    std::int64_t posts = 0;         ///< of the whole DEM
    std::int64_t worked_posts = 0;  ///< of all windows in which voids were filled

    /// "voids: 0.53 % of the DEM, drawn filled ..."; empty where all posts have a height.
    std::string text(Holes holes) const;
};

/// Fills the holes that do not reach the edge, with heights from around them: those that are no
/// more than kSmallHole_posts wide and high as ground, larger ones with a smooth cover
/// (membrane.h). If all posts around a hole have one height, within a millimetre, it gets that
/// height: a hole in a lake is water. A notch, a small hole that reaches one edge along at most an
/// eighth of it, is filled, too. For drawing alone: these heights are invented. source:
/// GDALFillNodata, inverse distance to what is nearest in each direction, smoothed twice. The time
/// grows with the posts of the DEM and of the small voids, each with 8 posts around it.
/// @param thin  Dropped: unless more than a tenth of the posts would be
FilledHoles fill_small_holes(const Array2d<float>& height_m, Holes holes,
                             ThinGround thin = ThinGround::Kept);

}  // namespace relevo::dem
