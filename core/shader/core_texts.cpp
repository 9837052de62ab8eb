#include "shader/core_texts.h"

#include "base/text.h"

namespace relevo::shader {

std::optional<std::string> FolderTexts::text(std::string_view name) const {
    const std::filesystem::path path = folder_ / name;
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    return read_text(path, "shader");
}

std::string FolderTexts::file(std::string_view name) const {
    return (folder_ / name).string();
}

}  // namespace relevo::shader
