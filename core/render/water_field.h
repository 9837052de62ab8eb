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

/// Of a node, as shaders/lib/water.glsl reads it, each 0 to 255: how far it is on the water's side
/// of the shore, which lies at 127.5 and is a post's spacing wide on each side; of that water, the
/// share that is sea, and that has heights of its floor; holes that are filled: 128, or covered:
/// 255.
using WaterTexel = std::array<std::uint8_t, 4>;

/// Water and filled holes at the nodes of a DEM's pyramid.
///
/// Where the floor is known, the shore is where the heights cross 0 between posts. Where it is not,
/// it is the contour at one half of a blurred mask, which is smooth where posts would make steps; a
/// post remains what it is. Posts without a height count as the nearest one that has a height: the
/// ground is cut half-way to them, and up to there it is what it is. Coarser levels are means with
/// weights 1 2 1 both ways, as heights are, so that water keeps its area.
class WaterField {
  public:
    /// @param heights_m  as drawn; all must outlive this
    /// @param filled     of posts that were holes, as dem::FilledHoles::filled; null for none
    /// @param reduction  posts of the pyramid's level 0 to one of these, each way
    WaterField(const Array2d<float>& heights_m, const dem::Water& water,
               const Array2d<std::uint8_t>* filled, int reduction);

    /// Of a node of a level of this DEM's own pyramid; indices beyond the rim repeat it.
    WaterTexel at(int level, int column, int row) const;

    /// Texels of the nodes of a normal page and its border, kNormalPage_px a side.
    std::vector<WaterTexel> page(const dem::Pyramid& pyramid, int level, glm::ivec2 page) const;

  private:
    WaterTexel of_post(int column, int row) const;
    std::uint8_t filled_texel(int column, int row) const;
    std::optional<dem::WaterKind> kind_around(int column, int row) const;
    double shore(int column, int row, bool wet) const;
    void make_levels();
    WaterTexel between(int level, glm::dvec2 node) const;

    const Array2d<float>& heights_m_;
    Array2d<dem::WaterKind> kind_in_voids_;  // empty where there are no voids
    const Array2d<dem::WaterKind>& kind_;
    const Array2d<std::uint8_t>* filled_;
    int reduction_;
    std::vector<Array2d<WaterTexel>> levels_;  // from level 1 on
};

}  // namespace relevo::render
