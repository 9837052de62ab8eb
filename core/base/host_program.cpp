#include "base/host_program.h"

#include <atomic>

namespace relevo {
namespace {

std::atomic<bool> hosted{false};

}  // namespace

void set_hosted() {
    hosted = true;
}

bool is_hosted() {
    return hosted;
}

}  // namespace relevo
