#include "scene/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "scene/scene.h"

// A sheet is an orthographic map and not a perspective picture from above, in which summits are
// moved outwards and the scale depends on height.
namespace relevo::scene {
namespace {

/// Sides of A0 to A4 [mm]. Source: ISO 216.
constexpr std::array<double, 6> kSides_mm = {1189, 841, 594, 420, 297, 210};
constexpr double kMmPerInch = 25.4;
constexpr int kLeastMap_px = 16;
constexpr double kMostBytes = 1 << 30;

/// Short and long side [mm].
glm::dvec2 sides_mm(const Sheet& sheet) {
    const auto size = static_cast<std::size_t>(sheet.paper[1] - '0');
    return {kSides_mm[size + 1], kSides_mm[size]};
}

/// How much larger than on A4 letters and edges are.
double growth(const Sheet& sheet) {
    return std::sqrt(sides_mm(sheet).x / kSides_mm.back());
}

/// Of the map of all cells, at the middle: sides in units of the CRS, and of those units on the
/// ellipsoid [m].
struct Ground {
    MapArea all;
    glm::dvec2 unit_m;

    explicit Ground(const dem::Grid& grid) : all(map_area(grid, 0, {1, 1})) {
        constexpr double kStep = 1e-4;  // of the sides
        const glm::dvec2 step = kStep * sides(), middle = this->middle();
        const auto place = [&](const glm::dvec2& point) {
            const glm::dvec2 post = grid.affine().inverse(point);
            return grid.place(post.x, post.y);
        };
        geo::Geodetic origin = place(middle);
        origin.height_m = 0;
        const geo::LocalFrame frame(origin);
        const auto length_m = [&](const glm::dvec2& way) {
            geo::Geodetic from = place(middle - way), to = place(middle + way);
            from.height_m = to.height_m = 0;
            return glm::distance(frame.to_local(from), frame.to_local(to));
        };
        unit_m = {length_m({step.x, 0}) / (2 * step.x), length_m({0, step.y}) / (2 * step.y)};
        if (!(unit_m.x > 0 && unit_m.y > 0))
            bad_input("--sheet: the middle of the DEM is no place on the Earth; use --crop");
    }
    glm::dvec2 sides() const { return {all.pixel_x, all.pixel_y}; }
    glm::dvec2 middle() const { return all.point({0.5, 0.5}); }
    glm::dvec2 sides_m() const { return sides() * unit_m; }
};

/// Side of a pixel on the ground [m].
double pixel_m(double scale, double dpi) {
    return scale * kMmPerInch / 1000 / dpi;
}

}  // namespace

bool is_pdf(const std::filesystem::path& path) {
    return lower(path.extension().string()) == ".pdf";
}

void check_sheet(const Scene& scene, const std::filesystem::path& output) {
    const Sheet& sheet = scene.sheet;
    if (!sheet.is_on()) {
        if (is_pdf(output))
            bad_input(fmt::format("{}: only map sheets can be pdf; add --sheet a4, or name a png",
                                  printable(output.string())));
        if (sheet.scale > 0) bad_input("--map-scale: needs --sheet, such as --sheet a3");
        if (sheet.dpi != Sheet().dpi) bad_input("--dpi: needs --sheet, such as --sheet a3");
        return;
    }
    if (lower(output.extension().string()) == ".exr")
        bad_input("--sheet: exr has linear light without stamps; name a png, tif, jpg or pdf");
    if (!scene.ortho || !scene.stamps.margin)
        bad_input("--sheet: needs --ortho and --margin, which a scene or job sets to false");
    if (scene.resolution > 0)
        bad_input("--sheet and --resolution exclude each other; use --map-scale and --dpi");
    if (is_pdf(output) && scene.transparent)
        bad_input("--transparent: not in a pdf; name a png or tif");
}

glm::dvec2 sheet_mm(const Sheet& sheet, const dem::Grid& grid) {
    glm::dvec2 mm = sides_mm(sheet);
    const glm::dvec2 ground_m = Ground(grid).sides_m();
    const bool lies = sheet.paper.ends_with("landscape") ||
                      (!sheet.paper.ends_with("portrait") && ground_m.x > ground_m.y);
    if (lies) std::swap(mm.x, mm.y);
    return mm;
}

glm::ivec2 sheet_px(const Sheet& sheet, const dem::Grid& grid) {
    const glm::dvec2 mm = sheet_mm(sheet, grid);
    const glm::dvec2 px = glm::round(mm / kMmPerInch * sheet.dpi);
    if (3 * px.x * px.y > kMostBytes)
        bad_input(fmt::format(
            "--dpi: {:g} dpi make {:.0f} x {:.0f} px, more than 1 GiB; use at most {:.0f}",
            sheet.dpi, px.x, px.y,
            std::floor(std::sqrt(kMostBytes / 3 / mm.x / mm.y) * kMmPerInch)));
    return glm::ivec2(px);
}

double sheet_unit_px(const Sheet& sheet) {
    return 0.7 / 72 * sheet.dpi * growth(sheet);
}

double sheet_edge_px(const Sheet& sheet) {
    return 5 / kMmPerInch * sheet.dpi * growth(sheet);
}

double fitting_scale(const dem::Grid& grid, double dpi, const glm::ivec2& room_px) {
    const glm::dvec2 all = Ground(grid).sides_m() / (glm::dvec2(room_px) * pixel_m(1, dpi));
    const double least = std::max(all.x, all.y) * (1 - 1e-9);
    const double ten = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5})
        if (factor * ten >= least) return std::max(factor * ten, 1.0);
    return std::max(10 * ten, 1.0);
}

