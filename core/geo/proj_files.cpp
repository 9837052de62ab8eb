#include "geo/proj_files.h"

#include <cstdio>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "geo/proj.h"

namespace relevo::geo {
namespace {

std::FILE* file_of(PROJ_FILE_HANDLE* handle) {
    return reinterpret_cast<std::FILE*>(handle);
}

/// Nothing here writes through PROJ.
PROJ_FILE_HANDLE* open_regular(PJ_CONTEXT*, const char* name, PROJ_OPEN_ACCESS access, void*) {
    if (access != PROJ_OPEN_ACCESS_READ_ONLY) return nullptr;
    const int descriptor = open(name, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) return nullptr;
    struct stat status {};
    std::FILE* const file = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)
                                ? fdopen(descriptor, "rb")
                                : nullptr;
    if (!file) close(descriptor);
    return reinterpret_cast<PROJ_FILE_HANDLE*>(file);
}

constexpr PROJ_FILE_API kRegularFiles = {
    .version = 1,
    .open_cbk = open_regular,
    .read_cbk = [](PJ_CONTEXT*, PROJ_FILE_HANDLE* file, void* to, std::size_t size,
                   void*) { return std::fread(to, 1, size, file_of(file)); },
    .write_cbk = [](PJ_CONTEXT*, PROJ_FILE_HANDLE*, const void*, std::size_t,
                    void*) { return std::size_t{0}; },
    .seek_cbk = [](PJ_CONTEXT*, PROJ_FILE_HANDLE* file, long long offset, int whence,
                   void*) { return fseeko(file_of(file), offset, whence) == 0 ? 1 : 0; },
    .tell_cbk = [](PJ_CONTEXT*, PROJ_FILE_HANDLE* file,
                   void*) { return static_cast<unsigned long long>(ftello(file_of(file))); },
    .close_cbk = [](PJ_CONTEXT*, PROJ_FILE_HANDLE* file, void*) { std::fclose(file_of(file)); },
    .exists_cbk =
        [](PJ_CONTEXT*, const char* name, void*) {
            struct stat status {};
            return stat(name, &status) == 0 ? 1 : 0;
        },
    .mkdir_cbk = [](PJ_CONTEXT*, const char*, void*) { return 0; },
    .unlink_cbk = [](PJ_CONTEXT*, const char*, void*) { return 0; },
    .rename_cbk = [](PJ_CONTEXT*, const char*, const char*, void*) { return 0; }};

}  // namespace

void open_regular_files_only(PJ_CONTEXT* context) {
    proj_context_set_fileapi(context, &kRegularFiles, nullptr);
}

}  // namespace relevo::geo
