#include "dem/no_raster.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/input_file.h"
#include "base/text.h"
#include "dem/tile_index.h"

namespace relevo::dem {
namespace {

namespace fs = std::filesystem;

/// The name in a folder that is nearest to one that is not there.
std::optional<std::string> near_name(const fs::path& folder, const std::string& name) {
    constexpr std::size_t kMost = 1000;  // of a larger folder too much would be near
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (names.size() == kMost) return std::nullopt;
        names.push_back(entry->path().filename().string());
    }
    return nearest(name, names);
}

/// "NETCDF:/data/a.nc:z", which names a part of a file to one of GDAL's drivers.
bool is_gdal_name(std::string_view path) {
    const std::size_t colon = path.find(':');
    return colon != path.npos && path.find('/') > colon;
}

}  // namespace

std::string no_file_text(const std::string& path) {
    const fs::path file(path);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const std::string text = "no such file";
    if (path.starts_with("/vsi") || is_gdal_name(path)) return text;
    if (!file.has_parent_path() && path.find('=') != std::string::npos)
        return text + "; an option's value is one word, as in --view az=210,el=30";
    std::error_code error;
    if (fs::is_symlink(file, error))
        return fmt::format("{}; it is a link to {}, which is not there", text,
                           fs::read_symlink(file, error).string());
    if (!fs::is_directory(folder, error))
        return fmt::format("{}; there is no folder {}", text, folder.string());
    const std::optional<std::string> near = near_name(folder, file.filename().string());
    return near ? fmt::format("{}; did you mean {}?", text,
                              file.has_parent_path() ? (folder / *near).string() : *near)
                : text;
}

std::string no_raster_text(const std::string& path) {
    if (const std::string why = why_no_index(path); !why.empty()) return why;
    std::string head(4096, '\0');
    InputStream file = input_stream(AllowedName(path));
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    const auto has = [&](std::string_view word) { return head.find(word) != head.npos; };
    const bool is_json = trimmed(head).starts_with('{');
    const bool is_ours = is_json && has("\"format\"") && (has("\"dem\"") || has("\"scene\""));
    if (is_ours && (has("\"shots\"") || has("\"sweep\"") || has("\"combine\"")))
        return "a job of Relevo, not a raster; draw it with relevo run";
    if (is_ours) return "a scene of Relevo, not a raster; draw it with relevo capture --scene";
    if (has("<kml")) return "places or a track (KML), not heights; make GPX or GeoJSON of it";
    if ((is_json && has("\"coordinates\"")) || has("<gpx"))
        return "places or a track, not heights; name the DEM first, and this file as relevo sun "
               "along or --points take it";
    if (head.starts_with("LASF"))
        return "a point cloud, not a raster; make a raster of it first, for example with PDAL";
    if (head.starts_with(std::string_view("\0\0\x27\x0a", 4)))
        return "a shapefile, not a raster; make a raster of it first, for example with "
               "gdal_rasterize";
    return "not a raster in any format that GDAL reads";
}

}  // namespace relevo::dem
