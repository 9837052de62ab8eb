#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/units.h"
#include "dem/piece.h"

namespace relevo::dem {
namespace {

/// Of a post: files whose posts are this near to those of the others are on one grid.
constexpr double kSamePlace = 0.02;
/// More columns or rows than a raster of the whole Earth at 1 m has is a mistake.
constexpr double kMaxPosts = 5e7;

bool north_up(const Affine& a) {
    return a.x_row == 0 && a.y_column == 0 && a.x_column > 0 && a.y_row < 0;
}

/// The raster with the finest posts; only such as others can be resampled to, if that is needed.
const Piece* finest(const std::vector<Piece>& pieces, bool need_north_up) {
    const Piece* best = nullptr;
    double best_m2 = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces) {
        if (need_north_up && !north_up(piece.grid.affine())) continue;
        const glm::dvec2 spacing_m = piece.grid.post_spacing_m();
        // Tiles of one set differ by their latitude, which must not make the choice.
        if (spacing_m.x * spacing_m.y < 0.8 * best_m2) {
            best = &piece;
            best_m2 = spacing_m.x * spacing_m.y;
        }
    }
    return best;
}

/// The place of a piece whose posts are on the grid's; nothing where they are not.
std::optional<Window> place_on_grid(const Piece& piece, const Grid& grid) {
    if (piece.grid.crs().text() != grid.crs().text()) return std::nullopt;
    const Affine& own = piece.grid.affine();
    const int columns = piece.grid.columns(), rows = piece.grid.rows();
    double shift = 0;
    if (grid.crs().is_geographic()) {
        // The tiles on both sides of the antimeridian, or one that counts past 180 degrees.
        const double turn = 2 * kPi / grid.crs().unit_si();
        const auto middle = [](const Grid& of) {
            return of.affine()((of.columns() - 1) / 2.0, (of.rows() - 1) / 2.0).x;
        };
        shift = turn * std::round((middle(grid) - middle(piece.grid)) / turn);
    }
    const auto post = [&](int column, int row) {
        return grid.affine().inverse(own(column, row) + glm::dvec2(shift, 0));
    };
    const glm::dvec2 first = glm::round(post(0, 0));
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(columns - 1, 0),
                                    glm::ivec2(0, rows - 1), glm::ivec2(columns - 1, rows - 1)}) {
        const glm::dvec2 off = post(corner.x, corner.y) - first - glm::dvec2(corner);
        if (!(std::abs(off.x) < kSamePlace && std::abs(off.y) < kSamePlace)) return std::nullopt;
    }
    if (!(std::abs(first.x) < kMaxPosts && std::abs(first.y) < kMaxPosts)) return std::nullopt;
    return Window{static_cast<int>(first.x), static_cast<int>(first.y), columns, rows};
}

