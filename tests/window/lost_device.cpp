// Preloaded into a program: the driver reports that the device was lost, once for each file named
// RELEVO_TEST_LOSE that appears, to the thread that asks first.
#include <cstdlib>

#include <dlfcn.h>
#include <unistd.h>

namespace {

unsigned reset_status() {
    constexpr unsigned kGuilty = 0x8253;  // GL_GUILTY_CONTEXT_RESET
    const char* const file = std::getenv("RELEVO_TEST_LOSE");
    return file && unlink(file) == 0 ? kGuilty : 0;
}

__attribute__((constructor)) void replace() {
    // Where libepoxy has its pointer to the function.
    if (void* const at = dlsym(RTLD_DEFAULT, "epoxy_glGetGraphicsResetStatus"))
        *static_cast<unsigned (**)()>(at) = reset_status;
}

}  // namespace
