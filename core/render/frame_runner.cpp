#include "render/frame_runner.h"

#include <algorithm>
#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "render/draw_scope.h"

namespace relevo::render {
namespace {

/// Most pixels drawn at once under a watch: about a usual frame.
constexpr double kMaxWatched_px = 1 << 21;

/// Restricts draws to a rectangle.
struct Scissor {
    explicit Scissor(const PixelRectangle& to) {
        glScissor(to.left, to.bottom, to.width, to.height);
        glEnable(GL_SCISSOR_TEST);
    }
    Scissor(const Scissor&) = delete;
    Scissor& operator=(const Scissor&) = delete;
    ~Scissor() { glDisable(GL_SCISSOR_TEST); }
};

/// Names a pass for graphics debuggers.
struct DebugGroup {
    explicit DebugGroup(const std::string& name) {
        glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name.c_str());
    }
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
    ~DebugGroup() { glPopDebugGroup(); }
};

double pixels(const PixelRectangle& of) {
    return double{1} * of.width * of.height;
}

PixelRectangle all_of(const gl::Framebuffer& target) {
    return {0, 0, target.extent().width, target.extent().height};
}

}  // namespace

FrameRunner::FrameRunner(gl::Context& context, const StitchedFrames& frames,
                         WatchedPrograms& programs, TexturePool& pool, Provider provider,
                         const shader::ParamStore& values)
    : context_(context),
      frames_(frames),
      programs_(programs),
      pool_(pool),
      provider_(std::move(provider)),
      values_(values) {}

const FrameGraph& FrameRunner::graph_of(bool outside) const {
    return outside ? *frames_.outside : frames_.within;
}

void FrameRunner::arrange(bool outside, int width_px, int height_px) {
    Plan plan = render::plan(graph_of(outside));
    GraphTargets targets(graph_of(outside), plan, width_px, height_px, pool_);
    outside_ = outside;
    plan_ = std::move(plan);
    targets_ = std::move(targets);
    is_arranged_ = true;
    forget_remade();
    pool_.trim();
}

void FrameRunner::release() {
    targets_ = {};
    is_arranged_ = false;
}

/// Passes that write to new targets must run again.
void FrameRunner::forget_remade() {
    for (const Pass& pass : graph().passes)
        for (const Access& access : accesses(pass))
            if (access.mode != Access::Mode::Read &&
                graph().find(access.version.resource)->lifetime != Lifetime::Provided)
                executed_.erase(pass.name);
}

const gl::Texture& FrameRunner::texture(std::string_view resource) {
    const gl::Texture* const found = targets_.texture(resource);
    assert(found);
    return *found;
}

FrameRunner::Inputs FrameRunner::inputs_of(const Pass& pass, const PassContext& frame) const {
    Inputs inputs{.ground = frame.terrain.serial(), .exaggeration = frame.inputs.exaggeration};
    if (pass.when == When::Sun) inputs.sun = frame.inputs.sun.direction;
    if (pass.when == When::Parameters)
        for (const std::string& address : pass.parameters)
            inputs.values.push_back(values_.value(address));
    return inputs;
}

void FrameRunner::run(PassContext& frame, bool night, PassTimes* times) {
    std::optional<PassTimers> timers;
    if (times) timers.emplace(context_);
    changed_.clear();
    for (std::size_t step = 0; step < plan_.steps.size(); ++step)
        run_step(step, frame, night, timers ? &*timers : nullptr);
    has_drawn_ = true;
    if (timers) *times = timers->end();
}

