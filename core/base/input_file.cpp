#include "base/input_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace relevo {

InputFile::InputFile(const AllowedName& name, std::string_view who)
    // A pipe without a writer would not be opened before there is one.
    : descriptor_(open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    struct stat status {};
    const bool opened = descriptor_ >= 0 && fstat(descriptor_, &status) == 0;
    const char* reason = !opened                    ? std::strerror(errno)
                         : !S_ISREG(status.st_mode) ? "it is not a regular file"
                                                    : nullptr;
    if (reason) {
        if (descriptor_ >= 0) close(descriptor_);
        bad_input(fmt::format("{}: {}: cannot be read, {}", who, name.text(), reason));
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
    close(descriptor_);
}

InputStream input_stream(const AllowedName& name) {
    return InputStream(name.text(), std::ios::binary);
}

}  // namespace relevo
