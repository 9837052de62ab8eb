#include "dem/source.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "dem/clip.h"
#include "dem/gdal_support.h"
#include "dem/on_earth.h"
#include "dem/open_rasters.h"
#include "dem/source_impl.h"

namespace relevo::dem {
void Source::Impl::crop(const Window& window) {
    grid = grid->part(window, window.columns, window.rows);
    rasters->move_origin(window.column, window.row);
}

Source::Source(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Source::Source(Source&&) noexcept = default;
Source& Source::operator=(Source&&) noexcept = default;
Source::~Source() = default;

Source Source::open(const std::string& path, const LoadOptions& options) {
    return open(std::span(&path, 1), options);
}

Source Source::open(std::span<const std::string> given, const LoadOptions& options) {
    if (given.empty()) bad_input("no DEM given; name one or more files");
    allow_blocks(options.memory.block_bytes);
    auto impl = std::make_unique<Impl>(given);
    impl->work_bytes = options.memory.work_bytes;
    impl->block_bytes = options.memory.block_bytes;
    OpenRasters opened = open_rasters(given, options);
    Frame frame = join(opened.pieces, opened.indexes, impl->about, impl->grid);
    impl->rasters.emplace(std::move(opened), std::move(frame), options);
    if (!options.crop.empty()) impl->crop(crop_of(*impl->grid, options.crop));
    settle_earth(*impl->grid, impl->about, impl->leaves_earth);
    // Of several files, what holds for one alone begins with its name.
    const bool is_one = impl->about.files.size() == 1;
    for (const std::string& sentence : impl->about.guesses)
        log::info(is_one ? fmt::format("{}: {}", impl->about.files.front(), sentence) : sentence);
    for (const std::string& sentence : impl->about.warnings)
        log::warning(sentence);
    return Source(std::move(impl));
}

const Grid& Source::grid() const {
    return *impl_->grid;
}

const Description& Source::description() const {
    return impl_->about;
}

const OpenedFiles& Source::opened_files() const {
    return impl_->files;
}

Array2d<float> Source::read(const Window& window, int columns, int rows) const {
    assert(window.column >= 0 && window.row >= 0 &&
           window.column + window.columns <= grid().columns() &&
           window.row + window.rows <= grid().rows());
    assert(columns > 0 && rows > 0 && columns <= window.columns && rows <= window.rows);
    const bool all = columns == window.columns && rows == window.rows;
    Array2d<float> height_m;
    // A tile that breaks is a void, whichever part of it came first.
    std::int64_t before = 0;
    do {
        before = broken_while_read();
        height_m = all ? impl_->read_stored(window) : impl_->read_means(window, columns, rows);
    } while (broken_while_read() != before);
    if (impl_->leaves_earth) cut_to_earth(grid().part(window, columns, rows), height_m);
    if (impl_->shift_m != 0)
        for (float& height : height_m)
            height += impl_->shift_m;
    return height_m;
}

void Source::raise(double shift_m, const std::string& how) {
    impl_->shift_m = static_cast<float>(shift_m);
    impl_->about.joined = how;
}

Source::Blank Source::Impl::blank(const Window& window) const {
    Blank blank{window.rows, kHole};
    if (leaves_earth) return {0, kHole};
    for (const int number : rasters->within(window)) {
        if (rasters->is_void(number)) continue;
        const Piece* const piece = rasters->if_open(number);
        Window part = common(window, rasters->reach(number));
        if (piece) part = common(part, piece->place);
        if (part.is_empty()) continue;
        int rows = part.row - window.row;
        if (rows == 0 && piece && piece->sparse) {
            rows =
                piece->sparse->empty_rows({part.column - piece->place.column,
                                           part.row - piece->place.row, part.columns, part.rows});
            // Of several, what lies on top would have to be found out.
            if (rasters->is_one_file())
                blank.height_m = piece->unstored_m;
            else if (!std::isnan(piece->unstored_m))
                rows = 0;
            // Below the piece only others can have heights.
            if (rows == part.rows) continue;
        }
        blank.rows = std::min(blank.rows, rows);
    }
    return blank;
}

Source::Blank Source::blank(const Window& window) const {
    Blank blank = impl_->blank(window);
    blank.height_m += impl_->shift_m;
    return blank;
}

int Source::block_rows() const {
    constexpr int kManyRasters = 16, kMostRows = 4096;
    const Rasters& rasters = *impl_->rasters;
    int tallest = 1;
    for (int i = 0; i < rasters.count(); ++i)
        if (const Piece* const piece = rasters.if_open(i)) {
            tallest = std::max(tallest, piece->block_rows);
            // Of many more than there may be handles, each is best read once and closed.
            if (rasters.count() > kManyRasters)
                tallest = std::max(tallest, std::min(kMostRows, piece->place.rows));
        }
    return tallest;
}

bool Source::opens_slowly() const {
    constexpr int kFilesOfASecond = 400;
    return impl_->rasters->count() > kFilesOfASecond;
}

glm::ivec2 Source::block_size() const {
    constexpr int kOfMany = 64;
    const Rasters& rasters = *impl_->rasters;
    const Piece* const only = rasters.is_one_file() ? rasters.if_open(0) : nullptr;
    return only ? glm::ivec2(only->block_columns, only->block_rows) : glm::ivec2(kOfMany, kOfMany);
}

double Source::stored(int column, int row) const {
    const Rasters& rasters = *impl_->rasters;
    const Window post{column, row, 1, 1};
    const std::vector<int> found = rasters.within(post);
    double of_void = std::numeric_limits<double>::quiet_NaN();
    for (auto number = found.rbegin(); number != found.rend(); ++number) {
        const Piece* const piece = rasters.open(*number);
        if (!piece || common(post, piece->place).is_empty()) continue;
        double stored = 0;
        float height_m = kHole;
        rasters.read(*number, *piece, [&](void* dataset) {
            const int x = column - piece->place.column, y = row - piece->place.row;
            rasters.read_level(*piece, dataset, piece->levels.front(), {x, y, 1, 1}, &height_m);
            stored = piece->stored(dataset, x, y, height_m);
        });
        if (!std::isnan(height_m)) return stored;
        if (std::isnan(of_void)) of_void = stored;
    }
    return of_void;
}

TileReport Source::tiles() const {
    return impl_->rasters->report();
}

std::int64_t Source::broken_while_read() const {
    return impl_->rasters->broken_while_read();
}

void Source::allow_voids(std::int64_t tiles) const {
    impl_->rasters->allow_voids(tiles);
}

Array2d<float> Source::read() const {
    return read({0, 0, grid().columns(), grid().rows()}, grid().columns(), grid().rows());
}

double Source::cells_for_means(int side) const {
    double cells = 0;
    for (int i = 0; i < impl_->rasters->count(); ++i) {
        const Resolution& level = coarsest_level(impl_->rasters->sample(i), side, side);
        cells += double{1} * level.columns * level.rows;
    }
    return cells;
}

double Source::height_at(const geo::Geodetic& place) const {
    const glm::dvec2 post = grid().post(place);
    if (!(post.x >= 0 && post.y >= 0 && post.x <= grid().columns() - 1 &&
          post.y <= grid().rows() - 1))
        return std::numeric_limits<double>::quiet_NaN();
    const Window four{std::min(static_cast<int>(post.x), grid().columns() - 2),
                      std::min(static_cast<int>(post.y), grid().rows() - 2), 2, 2};
    const Heightfield field{read(four, 2, 2), grid().part(four, 2, 2), description()};
    return field.height_at(post.x - four.column, post.y - four.row);
}

}  // namespace relevo::dem
