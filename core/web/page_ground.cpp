#include "web/page_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "dem/posts.h"
#include "light/raster/horizons.h"
#include "output/exported_ground.h"
#include "web/height_planes.h"
#include "web/site.h"

namespace relevo::web {
namespace {

using nlohmann::ordered_json;

/// Steps of heights: those of whole metres, else a fraction of the posts' spacing.
double step_m(const dem::Heightfield& ground) {
    const glm::dvec2 spacing_m = ground.grid.post_spacing_m();
    const bool whole = std::ranges::all_of(
        ground.height_m, [](float h) { return std::isnan(h) || h == std::round(h); });
    return whole ? 1 : std::min(spacing_m.x, spacing_m.y) / 200;
}

/// How far heights in steps are off, at most.
double worst_m(const Heights& heights, const Array2d<float>& height_m) {
    double worst = 0;
    for (std::size_t i = 0; i < height_m.size(); ++i)
        if (heights.value.begin()[i] != kVoid)
            worst =
                std::max(worst, std::abs(heights.min_m + heights.step_m * heights.value.begin()[i] -
                                         height_m.begin()[i]));
    return worst;
}

/// The sky-view factor, 0 to 255, of every second post; open where there is none.
std::vector<std::byte> sky_view(const dem::Heightfield& half) {
    const dem::Posts posts(half);
    const light::SkyView sky = light::sky_view(posts, {.of_open_slope = true});
    std::vector<std::byte> bytes;
    std::ranges::transform(sky.share, std::back_inserter(bytes), [](float share) {
        return static_cast<std::byte>(std::isnan(share) ? 255 : std::lround(255 * share));
    });
    return bytes;
}

std::vector<std::byte> little_endian(std::span<const std::int16_t> values) {
    std::vector<std::byte> bytes;
    for (const std::int16_t value : values)
        for (const int shift : {0, 8})
            bytes.push_back(static_cast<std::byte>(static_cast<unsigned>(value) >> shift));
    return bytes;
}

}  // namespace

void check_grid(const dem::Grid& grid) {
    const glm::dvec2 sides_m = grid.sides_m();
    const double longest_m = std::max(sides_m.x, sides_m.y);
    if (longest_m > kLongest_m)
        bad_input(
            fmt::format("export web: the DEM is {:.0f} km long, expected at most {:.0f} km; pass "
                        "--crop W,S,E,N",
                        longest_m / 1000, kLongest_m / 1000));
    const dem::Affine& at = grid.affine();
    const bool along = at.x_row == 0 && at.y_column == 0,
               across = at.x_column == 0 && at.y_row == 0;
    if (!along && !across)
        bad_input(
            "export web: the rows of the DEM are turned against its CRS; warp it with gdalwarp "
            "first");
}

double bytes_of(const dem::Heightfield& ground) {
    constexpr double kSkyView = 0.25;  // of what heights take
    const Heights heights = in_steps(ground.height_m, step_m(ground));
    return (1 + kSkyView) *
           static_cast<double>(deflated("heights", planes_of(heights.value)).stored.size());
}

double PageGround::bytes() const {
    double sum = 0;
    for (const Block& block : blocks)
        sum += static_cast<double>(block.stored.size());
    return sum;
}

PageGround page_ground(const dem::Heightfield& ground, const FarHorizons* far) {
    const Heights heights = in_steps(ground.height_m, step_m(ground));
    const int columns = heights.value.width(), rows = heights.value.height();
    const glm::dvec2 spacing_m = ground.grid.post_spacing_m();
    const dem::Heightfield half =
        output::stretched(ground, {std::max(2, columns / 2), std::max(2, rows / 2)});
    const double error_m = worst_m(heights, ground.height_m);
    ordered_json about{
        {"size", {columns, rows}},
        {"step_m", {spacing_m.x, spacing_m.y}},
        {"height", {{"min", heights.min_m}, {"step", heights.step_m}, {"error", error_m}}},
        {"crs", ground.grid.crs().text()},
        {"transform", ground.grid.affine().geotransform()},
        {"grid", ordered_json::parse(grid_json(ground.grid))},
        {"sky_view", {{"columns", half.height_m.width()}, {"rows", half.height_m.height()}}}};
    PageGround page{ground.grid, error_m, {}, {}};
    page.blocks = {deflated("heights", planes_of(heights.value)),
                   deflated("sky_view", sky_view(half))};
    if (far) {
        about["far"] = {{"columns", FarHorizons::kNodes},
                        {"rows", FarHorizons::kNodes},
                        {"azimuths", FarHorizons::kAzimuths},
                        {"nearest_m", FarHorizons::kNearest_m},
                        {"step", FarHorizons::kStep}};
        page.blocks.push_back(deflated("far", little_endian(far->hundredths)));
        page.blocks.push_back(deflated("far_steps", std::as_bytes(std::span(far->steps))));
    }
    page.about = about.dump();
    return page;
}

}  // namespace relevo::web
