#include "dem/load.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "dem/frame.h"

namespace relevo::dem {

Heightfield load(const std::string& path, const LoadOptions& options) {
    return load(std::span(&path, 1), options);
}

Heightfield load(std::span<const std::string> paths, const LoadOptions& options) {
    const Source source = Source::open(paths, options);
    const Grid& full = source.grid();
    const Window all{0, 0, full.columns(), full.rows()};
    Description about = source.description();

    int columns = all.columns;
    int rows = all.rows;
    const double posts = static_cast<double>(columns) * rows;
    if (posts > static_cast<double>(options.max_posts)) {
        const double factor = std::sqrt(posts / static_cast<double>(options.max_posts));
        columns = std::clamp(static_cast<int>(columns / factor), 2, columns);
        rows = std::clamp(static_cast<int>(rows / factor), 2, rows);
        about.assumptions.push_back(fmt::format(
            "reduced from {} x {} to {} x {} posts, means of {:.1f} x {:.1f}, to keep "
            "within the memory allowed",
            all.columns, all.rows, columns, rows, all.columns / static_cast<double>(columns),
            all.rows / static_cast<double>(rows)));
    }
    Array2d<float> height_m = source.read(all, columns, rows);
    about.statistics = statistics(height_m);
    const Statistics& s = about.statistics;
    if (s.valid == 0)
        bad_input(fmt::format(
            "dem::load: {}: not one valid height, all {} posts are holes{}", about.path, s.holes,
            about.nodata ? fmt::format(" (nodata {})", about.nodata_text()) : ""));
    const auto guess = [&](const std::string& sentence) {
        about.assumptions.push_back(sentence);
        about.guesses.push_back(sentence);
        log::info(fmt::format("{}: {}", about.path, sentence));
    };
    if (s.outliers > 0)
        guess(
            fmt::format("{} heights are below -11500 m or above 9000 m, which the Earth has not, "
                        "and are drawn as they are; --nodata V makes V a hole, --unit sets the "
                        "unit",
                        s.outliers));
    if (const std::optional<Frame> frame = find_frame(height_m))
        guess(
            fmt::format("the edge is {:g} m all around and the ground beside it {:.0f} m off, "
                        "perhaps what is left around a turned raster; --nodata {:g} makes it a "
                        "hole",
                        frame->height_m, frame->step_m,
                        (static_cast<double>(frame->height_m) - about.offset) / about.scale /
                            about.unit.metres));
    Grid grid = columns == all.columns && rows == all.rows ? full : full.part(all, columns, rows);
    return {std::move(height_m), std::move(grid), std::move(about)};
}

}  // namespace relevo::dem
