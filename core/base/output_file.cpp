#include "base/output_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"

namespace relevo {

void check_output_file(const std::filesystem::path& path, bool overwrite, std::string_view who) {
    const std::string subject = path.string();
    const std::filesystem::path folder =
        path.parent_path().empty() ? std::filesystem::path(".") : path.parent_path();
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        bad_input(fmt::format("{}: {}: the folder {} does not exist; make it first", who, subject,
                              folder.string()));
    if (access(folder.c_str(), W_OK) != 0)
        bad_input(fmt::format("{}: {}: the folder {} cannot be written to", who, subject,
                              folder.string()));
    if (std::filesystem::is_directory(path, ignored))
        bad_input(fmt::format("{}: {}: is a folder", who, subject));
    if (!overwrite && std::filesystem::exists(path, ignored))
        bad_input(fmt::format("{}: {}: exists; pass --overwrite to replace it", who, subject));
}

PartialFile::PartialFile(const std::filesystem::path& path)
    : path_(path.parent_path() / fmt::format(".{}.{}.part", path.filename().string(), getpid())) {}

PartialFile::~PartialFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

void PartialFile::become(const std::filesystem::path& target, bool overwrite,
                         std::string_view who) const {
    std::error_code error;
    if (overwrite) {
        std::filesystem::rename(path_, target, error);
    } else {
        // A link fails where the name has been taken meanwhile; a rename would not.
        std::filesystem::create_hard_link(path_, target, error);
        if (error == std::errc::operation_not_permitted ||
            error == std::errc::operation_not_supported ||
            error == std::errc::function_not_supported) {
            check_output_file(target, overwrite, who);
            std::filesystem::rename(path_, target, error);
        }
    }
    if (error)
        failed(fmt::format("{}: {}: cannot be written, {}", who, target.string(), error.message()));
}

void write_text(const std::filesystem::path& path, std::string_view text, bool overwrite,
                std::string_view who) {
    check_output_file(path, overwrite, who);
    const PartialFile part(path);
    std::ofstream file(part.path(), std::ios::binary);
    file << text;
    file.close();
    if (!file)
        failed(
            fmt::format("{}: {}: cannot be written, {}", who, path.string(), std::strerror(errno)));
    part.become(path, overwrite, who);
}

}  // namespace relevo
