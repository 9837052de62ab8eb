#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dem/grid.h"
#include "names/gazetteer.h"

/// Summits of the gazetteer on the posts of a DEM.
namespace relevo::names {

/// Height of a post [m]; NaN for voids and outside the grid.
using PostHeight = std::function<double(int column, int row)>;

struct Summit {
    const Entry* entry = nullptr;
    geo::Geodetic place;    ///< a top of the DEM, or that of the entry; height 0
    bool is_moved = false;  ///< to a top of the DEM
    /// That of the entry, or else of the DEM's top [m]; nullopt: neither is known.
    std::optional<double> height_m;
    bool height_is_of_dem = false;
};

/// "Serles 2717 m", "Mount Adams ~3732 m" with a height of the DEM, or the name alone.
std::string label(const Summit& summit);

/// An entry, moved to a top of the DEM by steepest ascent from the highest post within 100 m. It
/// stays where the ascent ends at the DEM's edge or a void, or too far away: beyond 150 m or two
/// posts; of the sources N and O, which are coarse, beyond 600 m or at a height that differs by 60
/// m or more. Posts more than 200 m apart show no tops, and nothing is moved.
/// Accuracy: data/README.md; measured in tests/names/test_summit_top.cpp.
Summit on_top(const Entry& entry, const dem::Grid& grid, const PostHeight& height_m);

/// Summits on a DEM and within a distance. Of several that were moved to one top, one stays there:
/// that with a height, else the nearest.
std::vector<Summit> summits_on(const Gazetteer& gazetteer, const dem::Grid& grid,
                               const PostHeight& height_m, const Near& near);

/// Whether a place is on the cells of a grid.
bool is_on(const dem::Grid& grid, const geo::Geodetic& place);

/// A circle around the grid.
Near around(const dem::Grid& grid);

}  // namespace relevo::names
