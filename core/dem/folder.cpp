#include "dem/folder.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/interpret.h"
#include "dem/tile_index.h"

namespace relevo::dem {
namespace {

namespace fs = std::filesystem;

/// The ending of a name, with its dot, in small letters.
std::string ending_of(const fs::path& file) {
    return lower(file.extension().string());
}

template <std::size_t N>
bool ends_like(const fs::path& file, const std::array<std::string_view, N>& endings) {
    return contains(endings, ending_of(file));
}

constexpr std::array<std::string_view, 4> kArchives = {".zip", ".tar", ".tgz", ".gz"};
/// What GDAL has drivers for, and what beside "a.tif" is of it: overviews ("a.ovr" of other
/// programs, "a.aux" and "a.rrd" of Erdas'), masks, descriptions for catalogues.
constexpr std::array<std::string_view, 5> kOfAnother = {".ovr", ".aux", ".rrd", ".msk", ".json"};

/// GDAL's driver for a file by its beginning and those beside it; empty where it has none.
std::string driver_of(const fs::path& file) {
    const GDALDriverH driver =
        GDALIdentifyDriverEx(AllowedName(file.string()).c_str(), GDAL_OF_RASTER, nullptr, nullptr);
    return driver ? GDALGetDriverShortName(driver) : "";
}

/// Files that are kept beside "a.tif", "a.tif.ovr", or beside "a" of that, "a.prj".
/// @param names  of rasters
bool is_beside(const fs::path& file, const std::set<std::string>& names) {
    const std::string& name = file.native();
    for (std::size_t dot = name.rfind('.'); dot != std::string::npos && dot > 0;
         dot = name.rfind('.', dot - 1))
        if (names.contains(name.substr(0, dot))) return true;
    return false;
}

std::string without_ending(const RasterFile& one) {
    return fs::path(one.path).replace_extension().string();
}

/// Leaves out what has its name before the dot from another raster, and is a part of that.
void drop_parts_of_others(std::vector<RasterFile>& rasters) {
    std::set<std::string> stems;
    for (const RasterFile& one : rasters)
        if (!ends_like(one.path, kOfAnother)) stems.insert(without_ending(one));
    std::erase_if(rasters, [&](const RasterFile& one) {
        return ends_like(one.path, kOfAnother) && stems.contains(without_ending(one));
    });
}

/// A file for people about a whole folder.
bool is_read_me(const fs::path& file) {
    return lower(file.stem().string()) == "readme";
}

/// The files that a virtual raster names, as far as they are there.
std::set<std::string> parts_of(const std::string& path) {
    std::set<std::string> parts;
    const AllowedName name(path);
    refuse_unsafe_vrt(name);
    const Dataset dataset = gdal_open(name);
    if (!dataset) return parts;
    char** const files = GDALGetFileList(dataset.get());
    for (char** file = files; file && *file; ++file) {
        std::error_code unknown;
        const fs::path part = fs::weakly_canonical(*file, unknown);
        if (!unknown) parts.insert(part.string());
    }
    CSLDestroy(files);
    std::error_code unknown;
    parts.erase(fs::weakly_canonical(path, unknown).string());
    return parts;
}

/// A header makes a raster of every file that has its name before the dot; the largest has the
/// cells.
void keep_cells(std::vector<RasterFile>& rasters) {
    constexpr std::array<std::string_view, 4> kByHeader = {"EHdr", "ENVI", "GenBin", "ISCE"};
    const auto by_header = [&](const RasterFile& one) { return contains(kByHeader, one.driver); };
    std::map<std::string, std::uintmax_t> most;
    for (const RasterFile& one : rasters) {
        std::uintmax_t& bytes = most[without_ending(one)];
        bytes = std::max(bytes, one.bytes);
    }
    std::erase_if(rasters, [&](const RasterFile& one) {
        return by_header(one) && one.bytes < most[without_ending(one)];
    });
}

std::vector<fs::path> sorted_entries(const std::string& folder) {
    std::error_code error;
    std::vector<fs::path> entries;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (!at->path().filename().string().starts_with('.')) entries.push_back(at->path());
    if (error) refuse(folder, fmt::format("a folder that cannot be read, {}", error.message()));
    std::ranges::sort(entries,
                      [](const fs::path& a, const fs::path& b) { return a.native() < b.native(); });
    return entries;
}

/// What lies in a folder.
struct Contents {
    std::vector<RasterFile> rasters;
    std::vector<fs::path> others;
    std::set<std::string> names;  // of files that are rasters
    int folders = 0;
};

Contents contents_of(const std::string& folder) {
    Contents found;
    std::error_code error;
    const std::vector<fs::path> entries = sorted_entries(folder);
    const WithoutListing without_listing(entries.size());
    for (const fs::path& entry : entries) {
        const fs::file_status status = fs::status(entry, error);
        const bool is_folder = fs::is_directory(status);
        found.folders += is_folder;
        if (is_folder && gdal_open(AllowedName(entry.string()))) {
            found.rasters.push_back({entry, "", 0});
        } else if (is_folder) {
            continue;
        } else if (!fs::is_regular_file(status)) {
            found.others.push_back(entry);
        } else {
            refuse_unreadable(entry.string());
            const std::string driver = ends_like(entry, kArchives) ? "archive" : driver_of(entry);
            // An index lies beside the tiles that it names.
            if (driver.empty() || is_tile_index(entry.string())) {
                found.others.push_back(entry);
            } else {
                found.rasters.push_back({entry, driver, fs::file_size(entry, error)});
                found.names.insert(entry.string());
            }
        }
    }
    return found;
}

/// Leaves out what a virtual raster is made of.
void drop_parts_of_virtual(std::vector<RasterFile>& rasters) {
    std::set<std::string> parts;
    for (const RasterFile& one : rasters)
        if (one.driver == "VRT") parts.merge(parts_of(one.path.string()));
    std::error_code error;
    std::erase_if(rasters, [&](const RasterFile& one) {
        return parts.contains(fs::weakly_canonical(one.path, error).string());
    });
}

/// Tells of the files that are no part of any raster.
void tell_of_others(const std::string& folder, const Contents& found) {
    std::vector<std::string> left_out;
    for (const fs::path& other : found.others)
        if (!is_beside(other, found.names) && !is_read_me(other))
            left_out.push_back(other.filename().string());
    if (left_out.empty()) return;
    constexpr std::size_t kMaxNamed = 3;
    const auto named =
        left_out.begin() + static_cast<std::ptrdiff_t>(std::min(left_out.size(), kMaxNamed));
    log::info(fmt::format("{}: {} of its files {} and skipped: {}{}", folder, left_out.size(),
                          left_out.size() == 1 ? "is no raster" : "are no rasters",
                          fmt::join(left_out.begin(), named, ", "),
                          left_out.size() > kMaxNamed ? ", ..." : ""));
}

}  // namespace

void drop_parts(std::vector<RasterFile>& rasters) {
    std::set<std::string> names;
    for (const RasterFile& one : rasters)
        names.insert(one.path.string());
    std::erase_if(rasters, [&](const RasterFile& one) { return is_beside(one.path, names); });
    drop_parts_of_others(rasters);
    keep_cells(rasters);
}

namespace {

std::vector<std::string> found_rasters(const std::string& path, bool aloud) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return {path};
    prepare_gdal();
    refuse_unreadable(path);
    GdalMessages messages;
    if (gdal_open(AllowedName(path))) return {path};

    Contents found = contents_of(path);
    drop_parts(found.rasters);
    drop_parts_of_virtual(found.rasters);
    if (found.rasters.empty())
        refuse(path, fmt::format("a folder without a raster in it, expected a raster or a folder "
                                 "of rasters{}",
                                 found.folders > 0 ? "; name one of its folders" : ""));
    std::vector<std::string> paths;
    for (const RasterFile& one : found.rasters) {
        found.names.insert(without_ending(one));
        paths.push_back(one.path.string());
    }
    if (aloud) tell_of_others(path, found);
    return paths;
}

}  // namespace

std::vector<std::string> rasters_of(const std::string& path) {
    return found_rasters(path, /*aloud=*/true);
}

std::vector<std::string> rasters_of_quietly(const std::string& path) {
    try {
        return found_rasters(path, /*aloud=*/false);
    } catch (const Error&) {
        return {};
    }
}

}  // namespace relevo::dem
