#include "gl/fence.h"

#include <utility>

#include <epoxy/gl.h>

#include "gl/errors.h"

namespace relevo::gl {
namespace {

GLsync sync_of(void* sync) {
    return static_cast<GLsync>(sync);
}

}  // namespace

Fence Fence::insert() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    return fence;
}

Fence::Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
}

Fence::~Fence() {
    if (sync_) glDeleteSync(sync_of(sync_));
}

bool Fence::has_passed() const {
    return wait(std::chrono::milliseconds(0));
}

void Fence::wait_on_device() const {
    if (sync_) glWaitSync(sync_of(sync_), 0, GL_TIMEOUT_IGNORED);
}

bool Fence::wait(std::chrono::milliseconds at_most) const {
    if (!sync_) return true;
    const auto ns = std::chrono::nanoseconds(at_most).count();
    const GLenum found = glClientWaitSync(sync_of(sync_), 0, static_cast<GLuint64>(ns));
    if (found == GL_ALREADY_SIGNALED || found == GL_CONDITION_SATISFIED) return true;
    // On a lost device a wait may fail, or never end.
    throw_if_lost();
    return found != GL_TIMEOUT_EXPIRED;
}

}  // namespace relevo::gl
