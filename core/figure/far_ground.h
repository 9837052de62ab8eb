#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "dem/load.h"
#include "dem/posts.h"

namespace relevo::figure {

/// A DEM of which a tile needs only its own surroundings as posts: ground beyond is means of posts.
class FarGround {
  public:
    /// Means of so many posts a side are ground enough beyond a halo.
    /// @throws Error (Usage) where memory has no room for the means of the whole DEM
    static int means_for(const dem::Posts& posts, double halo_m, const MemoryBudget& memory);

    /// Refuses a tile that does not fit into memory with its halo: that has half of it, the means
    /// have a quarter, and what is kept of all other posts has a quarter.
    /// @throws Error (Usage) that says what to do
    static void require_room(const dem::Grid& grid, double halo_m, const dem::Window& tile,
                             const MemoryBudget& memory);
    /// Columns and rows of a halo on either side of a tile.
    static glm::ivec2 width_of(const dem::Grid& grid, double halo_m);
    /// A tile with its halo, as far as the DEM reaches.
    static dem::Window halo_of(const dem::Grid& grid, double halo_m, const dem::Window& tile);
    static constexpr std::int64_t kShareOfOthers = 4;  ///< the fourth part

    /// Takes the means that a plan has kept, or finds them.
    /// @param paths, options  of the DEM
    /// @param posts           all of it; outlives this
    /// @param is_planned      the folder's plan is of this DEM, and so are the means that it keeps
    FarGround(const std::vector<std::string>& paths, const dem::LoadOptions& options,
              const dem::Posts& posts, double halo_m, const std::filesystem::path& folder,
              bool is_planned);

    /// Keeps the means for other tasks.
    void write(const std::filesystem::path& folder) const;

    /// A tile with its halo.
    struct Site {
        std::shared_ptr<const dem::Heightfield> field;
        std::optional<dem::Posts> posts;  ///< in the means, unless the site is all of the DEM
        dem::Window tile;                 ///< of these posts
    };
    /// Reads what the last site does not have.
    Site site_of(const dem::Window& tile);

    /// "ground beyond 8 km of a tile is means of 12 x 12 posts".
    std::string description() const;
    /// Memory of means, and of a site around a tile with what sweeps keep of it [bytes].
    double kept_bytes(const dem::Window& tile) const;

  private:
    Array2d<float> read_site(const dem::Window& site) const;

    const dem::Posts& posts_;
    dem::Source source_;
    double halo_m_;
    int means_;
    std::unique_ptr<const dem::Heightfield> field_;  // of means
    std::shared_ptr<const dem::Posts> around_;
    std::shared_ptr<const dem::Heightfield> last_;  // of site_of()
    dem::Window last_site_;
};

}  // namespace relevo::figure
