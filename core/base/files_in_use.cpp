#include "base/files_in_use.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"

namespace relevo {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& output, std::string_view who,
                         const std::filesystem::path& input, std::string_view what) {
    bad_input(
        fmt::format("{}: {}: is {} {}, which would be overwritten; give the result another name",
                    who, printable(output.string()), what, printable(input.string())));
}

}  // namespace

void FilesInUse::add_input(const std::filesystem::path& path, std::string_view what) {
    for (const OutputFile& output : outputs_)
        if (output.replaces(path)) refuse(output.path(), output.who(), path, what);
    inputs_.push_back({path, std::string(what)});
}

OutputFile& FilesInUse::open_output(const std::filesystem::path& path, bool overwrite,
                                    std::string_view who) {
    return outputs_.emplace_back(open_alone(path, overwrite, who));
}

OutputFile FilesInUse::open_alone(const std::filesystem::path& path, bool overwrite,
                                  std::string_view who) const {
    for (const Input& input : inputs_) {
        // Before OutputFile says that --overwrite would help.
        std::error_code ignored;
        if (std::filesystem::is_regular_file(input.path, ignored) &&
            std::filesystem::equivalent(path, input.path, ignored))
            refuse(path, who, input.path, input.what);
    }
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
    return std::any_of(outputs_.begin(), outputs_.end(),
                       [](const OutputFile& output) { return output.replaces_any(); });
}

}  // namespace relevo
