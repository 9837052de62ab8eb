// Native modules whose symbols or tables are wrong, chosen by RELEVO_CASE_<name>.
#include <relevo/plugin.h>

namespace {

[[maybe_unused]] relevo_status create(const relevo_host*, void** instance) {
    *instance = nullptr;
    return RELEVO_OK;
}

[[maybe_unused]] void destroy(void*) {}

}  // namespace

extern "C" {

#if defined(RELEVO_CASE_newer)
const uint32_t relevo_plugin_abi = (RELEVO_ABI_MAJOR + 1) << 16 | 3;
#elif defined(RELEVO_CASE_older)
const uint32_t relevo_plugin_abi = 1 << 16;
#elif !defined(RELEVO_CASE_nameless)
const uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;
#endif

#if !defined(RELEVO_CASE_unregistered)
relevo_status relevo_plugin_register([[maybe_unused]] const relevo_host* host,
                                     [[maybe_unused]] relevo_module* module) {
#if defined(RELEVO_CASE_asks)
    if (!host->service(host, "relevo.weather", 1)) {
        host->fail(host, "it needs relevo.weather/1");
        return RELEVO_FAILED;
    }
#endif
#if defined(RELEVO_CASE_stranger)
    module->id = "somebody";
#else
    module->id = "native";
#endif
#if !defined(RELEVO_CASE_helpless)
    module->create = &create;
    module->destroy = &destroy;
#endif
    return RELEVO_OK;
}
#endif
}
