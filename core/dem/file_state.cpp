#include "dem/file_state.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/error.h"
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
    for (const std::string& location : tile_locations(path)) {
        if (is_unseen(location)) return std::nullopt;
        if (!add_with_companions(location, text)) text += location + "\tmissing\n";
    }
    return text;
}

}  // namespace

std::string text_of(const LoadOptions& options) {
    const auto bounds = options.bounds.value_or(Bounds{});
    return fmt::format(
        "crs {}\nband {}\nunit {}\nnodata {:.17g} {} {}\nencoding {}\ncrop {}\nbounds {} {:.17g} "
        "{:.17g} {:.17g} {:.17g}\n",
        options.crs, options.band, options.unit, options.nodata.value_or(0),
        options.nodata.has_value(), options.no_nodata, static_cast<int>(options.encoding),
        options.crop, options.bounds.has_value(), bounds.west_deg, bounds.south_deg,
        bounds.east_deg, bounds.north_deg);
}

std::optional<std::string> state_of_files(std::span<const std::string> paths) try {
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
    // Several rasters may be in one file.
    for (const std::string& raster : rasters)
        text += "raster " + raster + "\n";
    for (const std::filesystem::path& file : *files)
        if (!add_line(file, text)) return std::nullopt;
    return text;
} catch (const Error&) {
    return std::nullopt;  // what reads the DEM says why
}

}  // namespace relevo::dem
