#include "output/exported_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "dem/load.h"
#include "dem/north_up.h"

namespace relevo::output {
namespace {

glm::ivec2 swapped(const glm::ivec2& size) {
    return {size.y, size.x};
}

void check_memory(const std::string& path, const glm::ivec2& size, const dem::LoadOptions& how,
                  const std::string& remedy) {
    const std::int64_t posts = std::int64_t{size.x} * size.y;
    if (posts <= how.memory.posts) return;
    const std::int64_t wanted = MemoryBudget::mib_for_posts(posts);
    bad_input(fmt::format(
        "{}: {} x {} heights take {} MiB, expected at most {}; pass {}--crop W,S,E,N or --memory "
        "{}",
        path, size.x, size.y, wanted, how.memory.mib(), remedy.empty() ? "" : remedy + ", ",
        wanted));
}

/// Posts of the DEM, or means where a side has fewer.
dem::Heightfield read_posts(const dem::Source& source, const glm::ivec2& posts,
                            const dem::LoadOptions& how) {
    const dem::Grid& full = source.grid();
    const dem::Window all{0, 0, full.columns(), full.rows()};
    const bool is_full = posts.x == full.columns() && posts.y == full.rows();
    dem::Heightfield field{source.read(all, posts.x, posts.y),
                           is_full ? full : full.part(all, posts.x, posts.y), source.description(),
                           1};
    field.about.statistics = dem::statistics(field.height_m);
    dem::report_heights(source, field.about,
                        is_full && field.about.statistics.valid > 0
                            ? dem::find_collar(field.height_m)
                            : std::nullopt);
    dem::check_heights(field, how);
    return field;
}

}  // namespace

ExportedGround read_ground(const dem::Source& source, const dem::LoadOptions& how,
                           const ExportOptions& options) {
    dem::refuse_endless_sides(source);
    const dem::NorthUp turn = dem::north_up_of(source.grid().affine());
    const glm::ivec2 stored(source.grid().columns(), source.grid().rows());
    const glm::ivec2 all = turn.swap ? swapped(stored) : stored;
    const glm::ivec2 size = options.size.value_or(all);
    check_memory(source.description().path, size, how, options.remedy);
    const glm::ivec2 read = glm::min(all, size);
    dem::Heightfield field = read_posts(source, turn.swap ? swapped(read) : read, how);
    ExportedGround ground{std::move(field), all, options.exaggeration};
    if (ground.field.about.statistics.holes > 0) {
        dem::FilledHoles filled = dem::fill_small_holes(ground.field.height_m, options.holes);
        ground.holes_text = filled.text(options.holes);
        if (!filled.height_m.empty()) ground.field.height_m = std::move(filled.height_m);
        log::info(fmt::format("{}: {}", printable(source.description().path), ground.holes_text));
    }
    if (turn.any()) ground.field = dem::turned(std::move(ground.field), turn);
    if (size != read) ground.field = stretched(ground.field, size);
    for (float& height_m : ground.field.height_m) {
        height_m = static_cast<float>(height_m * options.exaggeration);
        ground.voids += std::isnan(height_m);
    }
    return ground;
}

dem::Heightfield stretched(const dem::Heightfield& field, const glm::ivec2& size) {
    const int columns = field.height_m.width(), rows = field.height_m.height();
    const glm::dvec2 step(size.x > 1 ? (columns - 1.0) / (size.x - 1) : 0,
                          size.y > 1 ? (rows - 1.0) / (size.y - 1) : 0);
    dem::Affine affine = field.grid.affine();
    affine.x_column *= step.x;
    affine.y_column *= step.x;
    affine.x_row *= step.y;
    affine.y_row *= step.y;
    dem::Heightfield result{Array2d<float>(size.x, size.y),
                            dem::Grid(size.x, size.y, affine, field.grid.crs()), field.about,
                            field.reduction};
    for (int row = 0; row < size.y; ++row)
        for (int column = 0; column < size.x; ++column) {
            const glm::dvec2 at =
                glm::min(step * glm::dvec2(column, row), glm::dvec2(columns - 1, rows - 1));
            double height_m = field.height_at(at.x, at.y);
            if (std::isnan(height_m))
                height_m = field.height_m.at(static_cast<int>(std::lround(at.x)),
                                             static_cast<int>(std::lround(at.y)));
            result.height_m.at(column, row) = static_cast<float>(height_m);
        }
    return result;
}

}  // namespace relevo::output
