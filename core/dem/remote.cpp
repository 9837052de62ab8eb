#include "dem/remote.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "dem/gdal.h"
#include "dem/guard.h"
#include "dem/interpret.h"

namespace relevo::dem {
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

Presence remote_presence(const AllowedName& name) {
    // GDAL does not say why it cannot look into an archive.
    if (const std::string archive = archive_of(name.text()); !archive.empty())
        if (const Presence found = remote_presence(name.derived(archive)); found != Presence::There)
            return found;
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
    refuse(name.text(), fmt::format("cannot be asked for, {}; try again", reason));
}

void refuse_silent(const AllowedName& name) {
    if (name.asks_net() && name.text().starts_with("/vsi") && !name.text().starts_with("/vsistdin"))
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

RemoteSiblings::RemoteSiblings(const AllowedName& name) {
    const std::string& path = name.text();
    const std::size_t slash = path.rfind('/'), dot = path.rfind('.');
    const bool is_tiff = dot != std::string::npos && slash != std::string::npos && dot > slash &&
                         (EQUAL(path.c_str() + dot, ".tif") || EQUAL(path.c_str() + dot, ".tiff"));
    if (!is_tiff || !path.starts_with("/vsi") || !name.asks_net() || is_local_file_system(path) ||
        path.starts_with("/vsistdin"))
        return;
    names_.push_back(path.substr(slash + 1));
    const std::string stem = path.substr(0, dot);
    for (const std::string& sibling :
         {path + ".ovr", path + ".msk", path + ".aux.xml", stem + ".tfw"})
        if (remote_presence(name.derived(sibling)) == Presence::There)
            names_.push_back(sibling.substr(slash + 1));
    for (const std::string& sibling : names_)
        list_.push_back(sibling.c_str());
    list_.push_back(nullptr);
}

const char* const* RemoteSiblings::list() const {
    return list_.empty() ? nullptr : list_.data();
}

}  // namespace relevo::dem
