// Loads a native module and calls its registration, so that what goes wrong there goes wrong here.
//
// try_module LIBRARY ID: on standard output "good" and status 0, or the reason why it will not do,
// if it can still say it. Links with nothing, so that it starts in a millisecond.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <dlfcn.h>

#include "effect/abi/relevo_plugin.h"

namespace {

constexpr int kBad = 2;

void write_log(void*, int32_t, const char*) {}

relevo_log_1 log_table{sizeof(relevo_log_1), nullptr, &write_log};

const void* service(const relevo_host*, const char* name, uint32_t version) {
    return std::strcmp(name, "relevo.log") == 0 && version == 1 ? &log_table : nullptr;
}

char reason[1024] = "";

void fail(const relevo_host*, const char* text) {
    std::snprintf(reason, sizeof reason, "%s", text ? text : "");
}

int bad(const char* text) {
    std::fputs(text, stdout);
    return kBad;
}

int try_it(const char* path, const char* id) {
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        std::printf("it cannot be loaded: %s", dlerror());
        return kBad;
    }
    const auto* version = static_cast<const uint32_t*>(dlsym(library, "relevo_plugin_abi"));
    if (!version) return bad("it has no symbol relevo_plugin_abi; see RELEVO_PLUGIN");
    if (*version >> 16 != RELEVO_ABI_MAJOR) {
        std::printf(
            "expected version %u of the plugin interface but got %u.%u; build it with this "
            "program's relevo_plugin.h",
            RELEVO_ABI_MAJOR, *version >> 16, *version & 0xffff);
        return kBad;
    }
    const auto registration = reinterpret_cast<decltype(&relevo_plugin_register)>(
        dlsym(library, "relevo_plugin_register"));
    if (!registration) return bad("it has no symbol relevo_plugin_register; see RELEVO_PLUGIN");

    const relevo_host host{sizeof(relevo_host), RELEVO_ABI_VERSION, &service, &fail};
    relevo_module module{};
    module.size = sizeof module;
    try {
        if (registration(&host, &module) != RELEVO_OK) {
            std::printf("its registration failed: %s", reason[0] ? reason : "no reason given");
            return kBad;
        }
    } catch (const std::exception& error) {
        std::printf("its registration threw an exception: %s", error.what());
        return kBad;
    } catch (...) {
        return bad("its registration threw an exception");
    }
    if (!module.id || std::strcmp(module.id, id) != 0) {
        std::printf("expected the module of %s but got that of %s", id,
                    module.id ? module.id : "nobody");
        return kBad;
    }
    if (!module.create || !module.destroy) return bad("its table lacks create or destroy");
    // Said aloud: a module may end the process with status 0 itself.
    std::fputs("good", stdout);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return bad("usage: try_module LIBRARY ID");
    const int status = try_it(argv[1], argv[2]);
    std::fflush(stdout);
    // Destructors of a bad library are not to be trusted either.
    _Exit(status);
}
