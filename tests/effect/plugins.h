#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "effect/selection.h"
#include "support/support.h"

namespace relevo::effect::test {

/// A variable of the environment while this lives.
struct Variable {
    Variable(const char* n, const std::string& value) : name(n) { setenv(name, value.c_str(), 1); }
    ~Variable() { unsetenv(name); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    const char* name;
};

/// A folder of plugins that a test writes.
class Plugins {
  public:
    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path data() const { return folder_ / "data"; }
    std::filesystem::path plugins() const { return folder_ / "plugins"; }

    void write(const std::filesystem::path& file, std::string_view text) const {
        std::filesystem::create_directories((folder_ / file).parent_path());
        std::ofstream(folder_ / file, std::ios::binary) << text;
    }

    /// A plugin with `members` beside the keys that every manifest has, and that GLSL; by default a
    /// function for the hook albedo.
    void add(const std::string& id, const std::string& members = "", std::string glsl = "") const {
        const std::filesystem::path own = std::filesystem::path("plugins") / id;
        write(own / "plugin.json", R"({"format": 1, "id": ")" + id + R"(", "name": ")" + id +
                                       R"(", "version": "1.0")" +
                                       (members.empty() ? "" : ", " + members) + "}");
        if (glsl.empty())
            glsl = "void " + id + "_on_albedo(inout Surface s) { s.diffuse *= 0.5; }\n";
        write(own / (id + ".glsl"), glsl);
    }

    Registry load() const { return Registry::load({plugins()}, data()); }

    /// The text without the test's own folder.
    std::string relative(std::string text) const {
        const std::string folder = folder_.string() + '/';
        for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
            text.erase(at, folder.size());
        return text;
    }

  private:
    std::filesystem::path folder_ = relevo::test::scratch_dir();
};

inline std::vector<std::string> ids(const Selection& selection) {
    std::vector<std::string> result;
    for (const Effect* effect : selection.effects)
        result.push_back(effect->id());
    return result;
}

}  // namespace relevo::effect::test
