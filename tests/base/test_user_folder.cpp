#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/paths.h"

namespace relevo {
namespace {

TEST(UserFolder, IsThatOfTheSpecification) {
    const auto folder = [](const char* cache, const char* home) {
        const pid_t child = fork();
        if (child == 0) {
            setenv("XDG_CACHE_HOME", cache, 1);
            setenv("HOME", home, 1);
            const std::string found = user_folder("XDG_CACHE_HOME", ".cache").string();
            _exit(found == "/c" ? 1 : found == "/h/.cache" ? 2 : found.empty() ? 3 : 4);
        }
        int status = 0;
        waitpid(child, &status, 0);
        return WEXITSTATUS(status);
    };
    EXPECT_EQ(folder("/c", "/h"), 1);
    EXPECT_EQ(folder("", "/h"), 2);
    EXPECT_EQ(folder("relative", "/h"), 2);
    EXPECT_EQ(folder("", ""), 3);
}

}  // namespace
}  // namespace relevo
