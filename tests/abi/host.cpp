// A host of stand-in services that reports what a module says: host MODULE FOLDER [old-host].
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <dlfcn.h>

#include "effect/stand_in_host.h"

int main(int argc, char** argv) {
    using namespace relevo::effect;
    if (argc < 3) return 2;
    StandInHost services(argv[2]);
    services.add_parameter("probe.size", false, {3, 0, 0, 0});
    services.add_parameter("probe.level", true, {});
    services.add_text("probe.track");
    services.add_marks("places");
    void* library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) return std::printf("%s\n", dlerror()), 1;
    const auto* version = static_cast<const std::uint32_t*>(dlsym(library, "relevo_plugin_abi"));
    const auto registration = reinterpret_cast<decltype(&relevo_plugin_register)>(
        dlsym(library, "relevo_plugin_register"));
    if (!version || !registration) return std::puts("a symbol is missing"), 1;
    const auto failed = [&](const char* where) {
        return std::printf("%s: %s\n", where, services.reason().c_str()), 1;
    };
    relevo_module module{};
    module.size = sizeof module;
    const relevo_host* host = services.host();
    relevo_host other = *host;
    if (argc > 3 && std::strcmp(argv[3], "older-major") == 0) other.abi_version = 1 << 16;
    if (argc > 3 && std::strcmp(argv[3], "small-table") == 0) module.size = 16;
    if (argc > 3) {
        // A copy of the host has no services of its own: only the registration is tried.
        static const relevo_host* whole = host;
        other.fail = [](const relevo_host*, const char* reason) { whole->fail(whole, reason); };
        if (registration(&other, &module) != RELEVO_OK) return failed("registration");
        return 0;
    }
    if (registration(host, &module) != RELEVO_OK) return failed("registration");
    services.offer_all();
    void* instance = nullptr;
    if (module.create(host, &instance) != RELEVO_OK) return failed("create");
    for (int frame = 0; frame < 3; ++frame) {
        services.begin_frame(frame);
        if (module.prepare(instance) != RELEVO_OK) return failed("prepare");
        services.end_frame();
    }
    module.destroy(instance);
    std::printf("ok, interface %u.%u of the module\n", *version >> 16, *version & 0xffff);
    return 0;
}
