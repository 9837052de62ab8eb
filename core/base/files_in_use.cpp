#include "base/files_in_use.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/object_store.h"
#include "base/text.h"

namespace relevo {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& output, std::string_view who,
                         const std::filesystem::path& input, std::string_view what) {
    bad_input(
        fmt::format("{}: {}: is {} {}, which would be overwritten; give the result another name",
                    who, printable(output.string()), what, printable(input.string())));
}

/// What a regular file is known by, whatever its names: device and inode. None where there is none.
using Identity = std::pair<dev_t, ino_t>;
std::optional<Identity> identity_of(const std::filesystem::path& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino};
}

/// The file that a write to `path` reaches, through symbolic links.
std::filesystem::path destination(std::filesystem::path path) {
    constexpr int kMostLinks = 40;  // as the kernel follows
    std::error_code error;
    for (int i = 0; i < kMostLinks; ++i) {
        if (!std::filesystem::is_symlink(std::filesystem::symlink_status(path, error))) break;
        const std::filesystem::path target = std::filesystem::read_symlink(path, error);
        if (error) break;
        path = path.parent_path() / target;
    }
    const std::filesystem::path whole = std::filesystem::absolute(path, error);
    std::filesystem::path resolved = std::filesystem::weakly_canonical(whole, error);
    return error ? whole : resolved;
}

}  // namespace

void FilesInUse::check_planned(const std::vector<std::filesystem::path>& results,
                               std::string_view who) const {
    std::map<Identity, const Input*> inputs;
    for (const Input& input : inputs_)
        if (const auto identity = identity_of(input.path)) inputs.emplace(*identity, &input);
    std::map<std::filesystem::path, const std::filesystem::path*> planned;
    for (const std::filesystem::path& result : results) {
        if (const auto identity = identity_of(result))
            if (const auto found = inputs.find(*identity); found != inputs.end())
                refuse(result, who, found->second->path, found->second->what);
        const auto [other, fresh] = planned.emplace(destination(result), &result);
        if (fresh) continue;
        if (other->second->lexically_normal() == result.lexically_normal())
            bad_input(fmt::format("{}: {}: another result has this name; give each its own", who,
                                  printable(result.string())));
        bad_input(
            fmt::format("{}: {} and {}: a symbolic link makes them one file, {}; name them apart",
                        who, printable(other->second->string()), printable(result.string()),
                        printable(other->first.string())));
    }
}

void FilesInUse::add_input(const std::filesystem::path& path, std::string_view what) {
    for (const OutputFile& output : outputs_)
        if (output.replaces(path)) refuse(output.path(), output.who(), path, what);
    if (!input_names_.insert(path.string()).second) return;
    inputs_.push_back({path, std::string(what)});
}

OutputFile& FilesInUse::open_output(const std::filesystem::path& path, bool overwrite,
                                    std::string_view who) {
    return outputs_.emplace_back(open_alone(path, overwrite, who));
}

OutputFile FilesInUse::open_alone(const std::filesystem::path& path, bool overwrite,
                                  std::string_view who) const {
    // Before OutputFile says that --overwrite would help.
    if (const auto there = identity_of(path))
        for (const Input& input : inputs_)
            if (identity_of(input.path) == there) refuse(path, who, input.path, input.what);
    if (object_store_of(path.native()))
        for (const Input& input : inputs_)
            if (input.path == path) refuse(path, who, input.path, input.what);
    OutputFile opened(path, overwrite, who);
    for (const OutputFile& other : outputs_)
        if (opened.same_as(other))
            bad_usage(fmt::format("{}: {}: another result has this name; give each its own file",
                                  who, printable(path.string())));
    return opened;
}

void FilesInUse::finish_outputs() {
    std::vector<OutputFile*> files;
    for (OutputFile& output : outputs_)
        files.push_back(&output);
    OutputFile::finish_all(files);
}

bool FilesInUse::replaces_any() const {
    return std::ranges::any_of(outputs_,
                               [](const OutputFile& output) { return output.replaces_any(); });
}

}  // namespace relevo
