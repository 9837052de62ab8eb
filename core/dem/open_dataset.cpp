#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <vector>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>

#include "base/error.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::dem {

void CloseDataset::operator()(void* dataset) const {
    GDALClose(dataset);
}

void refuse(const std::string& path, const std::string& what) {
    bad_input(fmt::format("dem::load: {}: {}", path, what));
}

void guess(Description& about, const std::string& sentence) {
    about.assumptions.push_back(sentence);
    about.guesses.push_back(sentence);
}

namespace {

/// What GDAL calls the inside of an archive; empty where the name is not that of one.
std::string inside_of(const std::string& path) {
    const auto ends = [&](std::string_view ending) {
        return path.size() > ending.size() &&
               std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                          [](char a, unsigned char b) { return a == std::tolower(b); });
    };
    if (ends(".zip")) return "/vsizip/" + path;
    if (ends(".tar") || ends(".tgz") || ends(".tar.gz")) return "/vsitar/" + path;
    return ends(".gz") ? "/vsigzip/" + path : "";
}

Dataset gdal_open(const std::string& path) {
    return Dataset(GDALOpenEx(path.c_str(),
                              GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                              nullptr, nullptr));
}

/// Opens the one raster of an archive; nothing where it is no archive.
Dataset open_archive(std::string& path) {
    const std::string inside = inside_of(path);
    if (inside.empty()) return nullptr;
    if (inside.starts_with("/vsigzip/")) {
        Dataset dataset = gdal_open(inside);
        if (dataset) path = inside;
        return dataset;
    }
    char** entries = VSIReadDirRecursive(inside.c_str());
    std::vector<std::string> rasters;
    Dataset found;
    for (char** entry = entries; entry && *entry; ++entry) {
        const std::string name = fmt::format("{}/{}", inside, *entry);
        if (name.ends_with('/')) continue;
        if (Dataset dataset = gdal_open(name)) {
            rasters.push_back(name);
            found = std::move(dataset);
        }
    }
    CSLDestroy(entries);
    if (rasters.size() > 1)
        refuse(path, fmt::format("an archive of {} rasters, expected one; name those that are "
                                 "meant, as in '{}'",
                                 rasters.size(), rasters.front()));
    if (found) path = rasters.front();
    return found;
}

}  // namespace

Dataset open_dataset(std::string& path) {
    prepare_gdal();
    std::error_code ignored;
    const bool is_folder = std::filesystem::is_directory(path, ignored);
    // Names that are no file may still mean something to GDAL: "/vsizip/...", "NETCDF:a.nc:topo".
    const bool may_be_gdals = path.starts_with("/vsi") || path.find(':') != std::string::npos;
    if (!may_be_gdals && !std::filesystem::exists(path, ignored))
        refuse(path.empty() ? "\"\"" : path, "cannot be read, no such file");
    GdalMessages messages;
    Dataset dataset = gdal_open(path);
    if (dataset) return dataset;
    if (is_folder) refuse(path, "a folder, expected a raster file; name the files in it");
    const std::string reason = messages.failure(path);
    dataset = open_archive(path);
    if (dataset) return dataset;
    if (reason.find("does not exist") != std::string::npos ||
        reason.find("No such file") != std::string::npos)
        refuse(path, "cannot be read, no such file");
    if (reason.empty() || reason.find("not recognized as") != std::string::npos)
        refuse(path, "not a raster in any format that GDAL reads");
    refuse(path, fmt::format("cannot be opened as a raster, {}; the file is damaged or incomplete",
                             reason));
}

}  // namespace relevo::dem
