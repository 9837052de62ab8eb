#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/pyramid.h"
#include "dem/water.h"

namespace relevo::render {

/// Water at a node as read by shaders/lib/water.glsl, each 0 to 255. First: signed distance to the
/// shore, which is at 127.5; 0 and 255 are one post spacing away, 255 on the water's side. Second
/// and third: fraction of the water that is sea, and that has a floor. Fourth: filled voids are
/// 128, covered voids 255.
using WaterTexel = std::array<std::uint8_t, 4>;

/// Water and filled voids at the nodes of a DEM's pyramid.
///
/// Where the floor is known, the shore is where heights cross 0 between posts. Elsewhere it is the
/// 0.5 contour of a blurred mask, which is smooth; posts keep their side. Posts without a height
/// take the kind of the nearest post that has one, because ground extends half-way to them. Coarser
/// levels are weighted means (1 2 1 along each axis) as for heights, which preserves the water's
/// area.
class WaterField {
  public:
    /// @param heights_m  as drawn; all must outlive this
    /// @param filled     as dem::FilledHoles::filled; null without filled voids
    /// @param reduction  posts of the pyramid's level 0 per post of `heights_m`, along each axis
    WaterField(const Array2d<float>& heights_m, const dem::Water& water,
               const Array2d<std::uint8_t>* filled, int reduction);

    /// Texel of a node of this field's own pyramid. Indices are clamped to its edge.
    WaterTexel at(int level, int column, int row) const;

    /// Texels of a normal tile page with its border, kNormalPage_px a side.
    std::vector<WaterTexel> page(const dem::Pyramid& pyramid, int level, glm::ivec2 page) const;

  private:
    WaterTexel of_post(int column, int row) const;
    std::uint8_t filled_texel(int column, int row) const;
    std::optional<dem::WaterKind> kind_around(int column, int row) const;
    double shore(int column, int row, bool wet) const;
    void make_levels();
    WaterTexel between(int level, glm::dvec2 node) const;

    const Array2d<float>& heights_m_;
    Array2d<dem::WaterKind> kind_in_voids_;  // empty without voids
    const Array2d<dem::WaterKind>& kind_;
    const Array2d<std::uint8_t>* filled_;
    int reduction_;
    std::vector<Array2d<WaterTexel>> levels_;  // from level 1 on
};

}  // namespace relevo::render
