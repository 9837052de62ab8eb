#include "viewer/import_preview.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "dem/heightfield.h"
#include "dem/load.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// More cells would be read too slowly for a preview: some seconds.
constexpr double kMostCells = 2e8;

/// Light from the north-west, 45 degrees high, as maps are shaded.
const glm::dvec3 kToLight = normalize(glm::dvec3(-1, 1, std::sqrt(2.0)));

/// Share of the light on a post, 0 to 1; NaN in voids.
/// @param spacing_m  eastwards of columns, southwards of rows
double shade(const Array2d<float>& height_m, int column, int row, glm::dvec2 spacing_m) {
    const auto at = [&](int c, int r) {
        return double{height_m.at(std::clamp(c, 0, height_m.width() - 1),
                                  std::clamp(r, 0, height_m.height() - 1))};
    };
    const double east = (at(column + 1, row) - at(column - 1, row)) / (2 * spacing_m.x);
    const double south = (at(column, row + 1) - at(column, row - 1)) / (2 * spacing_m.y);
    return std::max(0.0, dot(normalize(glm::dvec3(-east, south, 1)), kToLight));
}

/// RGBA of a field; transparent in voids. Slopes are made steeper as the ground is larger.
image::Image8 shaded(const dem::Heightfield& field) {
    const Array2d<float>& height_m = field.height_m;
    const double relief_m = double{field.about.statistics.max_m} - field.about.statistics.min_m;
    const glm::dvec2 spacing_m = field.grid.post_spacing_m();
    const double side_m = std::max(spacing_m.x * height_m.width(), spacing_m.y * height_m.height());
    const double steeper = std::clamp(0.15 * side_m / std::max(relief_m, 1.0), 1.0, 20.0);
    const bool is_south_up =
        field.grid.place(0, 0).lat_rad < field.grid.place(0, field.grid.rows() - 1).lat_rad;
    const glm::dvec2 steps_m =
        glm::dvec2(spacing_m.x, is_south_up ? -spacing_m.y : spacing_m.y) / steeper;
    image::Image8 picture(height_m.width(), height_m.height(), 4);
    for (int row = 0; row < picture.height; ++row)
        for (int column = 0; column < picture.width; ++column) {
            const double light = shade(height_m, column, row, steps_m);
            std::uint8_t* const pixel =
                picture.row(is_south_up ? picture.height - 1 - row : row) + 4 * column;
            if (std::isnan(light) || std::isnan(height_m.at(column, row))) continue;
            std::fill_n(pixel, 3, static_cast<std::uint8_t>(std::lround(40 + 215 * light)));
            pixel[3] = 255;
        }
    return picture;
}

/// "3600 x 3600 posts, 76.1 x 111 km" and so on.
std::string words_of(const dem::Source& source, const dem::Heightfield& field) {
    const dem::Grid& grid = source.grid();
    const glm::dvec2 extent_m = grid.extent_m();
    const geo::Geodetic middle = grid.place((grid.columns() - 1) / 2.0, (grid.rows() - 1) / 2.0);
    std::string text = tr_format(
        "{} x {} posts, {:.3g} x {:.3g} km\n{}\n{}\nheights {:.0f} to {:.0f} m", grid.columns(),
        grid.rows(), extent_m.x / 1000, extent_m.y / 1000, grid.crs().name(), where_text(middle),
        field.about.statistics.min_m, field.about.statistics.max_m);
    for (const std::string& assumption : source.description().assumptions)
        text += "\n" + assumption;
    return text;
}

dem::Heightfield coarse_field(const dem::Source& source, int side_px) {
    const dem::Grid& grid = source.grid();
    const int side = std::max(grid.columns(), grid.rows());
    const double reduction = std::max(1.0, static_cast<double>(side) / side_px);
    if (source.cells_for_means(static_cast<int>(reduction)) > kMostCells)
        bad_input(tr("no preview: the file is large and has no overviews; it can be opened"));
    const auto part = [&](int posts) {
        return std::max(1, static_cast<int>(std::lround(posts / reduction)));
    };
    const int columns = part(grid.columns()), rows = part(grid.rows());
    const relevo::Window window{0, 0, grid.columns(), grid.rows()};
    dem::Heightfield field{.height_m = source.read(window, columns, rows),
                           .grid = grid.part(window, columns, rows),
                           .about = source.description()};
    field.about.statistics = dem::statistics(field.height_m);
    if (field.about.statistics.valid == 0) bad_input(tr("not one post has a height"));
    return field;
}

}  // namespace

std::shared_ptr<const Preview> preview_of(const PreviewWanted& wanted) {
    auto preview = std::make_shared<Preview>();
    preview->of = wanted;
    try {
        const dem::Source source = dem::Source::open(wanted.files, wanted.options);
        const dem::Heightfield field = coarse_field(source, wanted.side_px);
        preview->text = words_of(source, field);
        preview->picture = shaded(field);
    } catch (const std::exception& error) {  // also for want of memory
        preview->error = error.what();
    }
    return preview;
}

PreviewWork::PreviewWork(std::function<void()> on_change)
    : LatestWork(std::move(on_change), [](const PreviewWanted& of, const PreviewWanted& now) {
          return of.files == now.files;
      }) {}

void PreviewWork::work_out(const PreviewWanted* wanted) {
    if (!wanted) return;
    const std::shared_ptr<const Preview> preview = preview_of(*wanted);
    publish(preview, /*done=*/true);
    if (preview->error.empty() || !wanted->options.crs.empty()) return;
    auto suggesting = std::make_shared<Preview>(*preview);
    try {
        suggesting->suggestions = suggest_crs({wanted->files, wanted->options}, wanted->other);
    } catch (const std::exception&) {
        return;  // without PROJ's database; the field of the CRS says so
    }
    if (!suggesting->suggestions.empty()) publish(suggesting, /*done=*/true);
}

}  // namespace relevo::viewer
