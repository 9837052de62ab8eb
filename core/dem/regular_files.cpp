#include "dem/regular_files.h"

#include <mutex>
#include <set>
#include <string>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "dem/gdal_module.h"

namespace relevo::dem {
namespace {

void warn_of(const std::string& name) {
    static std::mutex mutex;
    static std::set<std::string>& warned = *new std::set<std::string>;  // also while GDAL ends
    {
        const std::lock_guard lock(mutex);
        if (!warned.insert(name).second) return;
    }
    log::warning(fmt::format("{}: a pipe or a device, expected a file; not read", printable(name)));
}

}  // namespace

void open_regular_files_only() {
    gdal_module().open_regular_files_only(warn_of);
}

}  // namespace relevo::dem
