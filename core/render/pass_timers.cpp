#include "render/pass_timers.h"

#include <epoxy/gl.h>

namespace relevo::render {

void PassTimers::destroy(unsigned name) {
    glDeleteQueries(1, &name);
}

PassTimers::PassTimers(gl::Context& context)
    : context_(context), stamps_(!context.info().device.software) {}

void PassTimers::begin(const std::string& pass, bool on_host) {
    if (!stamps_) context_.finish();
    Query query;
    if (stamps_) {
        GLuint name = 0;
        glCreateQueries(GL_TIMESTAMP, 1, &name);
        query = Query(name);
        glQueryCounter(name, GL_TIMESTAMP);
    }
    marks_.push_back({pass, on_host, Clock::now(), std::clock(), std::move(query)});
}

PassTimes PassTimers::end() {
    begin("", /*on_host=*/true);
    PassTimes times;
    for (std::size_t i = 0; i + 1 < marks_.size(); ++i) {
        const Mark &from = marks_[i], &to = marks_[i + 1];
        double ms = std::chrono::duration<double, std::milli>(to.at - from.at).count();
        if (stamps_ && !from.on_host) {
            GLuint64 began = 0, ended = 0;
            glGetQueryObjectui64v(from.stamp.name(), GL_QUERY_RESULT, &began);
            glGetQueryObjectui64v(to.stamp.name(), GL_QUERY_RESULT, &ended);
            ms = static_cast<double>(ended - began) * 1e-6;
        }
        const auto ticks = static_cast<double>(to.processor - from.processor);
        times.push_back({from.pass, ms, 1e3 * ticks / CLOCKS_PER_SEC});
    }
    marks_.clear();
    return times;
}

}  // namespace relevo::render
