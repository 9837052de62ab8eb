#include "dem/files_of.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "dem/folder.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"
#include "dem/remote.h"
#include "dem/tile_opening.h"

namespace relevo::dem {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepestRaster = 16;  ///< virtual rasters of virtual rasters

/// The file on this machine that a name of GDAL's leads to: "/vsizip//maps/alps.zip/alps.tif" is
/// in /maps/alps.zip. Empty where there is none.
std::filesystem::path file_behind(std::string name) {
    std::error_code ignored;
    // Several may be in front: "/vsizip/vsigzip/...", "/vsizip//vsigzip/...".
    while (name.starts_with("/vsi")) {
        const std::size_t end = name.find('/', 1);
        if (end == std::string::npos) return {};
        name.erase(0, name.compare(end + 1, 3, "vsi") == 0 || name.compare(end, 2, "//") == 0
                          ? end
                          : end + 1);
        if (name.starts_with("//")) name.erase(0, 1);
        if (name.starts_with('{')) name.erase(0, 1);
    }
    for (std::filesystem::path path = name; !path.empty(); path = path.parent_path()) {
        if (std::filesystem::is_regular_file(path, ignored)) return path;
        if (path == path.parent_path()) break;
    }
    return {};
}

class Collector {
  public:
    void add(const std::string& name, int depth) {
        if (!seen_.insert(name).second || depth > kDeepestRaster) return;
        add_file(name);
        Dataset dataset;
        try {
            AllowedName opened(name);
            dataset = open_dataset(opened);
        } catch (const Error&) {
            are_local_ = false;
            return;  // what reads it says so
        }
        are_local_ = are_local_ && !may_name_others(name);
        char** const entries = GDALGetFileList(dataset.get());
        for (char** entry = entries; entry && *entry; ++entry) {
            const std::string source = *entry;
            if (lower(source).rfind(".vrt") == source.size() - 4)
                add(source, depth + 1);
            else
                add_file(source);
        }
        CSLDestroy(entries);
    }
    std::vector<fs::path> take() { return std::move(files_); }
    bool are_local() const { return are_local_; }

  private:
    /// A virtual raster that may name what GDAL does not list because it is out of reach.
    static bool may_name_others(const std::string& name) {
        if (!lower(name).ends_with(".vrt")) return false;
        InputStream file = input_stream(AllowedName(name));
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        return text.empty() || text.find("/vsi") != std::string::npos ||
               text.find("http") != std::string::npos;
    }

    void add_file(const std::string& name) {
        fs::path file = file_behind(name);
        are_local_ = are_local_ && !file.empty();
        if (!file.empty()) files_.push_back(std::move(file));
    }

    std::set<std::string> seen_;
    std::vector<fs::path> files_;
    bool are_local_ = true;
};

/// An index and its tiles, of which none is opened.
std::vector<fs::path> files_of_index(const std::string& path) {
    std::vector<fs::path> files{file_behind(path)};
    try {
        for (const std::string& location : tile_locations(path))
            if (!is_remote(location))
                if (fs::path file = file_behind(location); !file.empty())
                    files.push_back(std::move(file));
    } catch (const Error&) {
        // What reads it says so.
    }
    return files;
}

std::vector<fs::path> files_of(const std::string& raster) {
    Collector collector;
    collector.add(raster, 0);
    return collector.take();
}

}  // namespace

std::vector<fs::path> files_of(std::span<const std::string> paths) {
    std::vector<fs::path> files;
    for (const std::string& path : paths) {
        if (is_named_index(path)) {
            std::ranges::move(files_of_index(path), std::back_inserter(files));
            continue;
        }
        const std::vector<std::string> rasters = rasters_of_quietly(path);
        std::vector<std::vector<fs::path>> found(rasters.size());
        parallel_for(0, static_cast<int>(rasters.size()), 1, [&](int first, int last) {
            const WithoutListing without_listing(rasters.size());
            for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
                found[i] = files_of(rasters[i]);
        });
        for (std::vector<fs::path>& some : found)
            std::ranges::move(some, std::back_inserter(files));
    }
    return files;
}

std::optional<std::vector<fs::path>> local_files_of(std::span<const std::string> rasters) {
    Collector collector;
    for (const std::string& raster : rasters)
        collector.add(raster, 0);
    if (!collector.are_local()) return std::nullopt;
    return collector.take();
}

void add_named(std::span<const std::string> paths, FilesInUse& files, std::string_view what) {
    for (const std::string& path : paths)
        files.add_input(path, what);
}

void add_all(std::span<const std::string> paths, FilesInUse& files, std::string_view what) {
    add_named(paths, files, what);
    if (!files.replaces_any()) return;
    for (const std::filesystem::path& path : files_of(paths))
        files.add_input(path, fmt::format("a file that {} is read from,", what));
}

}  // namespace relevo::dem
