#include "dem/remote.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "dem/gdal.h"
#include "dem/guard.h"
#include "dem/interpret.h"

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

namespace {

/// The file in the net that has another in it: "/vsicurl/https://a.org/b.zip" of
/// "/vsizip/vsicurl/https://a.org/b.zip/c.tif"; empty for other names.
std::string archive_of(const std::string& name) {
    if (!is_local_file_system(name) || !is_remote(name)) return {};
    std::string inner = name.substr(name.find('/', 1));
    inner.erase(0, inner.starts_with("//") || inner.starts_with("/{") ? 1 : 0);
    if (inner.starts_with('{')) return inner.substr(1, inner.find('}') - 1);
    if (!inner.starts_with("/vsi")) return {};  // "/vsisubfile/0_9,/vsicurl/..."
    const std::string lower_case = lower(inner);
    for (const std::string_view ending : {".zip/", ".kmz/", ".tar/", ".tgz/", ".tar.gz/"})
        if (const std::size_t at = lower_case.find(ending); at != lower_case.npos)
            return inner.substr(0, at + ending.size() - 1);
    return inner;  // "/vsigzip/vsicurl/https://a.org/b.tif.gz"
}

}  // namespace

Presence remote_presence(const std::string& name) {
    // GDAL does not say why it cannot look into an archive.
    if (const std::string archive = archive_of(name); !archive.empty())
        if (const Presence found = remote_presence(archive); found != Presence::There) return found;
    VSIErrorReset();
    VSIStatBufL status{};
    if (VSIStatExL(name.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_SET_ERROR_FLAG) == 0)
        return Presence::There;
    const std::string reason = VSIGetLastErrorMsg();
    const int kind = VSIGetLastErrorNo();  // where S3 says in words what else is a code of HTTP
    // GDAL remembers what is missing, and then gives no reason.
    if (reason.empty() || reason.ends_with(" 404") || kind == VSIE_AWSObjectNotFound)
        return Presence::Missing;
    if (reason.ends_with(" 403") || kind == VSIE_AWSAccessDenied) return Presence::Hidden;
    VSICurlPartialClearCache(name.c_str());
    refuse(name, fmt::format("cannot be asked for, {}; try again", reason));
}

void refuse_silent(const std::string& name) {
    if (name.starts_with("/vsi") && !name.starts_with("/vsistdin") && is_remote(name))
        remote_presence(name);
}

std::optional<NetworkUse> network_use() {
    if (!is_remote_allowed()) return std::nullopt;
    char* const text = VSINetworkStatsGetAsSerializedJSON(nullptr);
    const nlohmann::json all = nlohmann::json::parse(text ? text : "", nullptr, false);
    VSIFree(text);
    NetworkUse use;
    const auto methods = all.find("methods");
    if (!all.is_object() || methods == all.end()) return use;
    for (const auto& [name, method] : methods->items()) {
        use.requests += method.value("count", std::int64_t{0});
        use.read_bytes += method.value("downloaded_bytes", std::int64_t{0});
        use.written_bytes += method.value("uploaded_bytes", std::int64_t{0});
    }
    return use;
}

RemoteSiblings::RemoteSiblings(const std::string& path) {
    const std::size_t slash = path.rfind('/'), dot = path.rfind('.');
    const bool is_tiff = dot != std::string::npos && slash != std::string::npos && dot > slash &&
                         (EQUAL(path.c_str() + dot, ".tif") || EQUAL(path.c_str() + dot, ".tiff"));
    if (!is_tiff || !path.starts_with("/vsi") || !is_remote(path) || is_local_file_system(path) ||
        path.starts_with("/vsistdin"))
        return;
    names_.push_back(path.substr(slash + 1));
    const std::string stem = path.substr(0, dot);
    for (const std::string& name : {path + ".ovr", path + ".msk", path + ".aux.xml", stem + ".tfw"})
        if (remote_presence(name) == Presence::There) names_.push_back(name.substr(slash + 1));
    for (const std::string& name : names_)
        list_.push_back(name.c_str());
    list_.push_back(nullptr);
}

const char* const* RemoteSiblings::list() const {
    return list_.empty() ? nullptr : list_.data();
}

}  // namespace relevo::dem
