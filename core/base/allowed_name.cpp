#include "base/allowed_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <system_error>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"

// Rejected: two types of names within scenes, which every copy of a scene would have to keep
// apart; and a check of each field, which new fields would lack.
namespace relevo {
namespace {

constexpr std::array<std::string_view, 5> kArchives = {"/vsizip/", "/vsitar/", "/vsigzip/",
                                                       "/vsi7z/", "/vsirar/"};
/// GDAL's prefixes of subdatasets in one local file.
constexpr std::array<std::string_view, 10> kSubdatasets = {
    "netcdf", "hdf5",      "hdf4_sds",  "hdf4_eos", "bag",
    "s102",   "gtiff_dir", "gtiff_raw", "gpkg",     "nitf_im"};
constexpr std::array<std::string_view, 13> kRemotePrefixes = {
    "daas:",     "eeda:",   "eedai:",  "ngw:", "ogcapi:", "pg:",  "plmosaic:",
    "plscenes:", "stacit:", "stacta:", "wcs:", "wms:",    "wmts:"};
constexpr std::array<std::string_view, 10> kLocalFileSystems = {
    "/vsi7z/",  "/vsicached",  "/vsicrypt/",   "/vsigzip/", "/vsimem/",
    "/vsirar/", "/vsisparse/", "/vsisubfile/", "/vsitar/",  "/vsizip/"};

bool begins_with_any(std::string_view name, const auto& beginnings) {
    return std::ranges::any_of(
        beginnings, [&](std::string_view beginning) { return name.starts_with(beginning); });
}

bool has_scheme(std::string_view name) {
    return name.find("://") != std::string_view::npos;
}

bool is_plain(std::string_view name) {
    if (name.empty() || has_scheme(name)) return false;
    if (name.front() == '/') return !name.starts_with("/vsi");
    // GDAL reads these as drivers' prefixes, as XML and as JSON.
    if (name.find(':') == std::string_view::npos) return name.find_first_of("<{\"") != 0;
    return false;
}

/// What is in "/vsizip/" or the like. GDAL takes "/vsizip/vsicurl/..." as "/vsizip//vsicurl/...".
bool is_plain_archive(std::string_view inner) {
    std::string_view rest;
    if (inner.starts_with('{')) {
        const std::size_t end = inner.find('}');
        if (end == std::string_view::npos) return false;
        rest = inner.substr(end + 1);
        inner = inner.substr(1, end - 1);
    }
    if (has_scheme(rest) || inner.starts_with("vsi")) return false;
    return inner.starts_with("/vsi")
               ? begins_with_any(inner, kArchives) && is_of_this_machine(inner)
               : is_plain(inner);
}

/// What follows the prefix of a subdataset: `a.nc:z`, `"/folder/a.nc":z`, `2:a.tif`.
bool is_plain_subdataset(std::string_view rest) {
    while (!rest.empty() && std::isdigit(static_cast<unsigned char>(rest.front())) != 0 &&
           rest.find(':') != std::string_view::npos)
        rest.remove_prefix(rest.find(':') + 1);
    if (rest.starts_with('"')) {
        const std::size_t end = rest.find('"', 1);
        // A group of HDF5 may begin "://".
        return end != std::string_view::npos && is_plain(rest.substr(1, end - 1));
    }
    return !has_scheme(rest) && is_plain(rest.substr(0, rest.find(':')));
}

struct Names {
    std::shared_mutex mutex;
    std::set<std::string, std::less<>> names;
    bool all = false;
};

Names& allowed() {
    static Names one;
    return one;
}

/// Whether a person has written a name, or that of a folder it is in.
bool is_written(std::string_view name) {
    Names& given = allowed();
    const std::shared_lock lock(given.mutex);
    if (given.all || given.names.contains(name)) return true;
    if (name.find("/..") != std::string_view::npos) return false;
    for (std::size_t slash = name.rfind('/'); slash != std::string_view::npos && slash > 0;
         slash = name.rfind('/', slash - 1))
        if (given.names.contains(name.substr(0, slash)) ||
            given.names.contains(name.substr(0, slash + 1)))
            return true;
    return false;
}

/// Whether it is the relative name of a file here that has a colon.
bool has_colon(const std::string& name) {
    std::error_code unknown;
    return name.front() != '/' && !has_scheme(name) && name.find(':') != std::string::npos &&
           std::filesystem::exists(name, unknown);
}

[[noreturn]] void refuse(const std::string& name) {
    bad_usage(
        fmt::format("'{}' is not a file of this machine; name it on the command line, or add "
                    "--trust",
                    printable(name)));
}

}  // namespace

bool is_of_this_machine(std::string_view name) {
    for (const std::string_view archive : kArchives)
        if (name.starts_with(archive)) return is_plain_archive(name.substr(archive.size()));
    if (is_plain(name)) return true;
    const std::size_t colon = name.find(':');
    if (colon == std::string_view::npos || name.front() == '/') return false;
    if (contains(kSubdatasets, lower(std::string(name.substr(0, colon)))))
        return is_plain_subdataset(name.substr(colon + 1));
    return false;
}

bool is_local_file_system(std::string_view name) {
    return begins_with_any(name, kLocalFileSystems);
}

bool is_remote(std::string_view name) {
    if (name.starts_with("vrt://")) name.remove_prefix(6);
    if (has_scheme(name)) return true;
    if (begins_with_any(lower(std::string(name.substr(0, 16))), kRemotePrefixes)) return true;
    // In the middle too: "/vsizip//vsicurl/...".
    const auto is_of_a_name = [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-' || c == '.';
    };
    for (std::size_t at = name.find("/vsi"); at != std::string_view::npos;
         at = name.find("/vsi", at + 1))
        if (at == 0 || !is_of_a_name(static_cast<unsigned char>(name[at - 1])))
            if (!is_local_file_system(name.substr(at))) return true;
    return false;
}

void allow_name(const std::string& name) {
    Names& given = allowed();
    const std::unique_lock lock(given.mutex);
    given.names.insert(name);
}

void allow_word(std::string_view word) {
    allow_name(std::string(word));
    for (std::size_t at = word.find('='); at != std::string_view::npos; at = word.find('=', at + 1))
        allow_name(std::string(word.substr(at + 1)));
}

void forget_name(const std::string& name) {
    Names& given = allowed();
    const std::unique_lock lock(given.mutex);
    given.names.erase(name);
}

void allow_all_names() {
    Names& given = allowed();
    const std::unique_lock lock(given.mutex);
    given.all = true;
}

bool is_allowed(const std::string& name) {
    return name.empty() || is_of_this_machine(name) || is_written(name) || has_colon(name);
}

AllowedName::AllowedName(std::string name) : text_(std::move(name)) {
    if (text_.empty() || is_of_this_machine(text_)) return;  // an empty one: its reader refuses it
    if (is_written(text_))
        asks_net_ = is_remote(text_);
    else if (has_colon(text_))
        text_.insert(0, "./");  // which keeps GDAL from taking the colon for a prefix
    else
        refuse(text_);
}

AllowedName AllowedName::of_program(std::string name) {
    return {std::move(name), false};
}

bool AllowedName::allows(const std::string& other) const {
    return asks_net_ || is_of_this_machine(other) || is_written(other);
}

AllowedName AllowedName::derived(std::string other) const {
    if (!allows(other)) refuse(other);
    const bool net = is_remote(other) && !is_of_this_machine(other);
    return {std::move(other), net};
}

}  // namespace relevo
