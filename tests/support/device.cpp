#include "support/device.h"

#include <cstdlib>

namespace relevo::test {

std::string gl_device() {
    const char* const given = std::getenv("RELEVO_TEST_DEVICE");
    return given && *given ? given : "software";
}

}  // namespace relevo::test