void FrameRunner::run_step(std::size_t step, PassContext& frame, bool night, PassTimers* timers) {
    const Plan::Step& planned = plan_.steps[step];
    const Pass& pass = graph().passes[static_cast<std::size_t>(planned.pass)];
    const bool rare = pass.when != When::Frame;
    // Later passes rely on it, too, whether this one runs or not.
    if (planned.barrier) glMemoryBarrier(GL_ALL_BARRIER_BITS);
    if (rare && !is_due(pass, frame)) return;
    if (timers) timers->begin(pass.name, pass.kind == PassKind::Host);
    if (poisons_) targets_.poison(graph(), planned);
    const DebugGroup group(pass.name);
    frame.pass = &pass;
    execute(step, frame, night);
    if (!rare) return;
    executed_[pass.name] = inputs_of(pass, frame);
    for (const Access& access : accesses(pass))
        if (access.mode != Access::Mode::Read) changed_.insert(access.version.resource);
}

bool FrameRunner::is_due(const Pass& pass, const PassContext& frame) const {
    const auto before = executed_.find(pass.name);
    if (before == executed_.end() || before->second != inputs_of(pass, frame)) return true;
    return std::ranges::any_of(accesses(pass), [&](const Access& access) {
        return changed_.contains(access.version.resource);
    });
}

void FrameRunner::execute(std::size_t step, PassContext& frame, bool night) {
    const Pass& pass = graph().passes[static_cast<std::size_t>(plan_.steps[step].pass)];
    if (pass.is_needed && !pass.is_needed(frame)) return;
    if (pass.kind == PassKind::Host) return pass.body(frame);
    const std::string& program =
        night && !pass.program_at_night.empty() ? pass.program_at_night : pass.program;
    use(program, frame.terrain);
    if (pass.kind == PassKind::Compute) return dispatch(pass, program, frame);
    const gl::Framebuffer* const target = targets_.framebuffer(step);
    assert(target);
    for (std::size_t i = 0; i < pass.colours.size(); ++i)
        if (const auto& clear = pass.colours[i].clear)
            target->clear_colour(static_cast<int>(i),
                                 {(*clear)[0], (*clear)[1], (*clear)[2], (*clear)[3]});
    DrawState state{.depth = pass.depth,
                    .stencil = pass.stencil,
                    .clips_voids = pass.clips_voids && frame.terrain.has_voids()};
    if (pass.culls) state.winds_counterclockwise = frame.terrain.winds_counterclockwise();
    const DrawScope scope(*target, state);
    if (program == pass.program && uses_plain(pass)) return draw_parts(pass, program, frame);
    draw(pass, program, *target, frame);
}

void FrameRunner::draw(const Pass& pass, const std::string& program, const gl::Framebuffer& target,
                       PassContext& frame) {
    const bool watched = programs_.needs_watch(program);
    if (pass.kind == PassKind::Fullscreen)
        fill(program, all_of(target));
    else
        draw_geometry(pass, program, target, frame);
    if (watched) programs_.set_proven(program);
}

bool FrameRunner::uses_plain(const Pass& pass) {
    return pass.plain && ((links_plain_ && has_drawn_) || programs_.is_linked(pass.plain->name));
}

void FrameRunner::draw_parts(const Pass& pass, const std::string& program, PassContext& frame) {
    const PictureParts parts = pass.plain->parts(frame);
    const auto draw_with = [&](const std::string& name, bool whole) {
        const std::vector<PixelRectangle> rectangles = parts.rectangles(whole);
        if (rectangles.empty()) return;
        use(name, frame.terrain);
        const bool watched = programs_.needs_watch(name);
        for (const PixelRectangle& rectangle : rectangles)
            fill(name, rectangle);
        if (watched) programs_.set_proven(name);
    };
    draw_with(program, true);
    draw_with(pass.plain->name, false);
}

void FrameRunner::draw_geometry(const Pass& pass, const std::string& program,
                                const gl::Framebuffer& target, PassContext& frame) {
    const double triangles = frame.tiles.triangles();
    const auto body = [&] { pass.body(frame); };
    // Of the pixels of a shadow map few are drawn. It is drawn once: where its body clears parts of
    // it and draws them twice in a row, NVIDIA's driver 580 may reject all pixels of the next draw
    // whose depth test is another.
    if (pass.colours.empty())
        return programs_.draw(program, double{1} * frame.width_px * frame.height_px + triangles,
                              body);
    // On a large frame, runs the vertices first with one pixel, to detect endless ones as soon as
    // on a small frame.
    const double all_px = pixels(all_of(target));
    if (programs_.needs_watch(program) && all_px > kMaxWatched_px) {
        const Scissor corner(PixelRectangle{0, 0, 1, 1});
        programs_.draw(program, triangles, body);
    }
    programs_.draw(program, all_px + triangles, body);
}

