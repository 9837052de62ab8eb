#include "effect/native_module.h"

#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/temporary_folder.h"
#include "effect/module_trial.h"
#include "geo/gdal_library.h"

namespace relevo::effect {
namespace {

[[noreturn]] void refuse_library(const std::filesystem::path& library, std::string_view what) {
    bad_input(fmt::format("{}: {}: {}", kPluginWho, library.string(), what));
}

const void* log_service(const relevo_host*, const char* name, uint32_t version) {
    static const relevo_log_1 table{sizeof(relevo_log_1), 0, nullptr,
                                    [](void*, int32_t level, const char* text) {
                                        if (text) log_of_module(level, text);
                                    }};
    return name && std::strcmp(name, "relevo.log") == 0 && version == 1 ? &table : nullptr;
}

/// A copy of a library under a name that no library had before. It is removed with this.
class PrivateCopy {
  public:
    explicit PrivateCopy(const std::filesystem::path& library) {
        if (folder_.path().empty())
            refuse_library(library,
                           "it is loaded already, and no folder for a copy can be created");
        std::error_code error;
        std::filesystem::copy_file(library, file(library), error);
        if (error) refuse_library(library, fmt::format("it cannot be copied, {}", error.message()));
    }

    std::filesystem::path file(const std::filesystem::path& library) const {
        return folder_.path() / library.filename();
    }

  private:
    TemporaryFolder folder_{"relevo-module"};
};

/// Loads a library as it is on disk now. dlopen() would return one of the same name that is still
/// loaded, also after the file was built again.
void* open_library(const std::filesystem::path& library) {
    constexpr int kFlags = RTLD_NOW | RTLD_LOCAL;
    void* const loaded = dlopen(library.c_str(), kFlags | RTLD_NOLOAD);
    if (!loaded) return dlopen(library.c_str(), kFlags);
    dlclose(loaded);
    const PrivateCopy copy(library);
    return dlopen(copy.file(library).c_str(), kFlags);
}

}  // namespace

void NativeModule::Close::operator()(void* library) const {
    const ModuleCall call(*process, "unloading");
    dlclose(library);
}

void log_of_module(int level, const char* text) {
    if (level >= RELEVO_LOG_WARNING)
        log::warning(text);
    else if (level == RELEVO_LOG_INFO)
        log::info(text);
    else
        log::debug(text);
}

std::filesystem::path module_file(const Manifest& manifest) {
    const std::string name = manifest.module + ".so";
    const std::filesystem::path own = manifest.folder / name;
    const std::filesystem::path shipped = module_dir() / "plugins" / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(own, ignored)) return own;
    if (std::filesystem::is_regular_file(shipped, ignored)) return shipped;
    bad_input(fmt::format("{}: {}: module {} is in neither {} nor {}; build it", kPluginWho,
                          manifest.file.string(), manifest.module, own.string(), shipped.string()));
}

NativeModule NativeModule::load(const Manifest& manifest, const shader::ParamStore& values) {
    const std::filesystem::path library = module_file(manifest);
    NativeModule module;
    for (const MarksSpec& marks : manifest.marks)
        if (marks.from.empty()) module.mark_lists_.push_back(marks.name);
    const std::string fault =
        try_module(library, manifest.id, manifest.folder, values, module.mark_lists_);
    if (!fault.empty()) refuse_library(library, fault);

    module.folder_ = manifest.folder;
    // Of libraries that were loaded later an exit destroys what they have before it comes to our
    // handler, while another thread may use them.
    geo::load_gdal();
    module.process_ = std::make_unique<ModuleInProcess>(manifest.id, library);
    const ModuleCall call(*module.process_, "registration");
    module.handle_ = {open_library(library), Close{module.process_.get()}};
    if (!module.handle_) refuse_library(library, fmt::format("it cannot be loaded: {}", dlerror()));
    const auto registration = reinterpret_cast<decltype(&relevo_plugin_register)>(
        dlsym(module.handle_.get(), "relevo_plugin_register"));
    static const relevo_host host{sizeof(relevo_host), RELEVO_ABI_VERSION, &log_service,
                                  [](const relevo_host*, const char*) {}};
    module.functions_.size = sizeof module.functions_;
    bool good = registration != nullptr;
    try {
        good = good && registration(&host, &module.functions_) == RELEVO_OK;
    } catch (...) {
        good = false;
    }
    if (!good) refuse_library(library, "its registration succeeded in the trial, but then failed");
    module.process_->set_address(reinterpret_cast<const void*>(registration));
    return module;
}

}  // namespace relevo::effect
