// Preloaded into the program it counts what is asked of the GL device, in the file named
// RELEVO_COUNT_GL: seven numbers of 64 bits in the order of `Count`. For bench_gl.py.
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace {

enum Count { Frames, Draws, BufferBytes, TextureBytes, ReadBytes, Reads, Waits, kCounts };

std::atomic<std::uint64_t>* counts = nullptr;

void count(Count which, std::int64_t by = 1) {
    if (counts) counts[which].fetch_add(static_cast<std::uint64_t>(by), std::memory_order_relaxed);
}

std::int64_t bytes_a_texel(GLenum format, GLenum type) {
    const int channels = format == GL_RG || format == GL_RG_INTEGER       ? 2
                         : format == GL_RGBA || format == GL_RGBA_INTEGER ? 4
                                                                          : 1;
    const int bytes = type == GL_FLOAT || type == GL_UNSIGNED_INT   ? 4
                      : type == GL_UNSIGNED_BYTE || type == GL_BYTE ? 1
                                                                    : 2;
    return std::int64_t{channels} * bytes;
}

/// Calls a function of libepoxy through its pointer, which the first call replaces by the driver's.
template <typename Function>
struct Hook {
    Function* pointer = nullptr;  // libepoxy's
    std::atomic<Function> drivers = nullptr;
    Function first = nullptr, ours = nullptr;
    std::mutex mutex;

    void install(const char* name, Function own) {
        pointer = static_cast<Function*>(dlsym(RTLD_DEFAULT, name));
        if (!pointer) return;
        first = *pointer;
        ours = own;
        *pointer = own;
    }
    template <typename... Arguments>
    auto call(Arguments... arguments) {
        if (drivers) return drivers.load()(arguments...);
        const std::lock_guard lock(mutex);
        *pointer = first;
        struct Restore {
            Hook& hook;
            ~Restore() {
                hook.drivers = *hook.pointer;
                *hook.pointer = hook.ours;
            }
        } restore{*this};
        return first(arguments...);
    }
};

#define RELEVO_HOOK(name) Hook<decltype(epoxy_##name)> hook_##name
RELEVO_HOOK(glPushDebugGroup);
RELEVO_HOOK(glDrawArrays);
RELEVO_HOOK(glMultiDrawElementsIndirect);
RELEVO_HOOK(glDrawElementsInstancedBaseInstance);
RELEVO_HOOK(glDrawElementsInstancedBaseVertexBaseInstance);
RELEVO_HOOK(glNamedBufferSubData);
RELEVO_HOOK(glTextureSubImage2D);
RELEVO_HOOK(glTextureSubImage3D);
RELEVO_HOOK(glGetTextureSubImage);
RELEVO_HOOK(glGetNamedBufferSubData);
RELEVO_HOOK(glFinish);
RELEVO_HOOK(glClientWaitSync);

__attribute__((constructor)) void install() {
    const char* const file = std::getenv("RELEVO_COUNT_GL");
    const int handle = file ? open(file, O_RDWR | O_CREAT, 0600) : -1;
    constexpr std::size_t kBytes = sizeof(std::uint64_t) * kCounts;
    if (handle < 0 || ftruncate(handle, kBytes) != 0) return;
    counts = static_cast<std::atomic<std::uint64_t>*>(
        mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, handle, 0));
#define RELEVO_INSTALL(name, ...) hook_##name.install("epoxy_" #name, __VA_ARGS__)
    RELEVO_INSTALL(glPushDebugGroup,
                   [](GLenum source, GLuint id, GLsizei length, const char* text) {
                       if (std::strcmp(text, "geometry") == 0) count(Frames);
                       hook_glPushDebugGroup.call(source, id, length, text);
                   });
    RELEVO_INSTALL(glDrawArrays, [](GLenum mode, GLint first, GLsizei number) {
        count(Draws);
        hook_glDrawArrays.call(mode, first, number);
    });
    RELEVO_INSTALL(glMultiDrawElementsIndirect,
                   [](GLenum mode, GLenum type, const void* at, GLsizei number, GLsizei stride) {
                       count(Draws);
                       hook_glMultiDrawElementsIndirect.call(mode, type, at, number, stride);
                   });
    RELEVO_INSTALL(
        glDrawElementsInstancedBaseInstance, [](GLenum mode, GLsizei number, GLenum type,
                                                const void* at, GLsizei instances, GLuint first) {
            count(Draws);
            hook_glDrawElementsInstancedBaseInstance.call(mode, number, type, at, instances, first);
        });
    RELEVO_INSTALL(glDrawElementsInstancedBaseVertexBaseInstance,
                   [](GLenum mode, GLsizei number, GLenum type, const void* at, GLsizei instances,
                      GLint vertex, GLuint first) {
                       count(Draws);
                       hook_glDrawElementsInstancedBaseVertexBaseInstance.call(
                           mode, number, type, at, instances, vertex, first);
                   });
    RELEVO_INSTALL(glNamedBufferSubData,
                   [](GLuint buffer, GLintptr offset, GLsizeiptr size, const void* bytes) {
                       count(BufferBytes, size);
                       hook_glNamedBufferSubData.call(buffer, offset, size, bytes);
                   });
    RELEVO_INSTALL(glTextureSubImage2D, [](GLuint texture, GLint level, GLint x, GLint y,
                                           GLsizei width, GLsizei height, GLenum format,
                                           GLenum type, const void* texels) {
        count(TextureBytes, std::int64_t{width} * height * bytes_a_texel(format, type));
        hook_glTextureSubImage2D.call(texture, level, x, y, width, height, format, type, texels);
    });
    RELEVO_INSTALL(glTextureSubImage3D, [](GLuint texture, GLint level, GLint x, GLint y, GLint z,
                                           GLsizei width, GLsizei height, GLsizei depth,
                                           GLenum format, GLenum type, const void* texels) {
        count(TextureBytes, std::int64_t{width} * height * depth * bytes_a_texel(format, type));
        hook_glTextureSubImage3D.call(texture, level, x, y, z, width, height, depth, format, type,
                                      texels);
    });
    RELEVO_INSTALL(
        glGetTextureSubImage,
        [](GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
           GLsizei depth, GLenum format, GLenum type, GLsizei size, void* texels) {
            count(ReadBytes, std::int64_t{width} * height * depth * bytes_a_texel(format, type));
            count(Reads);
            hook_glGetTextureSubImage.call(texture, level, x, y, z, width, height, depth, format,
                                           type, size, texels);
        });
    RELEVO_INSTALL(glGetNamedBufferSubData,
                   [](GLuint buffer, GLintptr offset, GLsizeiptr size, void* bytes) {
                       count(ReadBytes, size);
                       count(Reads);
                       hook_glGetNamedBufferSubData.call(buffer, offset, size, bytes);
                   });
    RELEVO_INSTALL(glFinish, [] {
        count(Waits);
        hook_glFinish.call();
    });
    RELEVO_INSTALL(glClientWaitSync, [](GLsync sync, GLbitfield flags, GLuint64 at_most_ns) {
        const GLenum found = hook_glClientWaitSync.call(sync, flags, at_most_ns);
        // One that had passed already, or that is only asked about, waits for nothing.
        if (at_most_ns > 0 && found != GL_ALREADY_SIGNALED) count(Waits);
        return found;
    });
}

}  // namespace
