#include "session/land_cover.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "climate/land_cover.h"
#include "dem/surface.h"

namespace relevo::session {
namespace {

using climate::Classes;
using climate::LandCoverTable;

LandCoverTable guessed_table(const std::string& file, const Classes& in_map) {
    const std::vector<std::string> names = LandCoverTable::fitting(in_map);
    if (names.empty()) {
        std::string lacks;
        for (const std::string& name : LandCoverTable::names())
            lacks += fmt::format("; {} has no class {}", name,
                                 climate::text_of(in_map & ~LandCoverTable::named(name).classes()));
        bad_input(fmt::format("{}: what are its classes? --land-cover-classes NAME|FILE says it{}",
                              printable(file), lacks));
    }
    if (names.size() > 1)
        bad_input(
            fmt::format("{}: its classes may be those of {}; --land-cover-classes NAME says which",
                        printable(file), fmt::join(names, " and of ")));
    const std::string& name = names.front();
    log::info(
        fmt::format("{}: classes are taken to be those of {}; --land-cover-classes names others",
                    printable(file), name));
    return LandCoverTable::named(name);
}

LandCoverTable table_of(const scene::LandCover& asked) {
    const Classes in_map = overlay::classes_of(asked.file);
    if (asked.classes.empty()) return guessed_table(asked.file, in_map);
    LandCoverTable table = scene::names_file(asked.classes) ? LandCoverTable::read(asked.classes)
                                                            : LandCoverTable::named(asked.classes);
    if (const Classes unknown = in_map & ~table.classes(); unknown.any())
        log::warning(fmt::format("{}: {} has no class {}; the climate says what grows there",
                                 printable(asked.file), printable(asked.classes),
                                 climate::text_of(unknown)));
    return table;
}

std::uint32_t texel_of(dem::SurfaceKind kind, std::uint8_t house) {
    using enum dem::SurfaceKind;
    if (kind == Street) return 0xff00;
    if (kind == Canopy) return 0xff0000;
    return kind == Roof || kind == Wall ? 0xff | std::uint32_t{house} << 24 : 0;
}

}  // namespace

std::shared_ptr<const overlay::Photo> open_land_cover(const scene::LandCover& asked,
                                                      const dem::Grid& grid) {
    if (asked.file.empty()) {
        if (!asked.classes.empty())
            bad_input("--land-cover-classes: there is no map; --land-cover FILE sets one");
        return nullptr;
    }
    return overlay::Photo::open_classes(asked.file, grid, table_of(asked).texels());
}

void check_houses(const LoadedDem& dem) {
    const glm::dvec2 posts_m = dem.to_draw().grid.post_spacing_m();
    const double apart_m = std::sqrt(posts_m.x * posts_m.y);
    if (apart_m > dem::kSurfacePosts_m)
        bad_input(fmt::format(
            "--surface: heights are {:.3g} m apart in memory; houses show where "
            "they are at most {:g} m apart{}",
            apart_m, dem::kSurfacePosts_m,
            dem.to_draw().reduction > 1 ? "; --memory or --crop has more of them" : ""));
}

std::shared_ptr<const render::OverlayRaster> houses_on(const LoadedDem& dem) {
    check_houses(dem);
    const dem::Heightfield& field = dem.to_draw();
    const dem::Surface found = dem::find_surface(field.height_m, field.grid);
    auto raster = std::make_shared<render::OverlayRaster>();
    raster->rgba = Array2d<std::uint32_t>(field.height_m.width(), field.height_m.height());
    std::ranges::transform(found.kind, found.house, raster->rgba.begin(), texel_of);
    return raster;
}

}  // namespace relevo::session
