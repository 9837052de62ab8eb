#include "dem/load.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"

namespace relevo::dem {

void report_heights(Description& about, const std::optional<Frame>& frame) {
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
    if (frame)
        guess(
            fmt::format("the edge is {:g} m all around and the ground beside it {:.0f} m off, "
                        "perhaps what is left around a turned raster; --nodata {:g} makes it a "
                        "hole",
                        frame->height_m, frame->step_m,
                        (static_cast<double>(frame->height_m) - about.offset) / about.scale /
                            about.unit.metres));
}

Heightfield load(const std::string& path, const LoadOptions& options) {
    return load(std::span(&path, 1), options);
}

Heightfield load(std::span<const std::string> paths, const LoadOptions& options) {
    return load(Source::open(paths, options), options.max_posts);
}

Heightfield load(const Source& source, std::int64_t max_posts) {
    const Grid& full = source.grid();
    Description about = source.description();
    int reduction = 1;
    const auto reduced_posts = [&] {
        return std::int64_t{full.columns() / reduction} * (full.rows() / reduction);
    };
    while (reduced_posts() > max_posts &&
           std::min(full.columns(), full.rows()) / (2 * reduction) >= 2)
        reduction *= 2;
    const int columns = full.columns() / reduction, rows = full.rows() / reduction;
    // What is left over at the last row and column is less than one mean.
    const Window all{0, 0, columns * reduction, rows * reduction};
    if (reduction > 1)
        about.assumptions.push_back(fmt::format(
            "reduced from {} x {} to {} x {} posts, means of {} x {}, to keep within the memory "
            "allowed",
            full.columns(), full.rows(), columns, rows, reduction, reduction));
    Array2d<float> height_m = source.read(all, columns, rows);
    about.statistics = statistics(height_m);
    report_heights(about, about.statistics.valid > 0 ? find_frame(height_m) : std::nullopt);
    Grid grid = reduction == 1 ? full : full.part(all, columns, rows);
    return {std::move(height_m), std::move(grid), std::move(about), reduction};
}

}  // namespace relevo::dem
