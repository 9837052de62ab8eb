#include "names/ground_name.h"

#include <string_view>

#include "names/summit_top.h"

namespace relevo::names {
namespace {

constexpr double kNearest_m = 50000;

/// The largest entry on a grid whose size is known; null: none.
const Entry* largest_on(const Gazetteer& gazetteer, Kind kind, const dem::Grid& grid) {
    const Entry* largest = nullptr;
    for (const Entry* entry : gazetteer.within(kind, around(grid)))
        if (entry->size && (!largest || *entry->size > *largest->size) && is_on(grid, entry->place))
            largest = entry;
    return largest;
}

}  // namespace

std::string ground_name(const Gazetteer& gazetteer, const dem::Grid& grid) {
    std::string name;
    for (const Kind kind : {Kind::Place, Kind::Summit})
        if (const Entry* const entry = largest_on(gazetteer, kind, grid))
            name += (name.empty() ? "" : " – ") + std::string(entry->name);
    if (!name.empty()) return name;
    const Entry* const nearest = gazetteer.nearest_place({grid.center(), kNearest_m});
    return nearest ? "Near " + std::string(nearest->name) : std::string();
}

}  // namespace relevo::names
