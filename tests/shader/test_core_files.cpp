// What holds of core's own GLSL, read as text.
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "base/text.h"
#include "support/support.h"

namespace relevo::shader::test_core_files {
namespace {

std::string core_file(const std::string& name) {
    return read_text(test::source_dir() / "shaders" / name, "test");
}

/// Members of `struct Surface`.
std::set<std::string> members_of_surface() {
    const std::string types = core_file("lib/types.glsl");
    const std::size_t begin = types.find("struct Surface {"), end = types.find("};", begin);
    const std::string body =
        std::regex_replace(types.substr(begin, end - begin), std::regex("//[^\n]*"), "");
    std::set<std::string> members;
    const std::regex name("([a-z_]+)\\s*[,;]");
    for (std::sregex_iterator it(body.begin(), body.end(), name), none; it != none; ++it)
        members.insert((*it)[1]);
    return members;
}

TEST(CoreFiles, FillEveryMemberOfASurface) {
    const std::set<std::string> members = members_of_surface();
    ASSERT_GT(members.size(), 25U);
    for (const char* file : {"terrain.frag.glsl", "side.frag.glsl"}) {
        const std::string text = core_file(file);
        for (const std::string& member : members)
            EXPECT_TRUE(std::regex_search(text, std::regex("\\bs\\." + member + "\\s*=[^=]")))
                << file << ": s." << member;
    }
}

}  // namespace
}  // namespace relevo::shader::test_core_files
