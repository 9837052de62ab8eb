#include "render/frame_runner.h"

#include <algorithm>
#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "render/draw_scope.h"

namespace relevo::render {
namespace {

/// Pixels that are drawn at once under a watch: as many as a usual frame has.
constexpr double kMaxWatched_px = 1 << 21;

/// Draws reach no pixel outside while this lives.
struct Scissor {
    Scissor(int x, int y, int width, int height) {
        glScissor(x, y, width, height);
        glEnable(GL_SCISSOR_TEST);
    }
    Scissor(const Scissor&) = delete;
    Scissor& operator=(const Scissor&) = delete;
    ~Scissor() { glDisable(GL_SCISSOR_TEST); }
};

/// A group of commands by which debuggers show a pass.
struct DebugGroup {
    explicit DebugGroup(const std::string& name) {
        glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name.c_str());
    }
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
    ~DebugGroup() { glPopDebugGroup(); }
};

double pixels(const PassContext& frame) {
    return double{1} * frame.width_px * frame.height_px;
}

}  // namespace

FrameRunner::FrameRunner(gl::Context& context, const StitchedFrames& frames,
                         WatchedPrograms& programs, Provider provider,
                         const shader::ParamStore& values)
    : context_(context),
      frames_(frames),
      programs_(programs),
      provider_(std::move(provider)),
      values_(values) {}

void FrameRunner::arrange(bool outside, int width_px, int height_px) {
    outside_ = outside;
    plan_ = render::plan(graph());
    targets_ = GraphTargets(graph(), plan_, width_px, height_px);
    executed_.clear();
}

const FrameGraph& FrameRunner::graph() const {
    return outside_ ? *frames_.outside : frames_.within;
}

const gl::Texture& FrameRunner::texture(std::string_view resource) const {
    const gl::Texture* const found = targets_.texture(resource);
    assert(found);
    return *found;
}

gl::Texture& FrameRunner::texture(std::string_view resource) {
    return const_cast<gl::Texture&>(std::as_const(*this).texture(resource));
}

bool FrameRunner::is_due(const Pass& pass, const PassContext& frame) {
    if (pass.when == When::Frame) return true;
    Executed now{.ground = frame.terrain.serial()};
    if (pass.when == When::Sun) now.sun = frame.inputs.sun.direction;
    if (pass.when == When::Parameters)
        for (const std::string& address : pass.parameters)
            now.values.push_back(values_.value(address));
    const auto before = executed_.find(pass.name);
    if (before != executed_.end() && before->second == now) return false;
    executed_[pass.name] = now;
    return true;
}

void FrameRunner::run(PassContext& frame, bool night, PassTimes* times) {
    std::optional<PassTimers> timers;
    if (times) timers.emplace(context_);
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
        const Pass& pass = graph().passes[static_cast<std::size_t>(plan_.steps[i].pass)];
        if (!is_due(pass, frame)) continue;
        if (timers) timers->begin(pass.name, pass.kind == PassKind::Host);
        if (plan_.steps[i].barrier) glMemoryBarrier(GL_ALL_BARRIER_BITS);
        if (poisons_) targets_.poison(graph(), plan_.steps[i]);
        const DebugGroup group(pass.name);
        execute(i, frame, night);
    }
    if (timers) *times = timers->end();
}

void FrameRunner::execute(std::size_t step, PassContext& frame, bool night) {
    const Pass& pass = graph().passes[static_cast<std::size_t>(plan_.steps[step].pass)];
    if (pass.kind == PassKind::Host) return pass.body(frame);
    const std::string& program =
        night && !pass.program_at_night.empty() ? pass.program_at_night : pass.program;
    use(program, frame.terrain);
    if (pass.kind == PassKind::Compute) return pass.body(frame);
    const gl::Framebuffer* const target = targets_.framebuffer(step);
    assert(target);
    for (std::size_t i = 0; i < pass.colours.size(); ++i)
        if (const auto& clear = pass.colours[i].clear)
            target->clear_colour(static_cast<int>(i),
                                 {(*clear)[0], (*clear)[1], (*clear)[2], (*clear)[3]});
    const DrawScope scope(*target, {.depth = pass.depth,
                                    .stencil = pass.stencil,
                                    .clips_voids = pass.clips_voids && frame.terrain.has_holes()});
    draw(pass, program, frame);
}

void FrameRunner::draw(const Pass& pass, const std::string& program, PassContext& frame) {
    const bool watched = programs_.needs_watch(program);
    if (pass.kind == PassKind::Fullscreen && watched) {
        draw_in_bands(program, frame);
    } else if (pass.kind == PassKind::Fullscreen) {
        no_inputs_.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    } else if (watched) {
        const double triangles = frame.tiles.triangles();
        // Of a large frame the vertices come alone before, so that those that never end are found
        // as soon as in a small one.
        if (pixels(frame) > kMaxWatched_px) {
            const Scissor corner(0, 0, 1, 1);
            programs_.draw_watched(program, triangles, [&] { pass.body(frame); });
        }
        programs_.draw_watched(program, pixels(frame) + triangles, [&] { pass.body(frame); });
    } else {
        pass.body(frame);
    }
    if (watched) programs_.set_proven(program);
}

/// For the same reason.
void FrameRunner::draw_in_bands(const std::string& program, const PassContext& frame) {
    const auto fill = [this] {
        no_inputs_.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    };
    if (pixels(frame) <= kMaxWatched_px)
        return programs_.draw_watched(program, pixels(frame), fill);
    const int rows = std::max(1, static_cast<int>(kMaxWatched_px / frame.width_px));
    for (int y = 0; y < frame.height_px; y += rows) {
        const Scissor band(0, y, frame.width_px, rows);
        programs_.draw_watched(program, kMaxWatched_px, fill);
    }
}

void FrameRunner::use(const std::string& program, const Terrain& terrain) {
    programs_.link(program).use();
    for (const shader::TextureUnit& unit : programs_.text(program).stitched.textures) {
        const gl::Texture* texture = targets_.texture(unit.resource);
        if (!texture) texture = provider_(unit, terrain);
        if (!texture)
            failed(fmt::format("render: the texture {} of {} does not exist", unit.resource,
                               unit.owner));
        texture->bind(static_cast<unsigned>(unit.unit));
    }
}

}  // namespace relevo::render
