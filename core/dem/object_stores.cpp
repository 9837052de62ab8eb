#include "dem/object_stores.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/object_store.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/remote.h"

namespace relevo::dem {
namespace {

constexpr std::array<std::string_view, 7> kStores = {
    "/vsis3/", "/vsigs/", "/vsiaz/", "/vsioss/", "/vsiswift/", "/vsihdfs/", "/vsiwebhdfs/"};
constexpr std::array<std::string_view, 8> kReadOnly = {
    "/vsicurl/",          "/vsis3_streaming/",   "/vsigs_streaming/",    "/vsiaz_streaming/",
    "/vsioss_streaming/", "/vsicurl_streaming/", "/vsiswift_streaming/", "/vsicurl?"};
constexpr std::array<std::string_view, 2> kInParts = {"/vsis3/", "/vsioss/"};
constexpr std::size_t kAtOnce = 1 << 20;  // bytes

/// A result's name is a person's, or follows from one: a job's own outputs stay in its folder
/// (scene/job).
AllowedName result(const std::string& name) {
    return AllowedName::of_program(name);
}

bool begins_with_one_of(std::string_view name, const auto& prefixes) {
    return std::ranges::any_of(prefixes,
                               [&](std::string_view prefix) { return name.starts_with(prefix); });
}

class GdalObjectStore : public ObjectStore {
  public:
    bool has_name(std::string_view name) const override {
        return begins_with_one_of(name, kStores) || begins_with_one_of(name, kReadOnly);
    }

    void check_writable(const std::string& name) const override {
        if (begins_with_one_of(name, kReadOnly))
            bad_input(
                fmt::format("{}: cannot be written, GDAL only reads there; a name of an object "
                            "store begins with /vsis3/, /vsigs/ or /vsiaz/",
                            printable(name)));
    }

    bool exists(const std::string& name) const override {
        prepare_gdal();
        allow_remote();
        const AllowedName object = result(name);
        VSICurlPartialClearCache(name.c_str());  // another process may have made it
        const Presence presence = remote_presence(object);
        if (presence == Presence::Hidden)
            bad_input(
                fmt::format("{}: the store does not say whether it exists (HTTP response "
                            "code: 403); allow listing (s3:ListBucket), or pass --overwrite to "
                            "replace what may be there",
                            printable(name)));
        return presence == Presence::There;
    }

    void put(int descriptor, const std::string& name) const override {
        prepare_gdal();
        allow_remote();
        const GdalMessages messages;
        VSILFILE* const object = create_by_vsi(result(name));
        bool is_read = true;
        std::string fault = object ? copy(descriptor, object, is_read) : "";
        // What was not copied whole is not made an object: GDAL gives the parts up.
        const bool closed = object && VSIFCloseL(object) == 0;
        if (closed && fault.empty() && !messages.any_failure()) return;
        // Those that take no parts make one of what came.
        if (!is_read && !begins_with_one_of(name, kInParts)) VSIUnlink(name.c_str());
        if (fault.empty())
            fault = "the store or the net refuses it; CPL_CURL_VERBOSE=YES shows what it answers";
        failed(fmt::format("{}: cannot be written, {}", printable(name), fault));
    }

    bool get(const std::string& name, int descriptor) const override {
        if (!exists(name)) return false;
        const GdalMessages messages;
        const VsiFile open = open_vsi(result(name));
        auto* const object = static_cast<VSILFILE*>(open.get());
        std::vector<char> buffer(kAtOnce);
        off_t at = 0;
        for (std::size_t got = buffer.size(); object && got == buffer.size();) {
            got = VSIFReadL(buffer.data(), 1, buffer.size(), object);
            if (got > 0 && pwrite(descriptor, buffer.data(), got, at) != ssize_t(got))
                failed(
                    fmt::format("{}: cannot be copied, {}", printable(name), std::strerror(errno)));
            at += static_cast<off_t>(got);
        }
        if (object && !messages.any_failure() && at == size_of(name)) return true;
        bad_input(
            fmt::format("{}: cannot be read, {}; the net or the store may have failed, try "
                        "again",
                        printable(name), messages.failure(name)));
    }

    void remove(const std::string& name) const noexcept override { VSIUnlink(name.c_str()); }

  private:
    static off_t size_of(const std::string& name) {
        const std::optional<std::uint64_t> size = size_by_vsi(result(name));
        return size ? static_cast<off_t>(*size) : -1;
    }

    /// @param is_read  becomes false where the file cannot be read to its end
    /// @returns what went wrong; empty: nothing
    static std::string copy(int descriptor, VSILFILE* object, bool& is_read) {
        std::vector<char> buffer(kAtOnce);
        for (off_t at = 0;;) {
            const ssize_t got = pread(descriptor, buffer.data(), buffer.size(), at);
            if (got < 0) {
                const int error = errno;
                is_read = false;
                give_up(object);
                return std::strerror(error);
            }
            if (got == 0) return {};
            const auto count = static_cast<std::size_t>(got);
            if (VSIFWriteL(buffer.data(), 1, count, object) != count)
                return "the store or the net ends it halfway";
            at += got;
        }
    }

    /// Has GDAL make no object when it is closed. Version 3.6 has no call for that, but it takes a
    /// seek for an error, after which it gives up.
    static void give_up(VSILFILE* object) {
        VSIFSeekL(object, std::numeric_limits<vsi_l_offset>::max(), SEEK_SET);
    }
};

}  // namespace

void use_object_stores() {
    static const GdalObjectStore store;
    install_object_store(&store);
}

}  // namespace relevo::dem
