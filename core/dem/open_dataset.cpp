#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "dem/folder.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/interpret.h"
#include "dem/no_raster.h"
#include "dem/remote.h"

namespace relevo::dem {

void DestroyFeature::operator()(void* feature) const {
    OGR_F_Destroy(feature);
}

void CloseDataset::operator()(void* dataset) const {
    GDALClose(dataset);
}

void refuse(const std::string& path, const std::string& what) {
    bad_input(fmt::format("{}: {}", path, what));
}

void guess(Description& about, const std::string& sentence) {
    about.assumptions.push_back(sentence);
    about.guesses.push_back(sentence);
}

std::string remedy_for(const std::string& path, const std::string& reason) {
    if (is_remote(path)) return "; the net or the store may have failed, try again";
    const auto is = [&](int error) {
        return reason.find(std::strerror(error)) != std::string::npos;
    };
    if (is(EMFILE) || is(ENFILE)) return "; allow more open files with ulimit -n";
    if (is(ENOMEM) || reason.find("ut of memory") != std::string::npos)
        return "; pass a smaller --memory or free some";
    if (is(EACCES) || is(EPERM) || is(EIO) || is(ESTALE)) return "";
    return "; the file is damaged or incomplete";
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

/// Whether a file begins as an archive or a compressed file does.
bool begins_like_archive(const AllowedName& name) {
    using namespace std::string_view_literals;
    const std::string head = read_vsi(name, 512);
    constexpr std::array kBeginnings = {"PK\3\4"sv,
                                        "\x1f\x8b\x08"sv,
                                        "BZh"sv,
                                        "\xfd"
                                        "7zXZ"sv,
                                        "7z\xbc\xaf"sv,
                                        "Rar!"sv,
                                        "\x28\xb5\x2f\xfd"sv};
    return std::ranges::any_of(
               kBeginnings,
               [&](std::string_view beginning) { return head.starts_with(beginning); }) ||
           (head.size() > 262 && head.compare(257, 5, "ustar") == 0);
}

/// Whether a dataset is what a header beside a file makes of it: the driver takes a file of any
/// content, which may be an archive of the very raster.
bool is_archive_taken_for_cells(const AllowedName& name, GDALDatasetH dataset) {
    constexpr std::array<std::string_view, 7> kAnyContent = {"EHdr", "ENVI",    "GenBin", "ISCE",
                                                             "PAux", "ROI_PAC", "RRASTER"};
    const std::string_view driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset));
    // ENVI's headers may say that the cells are compressed.
    return contains(kAnyContent, driver) &&
           !GDALGetMetadataItem(dataset, "COMPRESSION", "IMAGE_STRUCTURE") &&
           begins_like_archive(name);
}

/// Opens the one raster of an archive; nothing where it is no archive.
Dataset open_archive(AllowedName& given) {
    const std::string path = given.text(), inside = inside_of(path);
    if (inside.empty()) return nullptr;
    const AllowedName archive = given.derived(inside);
    if (inside.starts_with("/vsigzip/")) {
        refuse_unsafe_vrt(archive);
        Dataset dataset = gdal_open(archive);
        if (dataset) given = archive;
        return dataset;
    }
    char** entries = VSIReadDirRecursive(inside.c_str());
    std::vector<RasterFile> rasters;
    for (char** entry = entries; entry && *entry; ++entry) {
        const std::string name = fmt::format("{}/{}", inside, *entry);
        if (name.ends_with('/')) continue;
        const AllowedName inner = archive.derived(name);
        const std::optional<std::uint64_t> size = size_by_vsi(inner);
        if (const Dataset dataset = size ? gdal_open(inner) : nullptr)
            rasters.push_back(
                {name, GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get())), *size});
    }
    CSLDestroy(entries);
    drop_parts(rasters);
    if (rasters.size() > 1)
        refuse(path, fmt::format("an archive of {} rasters, expected one; name one, as in '{}'",
                                 rasters.size(), rasters.front().path.string()));
    if (rasters.empty()) return nullptr;
    given = archive.derived(rasters.front().path.string());
    refuse_unsafe_vrt(given);
    return gdal_open(given);
}

}  // namespace

Dataset gdal_open(const AllowedName& name) {
    const RemoteSiblings siblings(name);
    return open_by_gdal(name, GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                        siblings.list());
}

Dataset open_dataset(AllowedName& name) {
    prepare_gdal();
    const std::string path = name.text();
    // Names that are no file may still mean something to GDAL: "/vsizip/...", "NETCDF:a.nc:topo".
    if (name.asks_net()) allow_remote();
    refuse_silent(name);
    refuse_unreadable(path);
    GdalMessages messages;
    refuse_unsafe_vrt(name);
    Dataset dataset = gdal_open(name);
    if (dataset && is_archive_taken_for_cells(name, dataset.get())) dataset.reset();
    if (dataset) return dataset;
    const std::string reason = messages.failure(path);
    dataset = open_archive(name);
    if (dataset) return dataset;
    if (begins_like_archive(name))
        refuse(path,
               "an archive or a compressed file, expected a raster, or a .zip, .tar or .gz "
               "of one; unpack it first");
    if (const std::string driver = disarmed_driver_of(name); driver == "MEM")
        refuse(path, "names the program's own memory, expected a file");
    else if (!driver.empty() && !name.asks_net())
        refuse(path, fmt::format("a description ({}) of what is on the net, which is asked only by "
                                 "a name on the command line; make a file of it with "
                                 "gdal_translate",
                                 driver));
    if (!size_by_vsi(name) && (reason.find("does not exist") != std::string::npos ||
                               reason.find("No such file") != std::string::npos))
        refuse(path, no_file_text(path));
    if (reason.empty() || reason.find("not recognized as") != std::string::npos)
        refuse(path, no_raster_text(path));
    refuse(path,
           fmt::format("cannot be opened as a raster, {}{}", reason, remedy_for(path, reason)));
}

}  // namespace relevo::dem
