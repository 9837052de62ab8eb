#include "figure/about.h"

#include <fmt/format.h>

namespace relevo::figure {

output::RasterMetadata metadata_of(const Figure& figure, const dem::Posts& posts,
                                   const std::string& version, const PartMade& made,
                                   const dem::Window& window) {
    output::RasterMetadata about{
        {"TIFFTAG_SOFTWARE", "Relevo " + version},
        {"DEFINITION", made.definition},
        {"DEM", posts.about().path},
        {"TERRESTRIAL_REFRACTION", fmt::format("{:.4g}", figure.terrestrial_refraction)},
        {"HOLES", fmt::format("{}", made.holes)}};
    const dem::TileReport& tiles = posts.about().tiles;
    if (tiles.missing.count > 0)
        about.emplace_back("TILES_MISSING",
                           fmt::format("{} of {}", tiles.missing.text(), tiles.tiles));
    if (tiles.broken.count > 0)
        about.emplace_back("TILES_BROKEN",
                           fmt::format("{} of {}", tiles.broken.text(), tiles.tiles));
    if (window != dem::Window{0, 0, posts.grid().columns(), posts.grid().rows()})
        about.emplace_back(
            "CLIP",
            fmt::format("columns {} to {} and rows {} to {} of the DEM, from 0", window.column,
                        window.end_column() - 1, window.row, window.end_row() - 1));
    return about;
}

}  // namespace relevo::figure
