#include "dem/file_state.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// A raster whose changes its own file does not show.
bool is_unseen(const std::string& raster) {
    return raster.starts_with("/vsi") || lower(raster).ends_with(".vrt");
}

/// Puts the lines together.
class StateText {
  public:
    explicit StateText(const OpenedFiles* since) : since_(since) {}

    /// @returns false if there is no such file
    bool add(const std::filesystem::path& file) {
        struct stat status {};
        if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
        std::error_code error;
        const std::filesystem::path absolute = std::filesystem::canonical(file, error);
        if (error) return false;
        has_changed_ = has_changed_ || (since_ && since_->may_have_changed(file));
        text_ += fmt::format("{}\t{}\t{}.{:09}\n", absolute.string(), status.st_size,
                             status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
        return true;
    }

    /// @returns false if the raster is no file
    bool add_with_companions(const std::string& raster) {
        if (!add(raster)) return false;
        for (const std::filesystem::path& file : companions_of(raster))
            add(file);
        return true;
    }

    void add_words(const std::string& line) { text_ += line + "\n"; }

    /// nullopt if a file may have changed.
    std::optional<std::string> take() {
        return has_changed_ ? std::nullopt : std::optional(std::move(text_));
    }

  private:
    const OpenedFiles* since_;
    std::string text_;
    bool has_changed_ = false;
};

/// Of so many that none is opened.
bool add_many(const std::vector<std::string>& rasters, StateText& text) {
    return std::ranges::all_of(rasters, [&](const std::string& raster) {
        return !is_unseen(raster) && text.add_with_companions(raster);
    });
}

bool add_few(const std::vector<std::string>& rasters, StateText& text) {
    const std::optional<std::vector<std::filesystem::path>> files = local_files_of(rasters);
    if (!files || files->empty()) return false;
    // Several rasters may be in one file.
    for (const std::string& raster : rasters)
        text.add_words("raster " + raster);
    return std::ranges::all_of(*files, [&](const auto& file) { return text.add(file); });
}

/// An index and its tiles; of those that are missing, that they are.
bool add_index(const std::string& path, StateText& text) {
    if (!text.add(path)) return false;
    for (const std::string& location : tile_locations(path)) {
        if (is_unseen(location)) return false;
        if (!text.add_with_companions(location)) text.add_words(location + "\tmissing");
    }
    return true;
}

bool add_all(std::span<const std::string> paths, StateText& text) {
    if (paths.size() == 1 && is_named_index(paths.front())) return add_index(paths.front(), text);
    std::vector<std::string> rasters;
    for (const std::string& path : paths) {
        if (is_named_index(path)) return false;
        for (std::string& raster : rasters_of_quietly(path))
            rasters.push_back(std::move(raster));
    }
    return rasters.size() > kManyFiles ? add_many(rasters, text) : add_few(rasters, text);
}

}  // namespace

std::string text_of(const LoadOptions& options) {
    const auto bounds = options.bounds.value_or(Bounds{});
    return fmt::format(
        "crs {}\nband {}\nunit {}\nnodata {:.17g} {} {}\nencoding {}\ncrop {}\nbounds {} {:.17g} "
        "{:.17g} {:.17g} {:.17g}\n{}",
        options.crs, options.band, options.unit, options.nodata.value_or(0),
        options.nodata.has_value(), options.no_nodata, static_cast<int>(options.encoding),
        options.crop, options.bounds.has_value(), bounds.west_deg, bounds.south_deg,
        bounds.east_deg, bounds.north_deg, fmt::join(options.surroundings, "\n"));
}

std::optional<std::string> state_of_files(std::span<const std::string> paths,
                                          const OpenedFiles* since) try {
    StateText text(since);
    if ((since && since->are_elsewhere(paths)) || !add_all(paths, text)) return std::nullopt;
    return text.take();
} catch (const Error&) {
    return std::nullopt;  // what reads the DEM says why
}

}  // namespace relevo::dem
