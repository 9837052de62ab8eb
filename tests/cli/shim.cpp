// Loaded before the C library: a machine that refuses what $RELEVO_SHIM names.

#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

bool refuses(const char* what) {
    const char* all = std::getenv("RELEVO_SHIM");
    return all && std::strstr(all, what);
}

}  // namespace

/// "memory": there are no 512 KiB in one piece.
void* operator new(std::size_t size) {
    void* const memory = size > (1U << 19) && refuses("memory") ? nullptr : std::malloc(size);
    if (!memory) throw std::bad_alloc();
    return memory;
}

extern "C" {

/// "unnamed": the file system has no unnamed files.
int openat(int folder, const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    if ((flags & O_TMPFILE) == O_TMPFILE && refuses("unnamed")) {
        errno = EOPNOTSUPP;
        return -1;
    }
    return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

/// "pread": of a file that is read in pieces of 1 MiB the disk gives the first one alone.
ssize_t pread(int file, void* to, size_t size, off_t at) {
    if (at > 0 && size == 1U << 20 && refuses("pread")) {
        errno = EIO;
        return -1;
    }
    return static_cast<ssize_t>(syscall(SYS_pread64, file, to, size, at));
}

/// "clock": it is 124 years later.
int clock_gettime(clockid_t clock, struct timespec* time) {
    const long result = syscall(SYS_clock_gettime, clock, time);
    if (result == 0 && clock == CLOCK_REALTIME && refuses("clock"))
        time->tv_sec += time_t{124} * 31'556'952;
    return static_cast<int>(result);
}

/// "encoders": FFmpeg has none.
const void* avcodec_find_encoder_by_name(const char* name) {
    if (refuses("encoders")) return nullptr;
    using Find = const void* (*)(const char*);
    const auto find = reinterpret_cast<Find>(dlsym(RTLD_NEXT, "avcodec_find_encoder_by_name"));
    return find ? find(name) : nullptr;
}

/// "jpeg": libjpeg finds no memory, and does what it does then.
void jpeg_finish_compress(void*) {
    if (refuses("jpeg")) std::exit(EXIT_FAILURE);
}
}