/// Draws a full-screen triangle in a rectangle. Unproven programs draw large ones in bands, to
/// detect endless pixels as soon as in a small frame.
void FrameRunner::fill(const std::string& program, const PixelRectangle& where) {
    const bool bands = programs_.needs_watch(program) && pixels(where) > kMaxWatched_px;
    const int rows =
        bands ? std::max(1, static_cast<int>(kMaxWatched_px / where.width)) : where.height;
    for (int y = 0; y < where.height; y += rows) {
        const PixelRectangle band{where.left, where.bottom + y, where.width,
                                  std::min(rows, where.height - y)};
        const Scissor scissor(band);
        programs_.draw(program, pixels(band), [this] {
            no_inputs_.bind();
            glDrawArrays(GL_TRIANGLES, 0, 3);
        });
    }
}

/// Runs a compute pass. An unproven program with many invocations first runs one work group, to
/// detect endless ones as soon as with few.
void FrameRunner::dispatch(const Pass& pass, const std::string& program, const PassContext& frame) {
    const std::array<int, 3> groups = pass.dispatch->groups(frame.width_px, frame.height_px);
    const std::array<int, 3>& local = pass.dispatch->local_size;
    double invocations = 1;
    for (std::size_t i = 0; i < groups.size(); ++i)
        invocations *= double{1} * groups[i] * local[i];
    const auto run = [&](const std::array<int, 3>& count, double parts) {
        targets_.begin_output(pass.writes[0]);
        programs_.draw(program, parts, [&] {
            glDispatchCompute(static_cast<GLuint>(count[0]), static_cast<GLuint>(count[1]),
                              static_cast<GLuint>(count[2]));
        });
    };
    const bool watched = programs_.needs_watch(program);
    if (watched && invocations > kMaxWatched_px) {
        run({1, 1, 1}, 0);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
    }
    run(groups, invocations);
    if (watched) programs_.set_proven(program);
}

namespace {

/// "plugins/dust/dust.glsl:3", where a sampler is declared.
std::string place_of(const shader::TextureUnit& unit, const shader::Stitched& stitched) {
    for (const shader::StageText* stage : stitched.stages()) {
        const std::vector<std::string> lines = split(stage->text, '\n');
        for (std::size_t i = 0; i < std::min(lines.size(), stage->lines.size()); ++i)
            if (lines[i].starts_with("layout(binding") && lines[i].ends_with(unit.name + ";"))
                return fmt::format("{}:{}", stage->lines[i].file, stage->lines[i].line);
    }
    return "core";
}

[[noreturn]] void fail_missing(const shader::TextureUnit& unit, const shader::Stitched& stitched) {
    failed(
        fmt::format("render: {}: {}: no effect that is on makes the texture {}; correct "
                    "//@ from({})\n--disable {} goes on without it",
                    place_of(unit, stitched), unit.name, unit.resource, unit.resource, unit.owner));
}

}  // namespace

void FrameRunner::use(const std::string& program, const Terrain& terrain) {
    programs_.link(program).use();
    for (const shader::TextureUnit& unit : programs_.text(program).stitched.textures) {
        const auto number = static_cast<unsigned>(unit.unit);
        if (targets_.bind(Version::of(unit.resource).resource, number)) continue;
        const gl::Texture* const texture = provider_(unit, terrain);
        if (!texture) fail_missing(unit, programs_.text(program).stitched);
        texture->bind(number);
    }
}

}  // namespace relevo::render
