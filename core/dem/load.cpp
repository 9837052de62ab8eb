#include "dem/load.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "dem/interpret.h"
#include "dem/nodata.h"
#include "dem/sample.h"
#include "dem/unearthly.h"

namespace relevo::dem {

namespace {

/// A number as a file of this type stores it, as --nodata takes it: in as few digits, from six, as
/// give it again.
std::string stored_text(const Description& about, double stored) {
    const bool is_float = about.data_type == "Float32";
    const auto same = [&](double other) {
        return is_float ? static_cast<float>(other) == static_cast<float>(stored) : other == stored;
    };
    for (int digits = 6; digits < 17; ++digits)
        if (const std::string text = fmt::format("{:.{}g}", stored, digits);
            same(std::strtod(text.c_str(), nullptr)))
            return text;
    return fmt::format("{:.17g}", stored);
}

/// Says what the tiles of indexes turned out to be while all heights were read.
void report_tiles(const Source& source, Description& about) {
    about.tiles = source.tiles();
    source.allow_voids(about.tiles.missing.count + about.tiles.broken.count);
    const TileReport& tiles = about.tiles;
    const auto warn = [&](const NamedTiles& some, const char* what) {
        if (some.count == 0) return;
        about.warnings.push_back(fmt::format("{} of {} tiles {}", some.text(), tiles.tiles, what));
        about.assumptions.push_back(about.warnings.back());
        log::warning(fmt::format("{}: {}", about.path, printable(about.warnings.back())));
    };
    warn(tiles.missing, "are missing: their posts are voids");
    warn(tiles.broken, "cannot be read: their posts are voids");
    const auto say = [&](const NamedTiles& some, const char* what) {
        if (some.count == 0) return;
        guess(about, fmt::format("{} of {} tiles {}", some.text(), tiles.tiles, what));
        log::info(fmt::format("{}: {}", about.path, printable(about.guesses.back())));
    };
    say(tiles.differing, "differ from the first, and are read as they say");
    say(tiles.stepped, "differ in height from the tiles below; the later one is on top");
}

/// Of a DEM that has no post with a height.
[[noreturn]] void refuse_without_heights(const Source& source, const Description& about) {
    constexpr double kMarks = 1e38;  // programs mark voids by the largest floats
    const std::int64_t posts = about.statistics.holes;
    const Grid& grid = source.grid();
    const double stored = source.stored(grid.columns() / 2, grid.rows() / 2);
    const bool impossible = std::abs(stored) > no_height_beyond(about.unit.metres * about.scale) &&
                            std::abs(stored) < kMarks && stored != about.nodata;
    if (impossible)
        bad_input(
            fmt::format("{}: no height that is possible on Earth: all {} posts are voids or "
                        "beyond 10 000 km ({:g}); name the band of the heights with --band N",
                        about.path, posts, stored));
    bad_input(fmt::format("{}: no valid height: all {} posts are voids{}", about.path, posts,
                          about.nodata ? fmt::format(" (nodata {})", about.nodata_text()) : ""));
}

}  // namespace

void report_heights(const Source& source, Description& about, const std::optional<Collar>& collar) {
    report_tiles(source, about);
    const Statistics& s = about.statistics;
    if (s.valid == 0) refuse_without_heights(source, about);
    const auto guess = [&](const std::string& sentence) {
        dem::guess(about, sentence);
        log::info(fmt::format("{}: {}", about.path, sentence));
    };
    if (collar)
        guess(
            fmt::format("the whole edge is {:g} m high and differs from its neighbours by {:.0f} "
                        "m, perhaps fill of a rotated raster; --nodata {} marks it as void",
                        collar->height_m, collar->step_m, stored_text(about, source.stored(0, 0))));
}

namespace {

/// Whether the user has said what the heights are.
bool is_as_given(const LoadOptions& options) {
    return !options.unit.empty() || options.nodata || options.no_nodata;
}

/// Those that may speak of a wrong unit.
Spikes spikes_of_unit(const Heightfield& field) {
    return spikes_matter(field.about, field.grid)
               ? find_spikes(field.height_m, field.grid.post_spacing_m())
               : Spikes{};
}

}  // namespace

void check_heights(Description& about, const Spikes& spikes, const LoadOptions& options) {
    const std::string what = unearthly(about, spikes);
    if (what.empty()) return;
    if (!is_as_given(options)) bad_input(fmt::format("{}: {}", about.path, what));
    guess(about, what);
    log::info(fmt::format("{}: {}", about.path, what));
}

void check_heights(Heightfield& field, const LoadOptions& options) {
    check_heights(field.about, spikes_of_unit(field), options);
}

bool is_refused(const Heightfield& field, const LoadOptions& options) {
    return !is_as_given(options) && !unearthly(field.about, spikes_of_unit(field)).empty();
}

Heightfield load(const std::string& path, const LoadOptions& options) {
    return load(std::span(&path, 1), options);
}

Heightfield load(std::span<const std::string> paths, const LoadOptions& options) {
    return load(Source::open(paths, options), options.memory);
}

void refuse_endless_sides(const Source& source) {
    const Grid& grid = source.grid();
    if (std::max(grid.columns(), grid.rows()) > kMaxPostsASide)
        bad_input(fmt::format(
            "{}: {} x {} posts, expected at most {} a side; crop it with gdal_translate",
            source.description().path, grid.columns(), grid.rows(), kMaxPostsASide));
}

namespace {

/// How many posts of a DEM are left where means of `reduction` x `reduction` stand for them.
std::int64_t posts_at(const Grid& full, int reduction) {
    return std::int64_t{full.columns() / reduction} * (full.rows() / reduction);
}

/// The least power of two by which posts are few enough, or the greatest that leaves two a side.
int reduction_to(const Grid& full, std::int64_t max_posts) {
    int reduction = 1;
    while (posts_at(full, reduction) > max_posts &&
           std::min(full.columns(), full.rows()) / (2 * reduction) >= 2)
        reduction *= 2;
    return reduction;
}

/// Whether memory has room for what load() would keep of a DEM.
bool fits(const Grid& full, const MemoryBudget& memory) {
    const int reduction = reduction_of(full, memory);
    return posts_at(full, reduction) <= (reduction == 1 ? memory.posts : memory.means);
}

/// Of a DEM of which too few rows or columns would be left, if its means fitted.
[[noreturn]] void refuse_narrow(const Grid& full, const std::string& path,
                                const MemoryBudget& memory) {
    // At most 3 x kMaxPostsASide posts, for which the default suffices.
    std::int64_t mib = memory.mib();
    while (mib < MemoryBudget::kDefault_mib && !fits(full, memory.with_mib(mib)))
        ++mib;
    bad_input(
        fmt::format("{}: {} x {} posts are too narrow to be averaged; pass --memory {} or "
                    "more, or crop it with gdal_translate",
                    path, full.columns(), full.rows(), mib));
}

/// Without what is to be said of them but their statistics.
/// @param known  their heights; empty: they are read
Heightfield read_reduced(const Source& source, int reduction, Array2d<float> known = {}) {
    const Grid& full = source.grid();
    const int columns = full.columns() / reduction, rows = full.rows() / reduction;
    // What is left over at the last row and column is less than one mean.
    const Window all{0, 0, columns * reduction, rows * reduction};
    Array2d<float> height_m = known.empty() ? source.read(all, columns, rows) : std::move(known);
    Description about = source.description();
    about.statistics = statistics(height_m);
    Grid grid = reduction == 1 ? full : full.part(all, columns, rows);
    return {std::move(height_m), std::move(grid), std::move(about), reduction};
}

}  // namespace

int reduction_of(const Grid& full, const MemoryBudget& memory) {
    return posts_at(full, 1) <= memory.posts ? 1 : reduction_to(full, memory.means);
}

std::optional<Heightfield> load_quickly(const Source& source, std::int64_t most_posts) {
    refuse_endless_sides(source);
    constexpr std::int64_t kFew = std::int64_t{1} << 26;  // all of them are read as soon
    // Read in a second or two; 15 x 15 blocks where each is one more file that is opened.
    const std::int64_t most_sampled = source.opens_slowly() ? 225 * 64 * 64 : 200'000'000;
    const std::int64_t posts = posts_at(source.grid(), 1);
    const int reduction = reduction_to(source.grid(), most_posts);
    if (reduction == 1 || posts_at(source.grid(), reduction) > most_posts) return std::nullopt;
    const bool has_overviews =
        source.cells_for_means(reduction) <= 4 * static_cast<double>(most_posts);
    if (!has_overviews && posts <= kFew) return std::nullopt;
    Heightfield field = read_reduced(
        source, reduction,
        has_overviews ? Array2d<float>()
                      : sample_means(source, reduction, std::min(posts / 8, most_sampled)));
    if (field.about.statistics.valid == 0) return std::nullopt;
    if (!has_overviews) field.reduction = 1;
    return field;
}

Heightfield load(const Source& source, const MemoryBudget& memory, Array2d<float> known) {
    refuse_endless_sides(source);
    const Grid& full = source.grid();
    const std::string& path = source.description().path;
    if (!fits(full, memory)) refuse_narrow(full, path, memory);
    const int reduction = reduction_of(full, memory);
    const int columns = full.columns() / reduction, rows = full.rows() / reduction;
    try {
        Heightfield field = read_reduced(source, reduction, std::move(known));
        if (reduction > 1)
            field.about.assumptions.push_back(
                fmt::format("reduced from {} x {} to {} x {} posts in memory, means of {} x {}",
                            full.columns(), full.rows(), columns, rows, reduction, reduction));
        report_heights(
            source, field.about,
            field.about.statistics.valid > 0 ? find_collar(field.height_m) : std::nullopt);
        return field;
    } catch (const std::bad_alloc&) {
        failed(fmt::format("{}: no memory for {} x {} heights; pass a smaller --memory, now {}",
                           path, columns, rows, memory.mib()));
    }
}

}  // namespace relevo::dem
