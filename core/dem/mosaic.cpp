#include "dem/mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/tile_reach.h"

namespace relevo::dem {
namespace {

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
    constexpr std::size_t kMostNamed = 8;  // of thousands, one line says how many
    std::map<std::string, std::vector<const Piece*>> said_by;
    std::vector<std::string> sentences;  // each once, in order
    for (const Piece& piece : pieces)
        for (const std::string& sentence : piece.about.*list) {
            std::vector<const Piece*>& by = said_by[sentence];
            if (by.empty()) sentences.push_back(sentence);
            if (by.empty() || by.back() != &piece) by.push_back(&piece);
        }
    std::vector<std::string>& result = about.*list;
    result.clear();
    for (const std::string& sentence : sentences) {
        const std::vector<const Piece*>& by = said_by[sentence];
        const std::string& first = by.front()->about.path;
        if (by.size() == pieces.size())
            result.push_back(sentence);
        else if (by.size() > kMostNamed)
            result.push_back(fmt::format("{} and {} more: {}", first, by.size() - 1, sentence));
        else
            for (const Piece* piece : by)
                result.push_back(fmt::format("{}: {}", piece->about.path, sentence));
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
        places.push_back(place_on_grid(piece.grid, grid));
    return places;
}

bool is_whole(const std::vector<std::optional<Window>>& places) {
    return std::ranges::all_of(places, [](const auto& place) { return !!place; });
}

/// Posts of a raster from one post of a grid to the next, in the middle of the grid, across and
/// down; at least 1.
glm::dvec2 reach_between(const Grid& grid, const Grid& own) {
    const glm::dvec2 middle((grid.columns() - 1) / 2.0, (grid.rows() - 1) / 2.0);
    const auto post = [&](double column, double row) {
        return own.post(grid.place(middle.x + column, middle.y + row));
    };
    const glm::dvec2 across = post(0.5, 0) - post(-0.5, 0), down = post(0, 0.5) - post(0, -0.5);
    return glm::max(glm::dvec2(1), {std::hypot(across.x, down.x), std::hypot(across.y, down.y)});
}

/// As Resampling::shift.
std::optional<double> shift_between(const Grid& grid, const Grid& own) {
    if (grid.crs().text() != own.crs().text()) return std::nullopt;
    const auto middle = [](const Grid& of) {
        return of.affine()((of.columns() - 1) / 2.0, (of.rows() - 1) / 2.0).x;
    };
    return whole_turns(grid.crs(), middle(own) - middle(grid));
}

/// Has a piece read as it is resampled to another one's grid.
void resample(Piece& piece, const Frame& frame) {
    if (piece.encoding != Encoding::None)
        refuse(piece.path.text(),
               fmt::format("cannot be joined with {}: pictures of encoded heights "
                           "must be on one grid, tiles of one zoom",
                           frame.name));
    const Grid& grid = frame.grid;
    piece.place = place_resampled(piece.grid, grid, piece.path.text(), frame.name);
    const glm::dvec2 first = grid.affine()(piece.place.column, piece.place.row);
    Affine affine = grid.affine();
    affine.x0 = first.x;
    affine.y0 = first.y;
    const Grid on(piece.place.columns, piece.place.rows, affine, grid.crs());
    piece.resampling = Resampling{on, reach_between(on, piece.grid), shift_between(on, piece.grid)};
    piece.levels = {{-1, piece.place.columns, piece.place.rows}};
    piece.sparse.reset();
}

/// Which pieces are tiles of indexes: what of them counts is where their index says they are.
std::vector<bool> are_samples(const std::vector<Piece>& pieces,
                              const std::vector<OpenIndex>& indexes) {
    std::vector<bool> result(pieces.size());
    for (const OpenIndex& index : indexes)
        result[index.piece] = true;
    return result;
}

/// The grid around all places, from whose first post they count then.
/// @param covered  filled with the share of its posts that the rasters have
Grid grid_around(std::vector<Piece>& pieces, std::vector<OpenIndex>& indexes, Frame& frame,
                 double& covered) {
    const std::vector<bool> is_sample = are_samples(pieces, indexes);
    std::vector<Window*> counted, moved;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (!is_sample[i]) counted.push_back(&pieces[i].place);
        moved.push_back(&pieces[i].place);
    }
    for (OpenIndex& index : indexes)
        for (Window& reach : index.reaches) {
            counted.push_back(&reach);
            moved.push_back(&reach);
        }
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    covered = 0;
    for (const Window* w : counted) {
        low = glm::min(low, glm::dvec2(w->column, w->row));
        high = glm::max(high, glm::dvec2(w->end_column(), w->end_row()));
        covered += double(w->columns) * w->rows;
    }
    const glm::dvec2 size = high - low;
    if (size.x > kMaxPosts || size.y > kMaxPosts)
        refuse(pieces.front().path.text(),
               fmt::format("too far from the other files for one DEM, which would have {:.0f} x "
                           "{:.0f} posts",
                           size.x, size.y));
    frame.origin = glm::ivec2(low);
    for (Window* w : moved) {
        w->column -= frame.origin.x;
        w->row -= frame.origin.y;
    }
    covered /= size.x * size.y;
    const glm::dvec2 origin = frame.grid.affine()(low.x, low.y);
    Affine affine = frame.grid.affine();
    affine.x0 = origin.x;
    affine.y0 = origin.y;
    return {static_cast<int>(size.x), static_cast<int>(size.y), affine, frame.grid.crs()};
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

/// Names the files and says how many rasters they are.
void describe_files(const std::vector<Piece>& pieces, const std::vector<OpenIndex>& indexes,
                    Description& about) {
    about.files.clear();
    for (const Piece& piece : pieces)
        about.files.push_back(piece.about.path);
    std::size_t rasters = pieces.size();
    for (const OpenIndex& index : indexes) {
        about.files[index.piece] = index.index.path;
        rasters += index.index.tiles.size() - 1;
    }
    about.path = about.files.size() == 1
                     ? about.files.front()
                     : fmt::format("{} and {} more", about.files.front(), about.files.size() - 1);
    const bool is_index = pieces.size() == 1;
    about.assumptions.insert(
        about.assumptions.begin(),
        is_index ? fmt::format("{} tiles of an index ({}) are joined; where they overlap, the "
                               "later one is on top",
                               rasters, indexes.front().index.format)
                 : fmt::format("{} files are joined; where they overlap, the one named last is on "
                               "top",
                               rasters));
    for (const OpenIndex& index : indexes)
        if (index.index.repeated > 0)
            guess(about, fmt::format("{} of the rows name a tile again and are skipped",
                                     index.index.repeated));
}

/// Warns of tiles whose index contradicts itself.
void warn_of_contradictions(const std::vector<OpenIndex>& indexes, Description& about) {
    for (const OpenIndex& index : indexes) {
        const NamedTiles& tiles = index.index.contradicting;
        if (tiles.count == 0) continue;
        about.warnings.push_back(fmt::format(
            "{}: proj:transform of {} of {} tiles contradicts bbox and geometry, which are used",
            printable(index.index.path), printable(tiles.text()), index.index.tiles.size()));
        about.assumptions.push_back(about.warnings.back());
    }
}

/// The piece whose grid all are read on, and the places of those that lie on it.
const Piece& reference_of(const std::vector<Piece>& pieces,
                          std::vector<std::optional<Window>>& places) {
    const Piece* reference = finest(pieces, false);
    places = places_on(pieces, reference->grid);
    if (is_whole(places)) return *reference;
    reference = finest(pieces, true);
    if (!reference)
        refuse(pieces.front().path.text(),
               "cannot be joined with the others: their grids differ and none of them runs "
               "east and south; bring them to one grid with gdalwarp");
    places = places_on(pieces, reference->grid);
    return *reference;
}

}  // namespace

void settle_on(const Frame& frame, Piece& piece) {
    if (const std::optional<Window> place = place_on_grid(piece.grid, frame.grid))
        piece.place = *place;
    else
        resample(piece, frame);
    piece.place.column -= frame.origin.x;
    piece.place.row -= frame.origin.y;
}

Frame join(std::vector<Piece>& pieces, std::vector<OpenIndex>& indexes, Description& about,
           std::optional<Grid>& whole) {
    if (pieces.size() == 1 && indexes.empty()) {
        about = pieces.front().about;
        whole = pieces.front().grid;
        return {pieces.front().grid, pieces.front().path.text()};
    }
    std::vector<std::optional<Window>> places;
    const Piece& reference = reference_of(pieces, places);
    Frame frame{reference.grid, reference.path.text()};
    int resampled = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (places[i]) {
            pieces[i].place = *places[i];
        } else {
            resample(pieces[i], frame);
            ++resampled;
        }
    }
    for (OpenIndex& index : indexes)
        index.reaches = reaches_of(index.index, frame.grid, frame.name);
    double covered = 0;
    whole = grid_around(pieces, indexes, frame, covered);

    about = reference.about;
    gather(pieces, &Description::assumptions, about);
    gather(pieces, &Description::guesses, about);
    describe_files(pieces, indexes, about);
    warn_of_contradictions(indexes, about);
    if (resampled > 0)
        guess(about, fmt::format("{} of the {} files {} resampled to the grid of {}", resampled,
                                 pieces.size(), resampled == 1 ? "is" : "are", frame.name));
    say_if_scattered(pieces, covered, about);
    describe_differences(pieces, about);
    return frame;
}

}  // namespace relevo::dem
