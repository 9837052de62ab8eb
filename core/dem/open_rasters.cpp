#include "dem/open_rasters.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "dem/dataset_pool.h"
#include "dem/folder.h"
#include "dem/tile_opening.h"

namespace relevo::dem {
namespace {

/// A file, or an index.
struct Name {
    std::string path;
    std::string folder;  ///< that it is from; empty: it was named itself
    bool is_index = false;
};

std::vector<Name> names_of(std::span<const std::string> given) {
    std::vector<Name> names;
    for (const std::string& name : given)
        if (is_named_index(name))
            names.push_back({name, "", true});
        else
            for (std::string& path : rasters_of(name)) {
                const bool is_itself = path == name;
                names.push_back({std::move(path), is_itself ? "" : name});
            }
    return names;
}

/// What opening a name gave.
struct Opened {
    std::optional<Piece> piece;
    Dataset handle;
    std::optional<OpenIndex> index;
    std::exception_ptr error;
};

void open_name(const Name& name, const LoadOptions& options, std::size_t names, Opened& opened) {
    if (name.is_index) {
        opened.index = open_index(name.path, options, opened.piece, opened.handle);
        return;
    }
    try {
        opened.piece.emplace(open_piece(AllowedName(name.path), options, names, opened.handle));
    } catch (const Error& error) {
        if (name.folder.empty()) throw;
        throw Error(error.code(), fmt::format("{}; it is one of {} in {}, name the right ones",
                                              error.what(), names, name.folder));
    }
}

/// Opens all names. Where some fail, those before the first of them have been opened, too.
std::vector<Opened> open_all(const std::vector<Name>& names, const LoadOptions& options) {
    std::vector<Opened> all(names.size());
    std::atomic<std::size_t> first_failed = names.size();
    parallel_for(0, static_cast<int>(names.size()), 1, [&](int first, int last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
            if (i > first_failed) continue;
            try {
                open_name(names[i], options, names.size(), all[i]);
            } catch (...) {
                all[i].error = std::current_exception();
                std::size_t before = first_failed;
                while (i < before && !first_failed.compare_exchange_weak(before, i)) {
                }
            }
            if (i >= DatasetPool::kMostIdle) all[i].handle.reset();
        }
    });
    if (first_failed < names.size()) std::rethrow_exception(all[first_failed].error);
    return all;
}

}  // namespace

OpenRasters open_rasters(std::span<const std::string> given, const LoadOptions& options) {
    const std::vector<Name> names = names_of(given);
    const bool has_index = std::ranges::any_of(names, &Name::is_index);
    if (options.bounds && (names.size() > 1 || has_index))
        bad_usage(has_index
                      ? std::string("--bounds: it says where one file is, but an index has its own")
                      : fmt::format("--bounds: it says where one file is, but there are {}",
                                    names.size()));
    std::vector<Opened> all = open_all(names, options);
    OpenRasters result;
    for (Opened& one : all) {
        const int piece = static_cast<int>(result.pieces.size());
        result.pieces.push_back(std::move(*one.piece));
        result.handles.push_back(std::move(one.handle));
        if (!one.index) {
            result.entries.push_back({piece});
            continue;
        }
        const int index = static_cast<int>(result.indexes.size());
        one.index->piece = static_cast<std::size_t>(piece);
        for (std::size_t tile = 0; tile < one.index->index.tiles.size(); ++tile)
            result.entries.push_back({tile == one.index->sample ? piece : -1, index, tile});
        result.indexes.push_back(std::move(*one.index));
    }
    return result;
}

}  // namespace relevo::dem
