#include "dem/file_state.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/text.h"
#include "dem/files_of.h"
#include "dem/folder.h"
#include "dem/tile_index.h"
#include "dem/tile_opening.h"

namespace relevo::dem {
namespace {

constexpr std::size_t kManyFiles = 16;  // opening each would take longer than what is kept saves

/// Files next to a raster that GDAL reads with it.
std::vector<std::filesystem::path> companions_of(const std::filesystem::path& raster) {
    std::vector<std::filesystem::path> files;
    for (const char* ending : {".ovr", ".aux.xml", ".msk"})
        files.push_back(raster.string() + ending);
    for (const char* ending : {".tfw", ".tifw", ".wld", ".prj", ".hdr", ".aux"})
        files.push_back(std::filesystem::path(raster).replace_extension(ending));
    return files;
}

bool add_line(const std::filesystem::path& file, std::string& text) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::canonical(file, error);
    if (error) return false;
    text += fmt::format("{}\t{}\t{}.{:09}\n", absolute.string(), status.st_size,
                        status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
    return true;
}

/// A raster whose changes its own file does not show.
bool is_unseen(const std::string& raster) {
    return raster.starts_with("/vsi") || lower(raster).ends_with(".vrt");
}

/// @returns false if the raster is no file
bool add_with_companions(const std::string& raster, std::string& text) {
    if (!add_line(raster, text)) return false;
    for (const std::filesystem::path& file : companions_of(raster))
        add_line(file, text);
    return true;
}

std::optional<std::string> state_of_many(const std::vector<std::string>& rasters) {
    std::string text;
    for (const std::string& raster : rasters) {
        if (is_unseen(raster) || !add_with_companions(raster, text)) return std::nullopt;
    }
    return text;
}

/// An index and its tiles; of those that are missing, that they are.
std::optional<std::string> state_of_index(const std::string& path) {
    std::string text;
    if (!add_line(path, text)) return std::nullopt;
    for (const IndexedTile& tile : read_tile_index(path).tiles) {
        if (is_unseen(tile.location)) return std::nullopt;
        if (!add_with_companions(tile.location, text)) text += tile.location + "\tmissing\n";
    }
    return text;
}

}  // namespace

std::optional<std::string> state_of_files(std::span<const std::string> paths) {
    if (paths.size() == 1 && is_named_index(paths.front())) return state_of_index(paths.front());
    std::vector<std::string> rasters;
    for (const std::string& path : paths) {
        if (is_named_index(path)) return std::nullopt;
        for (std::string& raster : rasters_of_quietly(path))
            rasters.push_back(std::move(raster));
    }
    if (rasters.size() > kManyFiles) return state_of_many(rasters);
    const std::optional<std::vector<std::filesystem::path>> files = local_files_of(rasters);
    if (!files || files->empty()) return std::nullopt;
    std::string text;
    for (const std::filesystem::path& file : *files)
        if (!add_line(file, text)) return std::nullopt;
    return text;
}

}  // namespace relevo::dem
