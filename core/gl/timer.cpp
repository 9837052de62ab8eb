#include "gl/timer.h"

#include <epoxy/gl.h>

namespace relevo::gl {

void Timer::destroy(unsigned name) {
    glDeleteQueries(1, &name);
}

Timer::Timer() {
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    handle_ = Handle<&Timer::destroy>(name);
}

void Timer::begin() {
    ended_ = false;
    glBeginQuery(GL_TIME_ELAPSED, handle_.name());
}

void Timer::end() {
    glEndQuery(GL_TIME_ELAPSED);
    ended_ = true;
}

std::optional<double> Timer::milliseconds() const {
    if (!ended_) return std::nullopt;
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(handle_.name(), GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * 1e-6;
}

}  // namespace relevo::gl
