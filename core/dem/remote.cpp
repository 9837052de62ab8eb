#include "dem/remote.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "dem/gdal.h"

namespace relevo::dem {
namespace {

constexpr std::array<std::string_view, 13> kRemotePrefixes = {
    "DAAS:",     "EEDA:",   "EEDAI:",  "NGW:", "OGCAPI:", "PG:",  "PLMOSAIC:",
    "PLSCENES:", "STACIT:", "STACTA:", "WCS:", "WMS:",    "WMTS:"};
constexpr std::array<std::string_view, 10> kLocalFileSystems = {
    "/vsi7z/",  "/vsicached",  "/vsicrypt/",   "/vsigzip/", "/vsimem/",
    "/vsirar/", "/vsisparse/", "/vsisubfile/", "/vsitar/",  "/vsizip/"};

}  // namespace

bool is_local_file_system(std::string_view name) {
    return std::ranges::any_of(kLocalFileSystems,
                               [&](std::string_view system) { return name.starts_with(system); });
}

bool is_remote(std::string_view name) {
    if (name.starts_with("vrt://")) name.remove_prefix(6);
    if (name.find("://") != std::string_view::npos) return true;
    for (const std::string_view prefix : kRemotePrefixes)
        if (name.size() >= prefix.size() && EQUALN(name.data(), prefix.data(), prefix.size()))
            return true;
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

}  // namespace relevo::dem
