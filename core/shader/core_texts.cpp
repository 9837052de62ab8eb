#include "shader/core_texts.h"

#include <algorithm>

#include "base/text.h"

namespace relevo::shader {

std::optional<std::string> FolderTexts::text(std::string_view name) const {
    const std::filesystem::path path = folder_ / name;
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    return read_text(path, "shader");
}

std::vector<std::string> FolderTexts::libraries() const {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "lib", ignored))
        if (entry.path().extension() == ".glsl")
            names.push_back("lib/" + entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

std::string FolderTexts::file(std::string_view name) const {
    return (folder_ / name).string();
}

}  // namespace relevo::shader