glm::ivec2 sheet_map_px(const dem::Grid& grid, double scale, double dpi,
                        const glm::ivec2& room_px) {
    const glm::dvec2 all = glm::floor(Ground(grid).sides_m() / pixel_m(scale, dpi) + 1e-6);
    if (std::min(all.x, all.y) < kLeastMap_px)
        bad_input(fmt::format(
            "--map-scale: {} makes a map of {:.0f} x {:.0f} px; {} fills the sheet",
            scale_text(scale), all.x, all.y, scale_text(fitting_scale(grid, dpi, room_px))));
    const glm::dvec2 size = glm::min(all, glm::dvec2(room_px));
    const double post_px = all.x / std::max(grid.columns(), grid.rows());
    if (const double least = std::min(size.x, size.y); least < post_px)
        bad_input(
            fmt::format("--map-scale: {} shows less than a post of the DEM; use {:.0f} or more",
                        scale_text(scale), std::ceil(scale * post_px / least)));
    return glm::ivec2(size);
}

MapArea sheet_area(const dem::Grid& grid, double scale, double dpi, const glm::ivec2& size_px) {
    const Ground ground(grid);
    const glm::dvec2 pixel = pixel_m(scale, dpi) / ground.unit_m;
    const glm::dvec2 half = 0.5 * pixel * glm::dvec2(size_px), middle = ground.middle();
    return {middle.x - half.x, middle.y + half.y, pixel.x, pixel.y, size_px.x, size_px.y};
}

std::string scale_text(double scale) {
    std::string text = scale < 100 ? fmt::format("{:g}", scale) : fmt::format("{:.0f}", scale);
    if (text.find('.') == std::string::npos)
        for (std::size_t at = text.size(); at > 3;)
            text.insert(at -= 3, " ");
    return "1 : " + text;
}

std::string projection_text(const dem::Grid& grid) {
    if (!grid.crs().is_geographic()) return grid.crs().name();
    const double true_deg = degrees(grid.center().lat_rad);
    return fmt::format("equirectangular, true at {:.1f}°{}, {}", std::abs(true_deg),
                       true_deg < 0 ? "S" : "N", grid.crs().name());
}

}  // namespace relevo::scene
