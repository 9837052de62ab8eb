#include "dem/guard.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/contains.h"
#include "base/host_program.h"
#include "dem/gdal.h"
#include "dem/gdal_module.h"
#include "dem/gdal_open.h"
#include "dem/interpret.h"
#include "dem/no_raster.h"
#include "dem/remote.h"

namespace relevo::dem {

void disarm_gdal() {
    gdal_module().disarm(is_local_file_system, opens_of_the_net);
}

namespace {

std::atomic<bool>& remote_allowed() {
    static std::atomic<bool> allowed = false;
    return allowed;
}

}  // namespace

void allow_remote() {
    // As GDAL has them a store that answers nothing is waited for without end. What users set
    // stays.
    struct Setting {
        const char* name;
        const char* value;
    };
    constexpr std::array kSettings{Setting{"GDAL_HTTP_CONNECTTIMEOUT", "10"},     // s
                                   Setting{"GDAL_HTTP_LOW_SPEED_LIMIT", "1000"},  // bytes/s
                                   Setting{"GDAL_HTTP_LOW_SPEED_TIME", "10"},     // s
                                   Setting{"GDAL_HTTP_MAX_RETRY", "3"},
                                   Setting{"GDAL_HTTP_RETRY_DELAY", "1"},  // s, doubled each time
                                   Setting{"CPL_VSIL_NETWORK_STATS_ENABLED", "YES"}};
    static std::once_flag once;
    std::call_once(once, [&] {
        for (const Setting& setting : kSettings)
            if (!is_hosted() && !CPLGetConfigOption(setting.name, nullptr))
                CPLSetConfigOption(setting.name, setting.value);
    });
    gdal_module().allow_remote();
    remote_allowed() = true;
}

bool is_remote_allowed() {
    return remote_allowed();
}

std::string disarmed_driver_of(const AllowedName& name) {
    GdalStrings names;
    for (const std::string& driver : gdal_module().disarmed_drivers())
        names.add(driver);
    if (!names.list()) return "";  // for which GDAL would take all drivers
    const GDALDriverH found =
        GDALIdentifyDriverEx(name.c_str(), GDAL_OF_RASTER, names.list(), nullptr);
    return found ? GDALGetDriverShortName(found) : "";
}

namespace {

namespace fs = std::filesystem;

/// What a file is that is read to its end only by luck; empty for others.
std::string_view endless(const fs::file_status& status) {
    switch (status.type()) {
        case fs::file_type::fifo:
            return "a pipe";
        case fs::file_type::socket:
            return "a socket";
        case fs::file_type::character:
        case fs::file_type::block:
            return "a device";
        default:
            return {};
    }
}

/// The file of this machine that a name is about: that of "NETCDF:a.nc:z" and of
/// "/vsizip/a.zip/b.tif"; empty where it is about none.
std::string file_in(std::string_view name) {
    std::error_code unknown;
    for (std::size_t from = 0; from != std::string_view::npos && from < name.size();) {
        std::string_view rest = name.substr(from);
        while (!rest.empty() && (rest.front() == '"' || rest.front() == '{'))
            rest.remove_prefix(1);
        for (std::size_t end = rest.size(); end > 1 && end != std::string_view::npos;
             end = rest.find_last_of("/:\"}?", end - 1)) {
            const fs::file_status status = fs::status(rest.substr(0, end), unknown);
            if (fs::is_directory(status)) break;  // of which there is no such file
            if (fs::exists(status)) return std::string(rest.substr(0, end));
        }
        const std::size_t end =
            rest.starts_with("/vsi") ? name.find('/', from + 1) : name.find(':', from);
        from = end == std::string_view::npos ? end : end + 1;
    }
    return {};
}

std::string remedy_of(int error) {
    return error == EMFILE || error == ENFILE ? "; allow more of them with ulimit -n" : "";
}

}  // namespace

void refuse_unreadable(const std::string& path) {
    if (path.empty()) refuse("\"\"", "no such file");
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    const bool may_be_gdals = path.starts_with("/vsi") || path.find(':') != std::string::npos;
    std::string file = path;
    if (!fs::exists(status)) {
        if (!may_be_gdals || path.size() > PATH_MAX) {
            const int reason = error.value();
            refuse(path, reason == 0 || reason == ENOENT || reason == ENOTDIR
                             ? no_file_text(path)
                             : fmt::format("cannot be read, {}", std::strerror(reason)));
        }
        file = file_in(path);
        if (file.empty()) return;
    }
    if (const std::string_view kind = endless(fs::status(file, error)); !kind.empty())
        refuse(path, fmt::format("{}, expected a file or a folder; write what it gives to a file "
                                 "first",
                                 kind));
    const int opened = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (opened < 0)
        refuse(path, fmt::format("cannot be read, {}{}", std::strerror(errno), remedy_of(errno)));
    ::close(opened);
}

namespace {

struct DestroyTree {
    void operator()(CPLXMLNode* tree) const { CPLDestroyXMLNode(tree); }
};
using Tree = std::unique_ptr<CPLXMLNode, DestroyTree>;

/// Walks through a virtual raster and those that it names.
class VrtWalk {
  public:
    explicit VrtWalk(AllowedName given) : name_(std::move(given)), given_(name_.text()) {}