/// The posts of the grid that a piece covers with its cells.
Window place_resampled(const Piece& piece, const Grid& grid, const Piece& reference) {
    constexpr int kSteps = 32;
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (int i = 0; i <= 4 * kSteps; ++i) {
        const double t = (i % kSteps) / double{kSteps};
        const double w = piece.grid.columns(), h = piece.grid.rows();
        const std::array<glm::dvec2, 4> sides = {glm::dvec2(t * w, 0), glm::dvec2(w, t * h),
                                                 glm::dvec2(w - t * w, h),
                                                 glm::dvec2(0, h - t * h)};
        const glm::dvec2 edge = sides[static_cast<std::size_t>(i / kSteps % 4)] - 0.5;
        const glm::dvec2 at = grid.post(piece.grid.place(edge.x, edge.y));
        if (!(std::abs(at.x) < kMaxPosts && std::abs(at.y) < kMaxPosts))
            refuse(piece.path,
                   fmt::format("cannot be resampled to the grid of {}: parts of it are not within "
                               "{}; bring them to one CRS with gdalwarp",
                               reference.path, grid.crs().name()));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    const glm::ivec2 first(glm::ceil(low)), last(glm::floor(high));
    return {first.x, first.y, std::max(1, last.x - first.x + 1), std::max(1, last.y - first.y + 1)};
}

/// What the pieces do not agree on, for people: "-9999, -32768"; empty where they do.
template <typename Text>
std::string differing(const std::vector<Piece>& pieces, const Text& text) {
    std::set<std::string> all;
    for (const Piece& piece : pieces)
        all.insert(text(piece));
    return all.size() > 1 ? fmt::format("{}", fmt::join(all, ", ")) : "";
}

/// What each file was taken to mean, with its name where not all files are alike in it.
void gather(const std::vector<Piece>& pieces, std::vector<std::string> Description::*list,
            Description& about) {
    std::vector<std::string>& result = about.*list;
    result.clear();
    for (const Piece& piece : pieces)
        for (const std::string& sentence : piece.about.*list) {
            const auto says = [&](const Piece& other) {
                const std::vector<std::string>& lines = other.about.*list;
                return contains(lines, sentence);
            };
            const bool all = std::ranges::all_of(pieces, says);
            const std::string line =
                all ? sentence : fmt::format("{}: {}", piece.about.path, sentence);
            if (!contains(result, line)) result.push_back(line);
        }
}

/// The two files that are furthest from each other, by their middles.
struct Furthest {
    const Piece* from = nullptr;
    const Piece* to = nullptr;
    double distance_m = 0;
};

Furthest furthest(const std::vector<Piece>& pieces) {
    std::vector<geo::Geodetic> middles;
    for (const Piece& piece : pieces)
        middles.push_back(piece.grid.center());
    const auto from = [&](std::size_t i) {
        Furthest found;
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (const double distance_m = geo::geodesic(middles[i], middles[k]).distance_m;
                distance_m > found.distance_m)
                found = {&pieces[i], &pieces[k], distance_m};
        return found;
    };
    // From the one furthest from the first; of thousands, not all pairs.
    const Furthest first = from(0);
    return first.to ? from(static_cast<std::size_t>(first.to - pieces.data())) : first;
}

/// @param covered  share of the whole DEM, 0 to 1
void say_if_scattered(const std::vector<Piece>& pieces, double covered, Description& about) {
    constexpr double kThin = 0.25;
    constexpr double kMistake = 0.005;
    if (covered >= kThin) return;
    const std::string sentence = fmt::format(
        "the files cover {:.2g} % of their common extent, the rest is a void", 100 * covered);
    const Furthest far = furthest(pieces);
    if (covered >= kMistake || !far.from) {
        guess(about, sentence);
        return;
    }
    const bool in_order = far.from < far.to;
    about.warnings.push_back(
        fmt::format("{} and {} are {:.0f} km apart: {}; are they meant to be one DEM?",
                    (in_order ? far.from : far.to)->about.path,
                    (in_order ? far.to : far.from)->about.path, far.distance_m / 1000, sentence));
    about.assumptions.push_back(about.warnings.back());
}

/// Gives each piece that lies on a grid its place there.
/// @returns the places, none for pieces whose grid is another
std::vector<std::optional<Window>> places_on(const std::vector<Piece>& pieces, const Grid& grid) {
    std::vector<std::optional<Window>> places;
    for (const Piece& piece : pieces)
        places.push_back(place_on_grid(piece, grid));
    return places;
}

bool is_whole(const std::vector<std::optional<Window>>& places) {
    return std::ranges::all_of(places, [](const auto& place) { return !!place; });
}

/// Has a piece read as it is resampled to another one's grid.
void resample(Piece& piece, const Piece& reference) {
    if (piece.encoding != Encoding::None)
        refuse(piece.path, fmt::format("cannot be joined with {}: pictures of encoded heights "
                                       "must be on one grid, tiles of one zoom",
                                       reference.path));
    const Grid& grid = reference.grid;
    piece.place = place_resampled(piece, grid, reference);
    const glm::dvec2 first = grid.affine()(piece.place.column, piece.place.row);
    Affine affine = grid.affine();
    affine.x0 = first.x;
    affine.y0 = first.y;
    piece.resampling = Resampling{affine, grid.crs()};
    piece.levels = {{-1, piece.place.columns, piece.place.rows}};
    piece.sparse.reset();
}

/// The grid around all places, from whose first post they count then.
/// @param covered  filled with the share of its posts that the pieces have
Grid grid_around(std::vector<Piece>& pieces, const Grid& grid, double& covered) {
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    covered = 0;
    for (const Piece& piece : pieces) {
        const Window& w = piece.place;
        low = glm::min(low, glm::dvec2(w.column, w.row));
        high = glm::max(high, glm::dvec2(w.column + w.columns, w.row + w.rows));
        covered += double(w.columns) * w.rows;
    }
    const glm::dvec2 size = high - low;
    if (size.x > kMaxPosts || size.y > kMaxPosts)
        refuse(pieces.front().path,
               fmt::format("too far from the other files for one DEM, which would have {:.0f} x "
                           "{:.0f} posts",
                           size.x, size.y));
    for (Piece& piece : pieces) {
        piece.place.column -= static_cast<int>(low.x);
        piece.place.row -= static_cast<int>(low.y);
    }
    covered /= size.x * size.y;
    const glm::dvec2 origin = grid.affine()(low.x, low.y);
    Affine affine = grid.affine();
    affine.x0 = origin.x;
    affine.y0 = origin.y;
    return {static_cast<int>(size.x), static_cast<int>(size.y), affine, grid.crs()};
}

/// Says what the pieces differ in.
void describe_differences(const std::vector<Piece>& pieces, Description& about) {
    const std::string units =
        differing(pieces, [](const Piece& piece) { return piece.about.unit.name; });
    about.has_several_units = !units.empty();
    if (about.has_several_units)
        guess(about, fmt::format("heights are in {}: each file in its own", units));
    const std::string datums = differing(pieces, [](const Piece& piece) {
        return piece.about.vertical_datum.empty() ? "no stated datum" : piece.about.vertical_datum;
    });
    if (!datums.empty())
        guess(about, fmt::format("heights are above {}, and are joined as they are", datums));
    const auto nodata_text = [](const Piece& piece) {
        return piece.about.nodata ? piece.about.nodata_text() : "no value";
    };
    if (const std::string nodata = differing(pieces, nodata_text); !nodata.empty())
        about.assumptions.push_back(
            fmt::format("voids are marked by {}: each file has its own value", nodata));
}

}  // namespace

