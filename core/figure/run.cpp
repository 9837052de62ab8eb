#include "figure/run.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "dem/surroundings.h"

namespace relevo::figure {

output::RasterMetadata metadata_of(const Figure& figure, const dem::Posts& posts,
                                   const std::string& version, const PartMade& made,
                                   const dem::Window& window) {
    output::RasterMetadata about{
        {"TIFFTAG_SOFTWARE", "Relevo " + version},
        {"DEFINITION", made.definition},
        {"ACCURACY", std::string(figure.accuracy()) + "; errors of the heights come on top"},
        {"DEM", posts.about().path},
        {"TERRESTRIAL_REFRACTION", fmt::format("{:.4g}", figure.terrestrial_refraction)},
        {"HOLES", fmt::format("{}", made.holes)}};
    if (const std::string around = dem::surroundings_text(posts, ""); !around.empty())
        about.emplace_back("SURROUNDINGS", fmt::format("{}; {} posts of its spacing around the DEM",
                                                       around, posts.rim()));
    const dem::TileReport& tiles = posts.about().tiles;
    if (tiles.missing.count > 0)
        about.emplace_back("TILES_MISSING",
                           fmt::format("{} of {}", tiles.missing.text(), tiles.tiles));
    if (tiles.broken.count > 0)
        about.emplace_back("TILES_BROKEN",
                           fmt::format("{} of {}", tiles.broken.text(), tiles.tiles));
    if (window != whole_window(posts.grid()))
        about.emplace_back(
            "CLIP",
            fmt::format("columns {} to {} and rows {} to {} of the DEM, from 0", window.column,
                        window.end_column() - 1, window.row, window.end_row() - 1));
    std::ranges::copy(figure.metadata(posts), std::back_inserter(about));
    return about;
}

namespace {

dem::Grid grid_of(const dem::Grid& grid, const dem::Window& window) {
    return window == whole_window(grid) ? grid : grid.part(window, window.columns, window.rows);
}

}  // namespace

std::vector<dem::Window> raster_parts(const dem::Window& window, std::int64_t most_posts) {
    constexpr int kBlock = 512;  // blocks of the output file [posts]
    const int fitting = static_cast<int>(std::sqrt(static_cast<double>(most_posts)));
    const int side = std::max(kBlock, fitting / kBlock * kBlock);
    std::vector<dem::Window> parts;
    for (int row = 0; row < window.rows; row += side)
        for (int column = 0; column < window.columns; column += side)
            parts.push_back({window.column + column, window.row + row,
                             std::min(side, window.columns - column),
                             std::min(side, window.rows - row)});
    return parts;
}

std::vector<dem::Window> raster_parts(const dem::Posts& posts, const dem::Window& window,
                                      const MemoryBudget& memory) {
    constexpr std::int64_t kHeights = 8;  // memory that a post of the result takes, in heights
    return posts.in_memory() ? std::vector{window} : raster_parts(window, memory.posts / kHeights);
}

dem::Window whole_window(const dem::Grid& grid) {
    return {0, 0, grid.columns(), grid.rows()};
}

PartMade make_parts(const PartMaker& make, const std::vector<dem::Window>& parts,
                    const std::function<void(const dem::Window& part)>& begin) {
    PartMade sum;
    for (const dem::Window& part : parts) {
        begin(part);
        PartMade made = make(part);
        sum = {sum.holes + made.holes, std::move(made.definition)};
    }
    return sum;
}

PartMade make_all(const Figure& figure, const dem::Posts& posts, const geo::Geodetic& middle,
                  const dem::Window& all, const MemoryBudget& memory, Put put,
                  const std::function<void(double)>& done) {
    double share = 1;  // of a call
    const PartMaker make = figure.maker({.posts = posts,
                                         .window = all,
                                         .middle = middle,
                                         .put = std::move(put),
                                         .done = [&](double of_call) {
                                             if (done) done(share * of_call);
                                         }});
    const double calls = static_cast<double>(figure.calls());
    return make_parts(make, raster_parts(posts, all, memory), [&](const dem::Window& part) {
        share = double{1} * part.columns * part.rows / all.columns / all.rows / calls;
    });
}

Raster raster_of(const Figure& figure, const dem::Posts& posts,
                 const std::function<void(double)>& done) {
    Raster raster;
    const auto put = [&](std::size_t, const dem::Window&, Array2d<float> values) {
        raster.values = std::move(values);
    };
    raster.made =
        make_all(figure, posts, posts.grid().center(), whole_window(posts.grid()), {}, put, done);
    return raster;
}

RasterFile::RasterFile(OutputFile& file, const Figure& figure, const dem::Posts& posts,
                       const dem::Window& window, std::vector<std::string> options)
    : figure_(figure),
      posts_(posts),
      window_(window),
      writer_(file, grid_of(posts.grid(), window), figure.type(), figure.bands(),
              std::move(options)) {}

void RasterFile::finish(const std::string& version, const PartMade& made,
                        const output::RasterMetadata& more) {
    output::RasterMetadata about = metadata_of(figure_, posts_, version, made, window_);
    std::ranges::copy(more, std::back_inserter(about));
    writer_.finish(about);
}

void write_raster(OutputFile& file, const Figure& figure, const dem::Posts& posts,
                  const MemoryBudget& memory, const std::string& version, const Raster* whole,
                  const std::function<void(double)>& done) {
    const dem::Window all = whole_window(posts.grid());
    RasterFile raster(file, figure, posts, all);
    if (whole) raster.put(0, 0, 0, whole->values);
    const auto put = [&](std::size_t band, const dem::Window& part, const Array2d<float>& values) {
        raster.put(band, part.column, part.row, values);
    };
    const PartMade made =
        whole ? whole->made
              : make_all(figure, posts, posts.grid().center(), all, memory, put, done);
    output::RasterMetadata more;
    if (const auto beyond = figure.beyond(posts, all))
        more.emplace_back("BEYOND_DEM", beyond->text(figure.would()));
    raster.finish(version, made, more);
}

}  // namespace relevo::figure
