#include <cstdlib>

#include <gtest/gtest.h>

#include "support/support.h"

namespace relevo::test {
namespace {

/// Of this program and of those that it starts. Mesa's llvmpipe would optimise each GL program for
/// seconds, to draw frames that take milliseconds; the pixels are the same. What it compiled is
/// kept for other tests, whichever home or cache folder they set.
void set_up_mesa() {
    setenv("GALLIVM_PERF", "nopt", 0);
    setenv("MESA_SHADER_CACHE_DIR", (build_dir() / "shader_cache").c_str(), 0);
}

}  // namespace
}  // namespace relevo::test

/// As any GoogleTest program; but a run that skips a case, and in which none fails, ends with
/// RELEVO_SKIP_STATUS where that is set, so that ctest tells of it.
int main(int argc, char** argv) {
    relevo::test::set_up_mesa();
    testing::InitGoogleTest(&argc, argv);
    const int status = RUN_ALL_TESTS();
    const char* const skipped = std::getenv("RELEVO_SKIP_STATUS");
    if (status == 0 && skipped && testing::UnitTest::GetInstance()->skipped_test_count() > 0)
        return std::atoi(skipped);
    return status;
}
