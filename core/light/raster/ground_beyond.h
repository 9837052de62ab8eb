#pragma once

#include <vector>

#include "dem/posts.h"
#include "light/point/edge_ground.h"
#include "light/raster/sun_field.h"

namespace relevo::light {

/// The edges of a DEM that the rays of a tile meet, one for each line of posts along a ray. They
/// are found among dem::Posts::thinned_m(), so that they do not depend on what of the DEM memory
/// holds.
class GroundBeyond {
  public:
    /// @param reach_m  how far beyond the tile edges matter
    GroundBeyond(const dem::Posts& posts, const SunTile& tile, double reach_m);

    /// The edges as seen from posts next to each other in a row.
    /// @param height_m    gets their heights; minus infinity where there is no edge within reach
    /// @param distance_m  gets how far off they are
    void find(int row, int column, int count, float* height_m, float* distance_m) const;

    /// What find() reads, for devices. A row of the sweep is a column of the grid for rays along
    /// columns; the edge of a post is that of the line as many posts on along this row.
    struct SweepRow {
        float distance_m;  ///< of the row: less than the edge's by how far off that is
        int line_column;   ///< where line 0 has its post
    };
    /// @param row  along the sweep, in the grid's order
    SweepRow sweep_row(int row) const {
        const auto k = static_cast<std::size_t>(row - first_row_);
        return {row_distance_m_[k], line_column_[k]};
    }
    const std::vector<float>& edge_heights_m() const { return height_m_; }
    const std::vector<float>& edge_distances_m() const { return distance_m_; }

  private:
    Edge edge_of(const dem::Posts& posts, double line, double begin_m, double end_m,
                 double step_m) const;

    Ray ray_;  // along rows of the sweep
    bool along_columns_;
    int first_row_ = 0;  // of the tile's, as the sweep goes
    std::vector<float> row_distance_m_;
    std::vector<int> line_column_;  // of each row: where line 0 of those below has its post
    int first_line_ = 0;            // columns from the reference's ray on
    std::vector<float> height_m_, distance_m_;
};

}  // namespace relevo::light