Grid join(std::vector<Piece>& pieces, Description& about) {
    if (pieces.size() == 1) {
        about = pieces.front().about;
        return pieces.front().grid;
    }
    const Piece* reference = finest(pieces, false);
    std::vector<std::optional<Window>> places = places_on(pieces, reference->grid);
    if (!is_whole(places)) {
        reference = finest(pieces, true);
        if (!reference)
            refuse(pieces.front().path,
                   "cannot be joined with the others: their grids differ and none of them runs "
                   "east and south; bring them to one grid with gdalwarp");
        places = places_on(pieces, reference->grid);
    }
    int resampled = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (places[i]) {
            pieces[i].place = *places[i];
        } else {
            resample(pieces[i], *reference);
            ++resampled;
        }
    }
    double covered = 0;
    Grid whole = grid_around(pieces, reference->grid, covered);

    about = reference->about;
    about.files.clear();
    for (const Piece& piece : pieces)
        about.files.push_back(piece.about.path);
    about.path = fmt::format("{} and {} more", pieces.front().about.path, pieces.size() - 1);
    gather(pieces, &Description::assumptions, about);
    gather(pieces, &Description::guesses, about);
    about.assumptions.insert(
        about.assumptions.begin(),
        fmt::format("{} files are joined; where they overlap, the one named last is on top",
                    pieces.size()));
    if (resampled > 0)
        guess(about, fmt::format("{} of the {} files {} resampled to the grid of {}", resampled,
                                 pieces.size(), resampled == 1 ? "is" : "are", reference->path));
    say_if_scattered(pieces, covered, about);
    describe_differences(pieces, about);
    return whole;
}

}  // namespace relevo::dem
