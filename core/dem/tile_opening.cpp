#include "dem/tile_opening.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/remote.h"
#include "dem/tile_reach.h"

namespace relevo::dem {
namespace {

/// Tiles that are there but cannot be opened, before the index is given up.
constexpr std::size_t kMostBroken = 100;
constexpr std::chrono::seconds kPatience{15};  ///< until one of a store's tiles is open

bool same_file(const std::string& a, const std::string& b) {
    std::error_code unknown;
    return std::filesystem::equivalent(a, b, unknown) && !unknown;
}

/// The tiles that are asked for until one is there: all of this machine; of a store, where each is
/// a request, then some first ones and some of all over the index.
std::vector<std::size_t> candidates(const TileIndex& index) {
    constexpr std::size_t kFirst = 50, kAllOver = 50;
    std::vector<std::size_t> chosen, remote;
    for (std::size_t i = 0; i < index.tiles.size(); ++i)
        (is_remote(index.tiles[i].location) ? remote : chosen).push_back(i);
    const std::size_t count = remote.size();
    if (count <= kFirst + kAllOver) {
        chosen.insert(chosen.end(), remote.begin(), remote.end());
        return chosen;
    }
    chosen.insert(chosen.end(), remote.begin(), remote.begin() + kFirst);
    for (std::size_t i = 1; i <= kAllOver; ++i)
        chosen.push_back(remote[kFirst + (count - kFirst) * i / kAllOver - 1]);
    return chosen;
}

/// "/vsicurl/https://a.org", "/vsis3/bucket": the name up to the host, or the bucket.
std::string store_of(const std::string& location) {
    const std::size_t scheme = location.find("://");
    const std::size_t from = scheme != location.npos ? scheme + 3 : location.find('/', 1) + 1;
    return location.substr(0, location.find('/', from));
}

[[noreturn]] void refuse_missing(const TileIndex& index, std::size_t asked) {
    const std::string& first = index.tiles.front().location;
    if (asked == index.tiles.size())
        refuse(printable(index.path),
               fmt::format("none of its {} tiles is there, the first is {}; \"location\" counts "
                           "from the folder of the index",
                           asked, printable(first)));
    refuse(printable(index.path),
           fmt::format("none of {} tiles that were asked for, of {}, is in {}, the first is {}; "
                       "the index may be older than the store",
                       asked, index.tiles.size(), printable(store_of(first)), printable(first)));
}

/// The first tile that is there and can be opened.
/// @param piece  becomes it
std::size_t first_open(const TileIndex& index, const LoadOptions& options,
                       std::optional<Piece>& piece, Dataset& opened) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point began = Clock::now();
    std::size_t broken = 0, missing = 0;
    std::string first_reason;
    for (const std::size_t i : candidates(index)) {
        const IndexedTile& tile = index.tiles[i];
        if (!is_remote(tile.location))
            began = Clock::now();
        else if (Clock::now() - began > kPatience)
            break;
        if (!is_there(name_of(index, tile))) {
            ++missing;
            continue;
        }
        try {
            piece.emplace(open_tile_piece(index, tile, options, index.tiles.size(), opened));
            return i;
        } catch (const Error& error) {
            if (is_no_fault_of_a_file(error)) throw;
            if (broken++ == 0) first_reason = error.what();
            if (broken == kMostBroken) break;
        }
    }
    if (broken > 0)
        refuse(printable(index.path),
               fmt::format("none of its tiles can be opened ({} of {} tried): {}", broken + missing,
                           index.tiles.size(), first_reason));
    refuse_missing(index, missing);
}

bool is_apart(const Extent& a, const Extent& b) {
    return a.west >= b.east || b.west >= a.east || a.south >= b.north || b.south >= a.north;
}

/// Refuses an index whose numbers are not in the CRS that it says, or of other files.
void refuse_elsewhere(const TileIndex& index, const IndexedTile& tile, const Piece& piece) {
    Extent real =
        extent_of(TilePosts{piece.grid.columns(), piece.grid.rows(), piece.grid.affine()});
    // Longitudes may be of another turn.
    const double shift = whole_turns(
        piece.grid.crs(), (tile.extent.west + tile.extent.east - real.west - real.east) / 2);
    real.west += shift;
    real.east += shift;
    if (!is_apart(tile.extent, real)) return;
    const auto text = [](const Extent& e) {
        return fmt::format("{:.10g},{:.10g},{:.10g},{:.10g}", e.west, e.south, e.east, e.north);
    };
    refuse(
        printable(index.path),
        fmt::format("says that {} is at {}, but its file is at {} ({}); the index is of other "
                    "files, or names a wrong CRS",
                    printable(tile.name), text(tile.extent), text(real), piece.grid.crs().name()));
}

}  // namespace