    std::uint64_t bytes() const { return bytes_; }

    void file(const std::string& path) {
        // A name may be the text of a virtual raster itself.
        if (path.starts_with('<')) return source(path, "");
        const AllowedName name = name_.derived(path);
        const std::uint64_t size = size_by_vsi(name).value_or(0);
        bytes_ += size;
        if (contains(inside_, path))
            refuse(given_,
                   fmt::format("a virtual raster that is made of itself, by way of '{}'", path));
        if (contains(seen_, path) || !is_vrt(name)) return;
        if (inside_.size() >= kDeepest)
            refuse(given_, fmt::format("virtual rasters in each other, expected at most {} deep",
                                       kDeepest));
        if (size > kMaxBytes)
            refuse(given_, fmt::format("a virtual raster of {} MiB ('{}'), expected at most {}",
                                       size >> 20, path, kMaxBytes >> 20));
        inside_.push_back(path);
        if (const Tree tree{CPLParseXMLString(read_vsi(name, kMaxBytes).c_str())})
            elements(tree.get(), CPLGetPath(path.c_str()));
        inside_.pop_back();
        seen_.push_back(path);
    }

  private:
    static constexpr std::size_t kDeepest = 16;
    /// Of more sources than these, only those called .vrt are looked into.
    static constexpr int kManySources = 256;
    /// The largest mosaics there are have some 30 000, and 1 kB for each.
    static constexpr int kMaxSources = 200'000;
    static constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20;

    static bool is_vrt(const AllowedName& name) {
        constexpr std::uint64_t kHead = 1024;  // as far as GDAL looks
        return read_vsi(name, kHead).find("<VRTDataset") != std::string::npos;
    }

    /// All that a tree of elements names.
    void elements(const CPLXMLNode* tree, const std::string& folder) {
        std::vector<const CPLXMLNode*> open{tree};
        while (!open.empty()) {
            const CPLXMLNode* const node = open.back();
            open.pop_back();
            if (node->psNext) open.push_back(node->psNext);
            if (node->psChild) open.push_back(node->psChild);
            if (node->eType != CXT_Element) continue;
            const std::string_view name = node->pszValue;
            const char* const text = CPLGetXMLValue(node, nullptr, "");
            if (EQUAL(node->pszValue, "SourceFilename") || EQUAL(node->pszValue, "SourceDataset"))
                source(text, CPLTestBool(CPLGetXMLValue(node, "relativeToVRT", "0")) ? folder : "");
            else if (EQUAL(node->pszValue, "PixelFunctionLanguage") && EQUAL(text, "Python"))
                refuse(given_, "a virtual raster with Python code, which is not run");
            else if (name == "OOI" && EQUAL(CPLGetXMLValue(node, "key", ""), "PRELUDE_STATEMENTS"))
                refuse(given_, "a virtual raster with SQL statements, which are not run");
        }
    }

    void source(const std::string& text, const std::string& folder) {
        std::string name = text;
        if (name.starts_with('<')) {
            if (const Tree tree{CPLParseXMLString(name.c_str())}) elements(tree.get(), folder);
            return;
        }
        if (EQUALN(name.c_str(), "vrt://", 6)) name = name.substr(6, name.find('?') - 6);
        if (EQUALN(name.c_str(), "MEM:::", 6))
            refuse(given_, fmt::format("a virtual raster of the program's own memory ('{}'), "
                                       "expected files",
                                       text));
        if (!folder.empty()) name = CPLProjectRelativeFilename(folder.c_str(), name.c_str());
        if (!name_.allows(name))
            refuse(given_, fmt::format("a virtual raster of '{}', expected files of this "
                                       "machine; the net is asked only by a name on the "
                                       "command line",
                                       text));
        std::error_code unknown;
        const std::string found = file_in(name);
        const std::string_view kind = endless(fs::status(found, unknown));
        if (!found.empty() && !kind.empty())
            refuse(given_, fmt::format("a virtual raster of '{}', {}, expected files", text, kind));
        if (sources_ >= kMaxSources)
            refuse(given_,
                   fmt::format("a virtual raster of more than {} sources; cut it up", kMaxSources));
        if (++sources_ <= kManySources || name.ends_with(".vrt")) {
            file(name);
        } else if (!found.empty()) {
            const std::uintmax_t size = fs::file_size(found, unknown);
            bytes_ += unknown ? 0 : size;
        }
    }

    AllowedName name_;
    std::string given_;
    std::vector<std::string> inside_;
    std::vector<std::string> seen_;
    int sources_ = 0;
    std::uint64_t bytes_ = 0;
};

}  // namespace

std::uint64_t refuse_unsafe_vrt(const AllowedName& name) {
    VrtWalk walk(name);
    walk.file(name.text());
    return walk.bytes();
}

}  // namespace relevo::dem
