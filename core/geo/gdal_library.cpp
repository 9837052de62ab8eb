#include "geo/gdal_library.h"

#include <string>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"

namespace relevo::geo {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    const char* const reason = dlerror();
    failed(fmt::format("GDAL cannot be loaded, {}; install it (libgdal32)",
                       reason ? reason : what.c_str()));
}

void* module() {
    static void* const loaded = [] {
        const std::string path = (module_dir() / "gdal.so").string();
        void* const opened = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
        if (!opened) refuse(path);
        return opened;
    }();
    return loaded;
}

}  // namespace

void* gdal_function(const char* name) {
    // Of the module, or of the libraries that it is linked with.
    void* const found = dlsym(module(), name);
    if (!found) refuse(name);
    return found;
}

void load_gdal() {
    module();
}

}  // namespace relevo::geo