AllowedName name_of(const TileIndex& index, const IndexedTile& tile) {
    return AllowedName(index.path).derived(tile.location);
}

bool is_there(const AllowedName& name) {
    const std::string& location = name.text();
    if (name.asks_net()) {
        if (!location.starts_with("/vsi")) return true;
        const Presence presence = remote_presence(name);
        if (presence == Presence::Hidden)
            refuse(printable(location),
                   "may not be read (HTTP response code: 403), and may be missing; try again with "
                   "the right to list or read it");
        return presence == Presence::There;
    }
    const bool may_be_gdals =
        location.starts_with("/vsi") || location.find(':') != std::string::npos;
    if (may_be_gdals && !location.starts_with("/vsi")) return true;
    if (!location.starts_with("/vsi")) {
        std::error_code error;
        const std::filesystem::file_status found = std::filesystem::status(location, error);
        if (found.type() == std::filesystem::file_type::none)
            refuse(printable(location),
                   fmt::format("cannot be asked for, {}; try again", error.message()));
        return std::filesystem::exists(found);
    }
    return size_by_vsi(name).has_value();
}

bool is_no_fault_of_a_file(const Error& error) {
    const std::string_view text = error.what();
    const auto has = [&](std::string_view words) { return text.find(words) != text.npos; };
    // As remedy_for() says, and what is wrong with the disk or with the rights to read it.
    return has("ulimit -n") || has("--memory") || has("try again") || has(std::strerror(EIO)) ||
           has(std::strerror(ESTALE)) || has(std::strerror(EACCES));
}

bool is_named_index(const std::string& name) {
    if (!is_index_name(name)) return false;
    if (const AllowedName allowed(name); allowed.asks_net()) {
        prepare_gdal();
        allow_remote();
        refuse_silent(allowed);
    }
    return is_tile_index(name);
}

Piece open_tile_piece(const TileIndex& index, const IndexedTile& tile, const LoadOptions& options,
                      std::size_t files, Dataset& opened) {
    if (same_file(index.path, tile.location))
        refuse(printable(tile.location), "the index itself, expected a raster");
    try {
        return open_piece(name_of(index, tile), options, files, opened);
    } catch (const Error&) {
        if (!is_remote(tile.location) && is_tile_index(tile.location))
            refuse(printable(tile.location), "an index of tiles, expected a raster");
        throw;
    }
}

OpenIndex open_index(const std::string& path, const LoadOptions& options,
                     std::optional<Piece>& piece, Dataset& opened) {
    OpenIndex open;
    open.index = read_tile_index(path, options.crs);
    refuse_remote_tiles(open.index);
    open.sample = first_open(open.index, options, piece, opened);
    const geo::Crs& crs = piece->grid.crs();
    const int stated = open.index.tiles[open.sample].crs;
    const bool is_other =
        stated >= 0 && open.index.crs[static_cast<std::size_t>(stated)].text() != crs.text();
    // Outlines in another CRS, or without one, are now known to be of this.
    if (is_other || stated < 0) {
        const std::string location = open.index.tiles[open.sample].location;
        open.index = read_tile_index(path, options.crs, &crs);
        open.sample = static_cast<std::size_t>(
            std::ranges::find(open.index.tiles, location, &IndexedTile::location) -
            open.index.tiles.begin());
    }
    refuse_elsewhere(open.index, open.index.tiles[open.sample], *piece);
    return open;
}

}  // namespace relevo::dem
