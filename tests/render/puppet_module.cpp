// A native module that does in prepare() what the test that loads it says.
#include <relevo/plugin.h>

extern "C" {

RELEVO_PLUGIN_EXPORT relevo_status (*puppet_prepare)(const relevo_host*) = nullptr;
RELEVO_PLUGIN_EXPORT extern const uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;

static relevo_status create(const relevo_host* host, void** instance) {
    *instance = const_cast<relevo_host*>(host);
    return RELEVO_OK;
}

static void destroy(void*) {}

static relevo_status prepare(void* instance) {
    return puppet_prepare ? puppet_prepare(static_cast<const relevo_host*>(instance)) : RELEVO_OK;
}

RELEVO_PLUGIN_EXPORT relevo_status relevo_plugin_register(const relevo_host*,
                                                          relevo_module* module) {
    module->id = "puppet";
    module->create = &create;
    module->prepare = &prepare;
    module->destroy = &destroy;
    return RELEVO_OK;
}
}
