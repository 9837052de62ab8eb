#include "dem/gdal_support.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>

#include <fmt/format.h>

#include "base/host_program.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_module.h"
#include "dem/guard.h"
#include "dem/interpret.h"
#include "dem/regular_files.h"

namespace relevo::dem {
namespace {

constexpr GIntBig kBlockCacheBytes = GIntBig{256} << 20;  // of GDAL's cache

void to_debug_log(CPLErr, int, const char* text) {
    log::debug(fmt::format("GDAL: {}", text));
}

}  // namespace

void prepare_gdal() {
    static std::once_flag once;
    std::call_once(once, [] {
        GDALAllRegister();
        // A file of hints beside a compressed one that is only read.
        if (!CPLGetConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", nullptr))
            CPLSetConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO");
        if (is_hosted()) return;
        // A wheel has the tables of its own GDAL. Those that GDAL_DATA names may be another's.
        const std::filesystem::path tables = share_dir() / "gdal";
        std::error_code ignored;
        if (std::filesystem::exists(tables, ignored))
            CPLSetConfigOption("GDAL_DATA", tables.c_str());
        CPLSetErrorHandler(to_debug_log);
        disarm_gdal();
        open_regular_files_only();
        // By itself it is a twentieth of the machine's memory, whatever --memory is.
        if (!CPLGetConfigOption("GDAL_CACHEMAX", nullptr))
            GDALSetCacheMax64(std::min(GDALGetCacheMax64(), kBlockCacheBytes));
    });
}

namespace {

/// The size of GDAL's cache of blocks, unless the user or a host program has set it.
class BlockCache {
  public:
    static BlockCache& instance() {
        static BlockCache cache;
        return cache;
    }
    void allow(std::int64_t bytes) {
        const std::lock_guard lock(mutex_);
        allowed_ = bytes;
        set();
    }
    void hold(std::int64_t bytes) {
        const std::lock_guard lock(mutex_);
        held_ = std::max(held_, bytes);
        set();
    }

  private:
    void set() const {
        if (!is_hosted() && !CPLGetConfigOption("GDAL_CACHEMAX", nullptr))
            GDALSetCacheMax64(std::max(allowed_, held_));
    }

    std::mutex mutex_;
    std::int64_t allowed_ = kBlockCacheBytes, held_ = 0;
};

}  // namespace

void allow_blocks(std::int64_t bytes) {
    prepare_gdal();
    BlockCache::instance().allow(bytes);
}

void hold_blocks(std::int64_t bytes) {
    BlockCache::instance().hold(bytes);
}

WithoutListing::WithoutListing(std::size_t files) : many_(files > 1000) {
    if (many_) CPLSetThreadLocalConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", "TRUE");
}

WithoutListing::~WithoutListing() {
    if (many_) CPLSetThreadLocalConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", nullptr);
}

GdalMessages::GdalMessages() {
    prepare_gdal();
    gdal_module().silence_hdf5();
    // GDAL keeps a stack of handlers for each thread.
    CPLPushErrorHandlerEx([](CPLErr severity, CPLErrorNum number,
                             const char* text) { collect(severity, number, text); },
                          this);
}

GdalMessages::~GdalMessages() {
    CPLPopErrorHandler();
}

void GdalMessages::collect(int severity, int number, const char* text) {
    to_debug_log(static_cast<CPLErr>(severity), number, text);
    if (severity >= CE_Failure)
        static_cast<GdalMessages*>(CPLGetErrorHandlerUserData())->failures_.emplace_back(text);
}

std::string GdalMessages::failure(const std::string& path) const {
    if (failures_.empty()) return {};
    std::string text = failures_.back();
    for (std::size_t at = text.find(path); !path.empty() && at != std::string::npos;
         at = text.find(path, at))
        text.erase(at, path.size());
    // What is left of "a.tif, band 1: reason" and "a.tif: reason".
    if (text.starts_with(", band ") || text.starts_with(":")) text.erase(0, text.find(':') + 1);
    std::ranges::replace(text, '\n', ' ');
    std::string_view line = trimmed(text);
    while (line.ends_with('.'))
        line.remove_suffix(1);
    return std::string(line);
}

void GdalMessages::refuse(const std::string& path, std::string_view what) const {
    const std::string reason = failure(path);
    dem::refuse(path, fmt::format("{}, {}{}", what, reason, remedy_for(path, reason)));
}

std::string wkt_of(void* crs) {
    if (!crs) return {};
    // GDAL gives a text even where it fails.
    char* text = nullptr;
    constexpr std::array<const char*, 2> kForm = {"FORMAT=WKT2_2019", nullptr};
    const bool written = OSRExportToWktEx(crs, &text, kForm.data()) == OGRERR_NONE && text;
    std::string wkt = written ? text : "";
    CPLFree(text);
    return wkt;
}

}  // namespace relevo::dem
