#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "gl/context.h"
#include "gl/vertex_array.h"
#include "render/graph_targets.h"
#include "render/pass_context.h"
#include "render/pass_timers.h"
#include "render/picture_parts.h"
#include "render/watched_programs.h"
#include "shader/param_store.h"

namespace relevo::render {

/// Executes frame graphs: for each step of the plan binds program, textures and targets, sets the
/// state, and draws or dispatches.
class FrameRunner {
  public:
    /// Finds a texture that is not produced in the graph, by the name of its resource; null if
    /// there is none.
    using Provider =
        std::function<const gl::Texture*(const shader::TextureUnit& unit, const Terrain& terrain)>;

    /// @param frames  their passes must have bodies; all references must outlive this
    FrameRunner(gl::Context& context, const StitchedFrames& frames, WatchedPrograms& programs,
                TexturePool& pool, Provider provider, const shader::ParamStore& values);

    /// Sets the frame size and selects the graph. Has no effect if it throws.
    /// @throws Error (Failed) as GraphTargets
    void arrange(bool outside, int width_px, int height_px);
    /// Returns all targets to the pool, including the last frame's. Call arrange() before the next
    /// frame.
    void release();
    bool is_arranged() const { return is_arranged_; }
    /// Plain programs are used once something else has linked them. Otherwise the second frame
    /// links them: one picture alone is drawn faster without them.
    void leave_plain_programs() { links_plain_ = false; }

    const FrameGraph& graph() const { return graph_of(outside_); }
    const Plan& plan() const { return plan_; }
    GraphTargets& targets() { return targets_; }
    /// A texture of the last frame. @pre the graph allocates it
    const gl::Texture& texture(std::string_view resource);

    /// Draws a frame.
    /// @param night  uses the night programs of passes that have one
    /// @param times  if not null, receives the duration of each pass
    void run(PassContext& frame, bool night, PassTimes* times);

    /// Binds a program and its textures. @throws Error (Failed) if a texture is missing
    void use(const std::string& program, const Terrain& terrain);

    /// Fills targets with NaN before their first use, for tests.
    void set_poison(bool poison) { poisons_ = poison; }

  private:
    const FrameGraph& graph_of(bool outside) const;
    /// Inputs of a pass that runs only when they change.
    struct Inputs {
        std::uint64_t ground = 0;
        double exaggeration = 1;
        glm::dvec3 sun{0};
        std::vector<shader::ParamValue> values;
        bool operator==(const Inputs&) const = default;
    };
    bool is_due(const Pass& pass, const PassContext& frame) const;
    Inputs inputs_of(const Pass& pass, const PassContext& frame) const;
    void forget_remade();
    void run_step(std::size_t step, PassContext& frame, bool night, PassTimers* timers);
    void execute(std::size_t step, PassContext& frame, bool night);
    void draw(const Pass& pass, const std::string& program, const gl::Framebuffer& target,
              PassContext& frame);
    void draw_parts(const Pass& pass, const std::string& program, PassContext& frame);
    bool uses_plain(const Pass& pass);
    void draw_geometry(const Pass& pass, const std::string& program, const gl::Framebuffer& target,
                       PassContext& frame);
    void fill(const std::string& program, const PixelRectangle& where);
    void dispatch(const Pass& pass, const std::string& program, const PassContext& frame);

    gl::Context& context_;
    const StitchedFrames& frames_;
    WatchedPrograms& programs_;
    TexturePool& pool_;
    Provider provider_;
    const shader::ParamStore& values_;
    bool outside_ = false, poisons_ = false, is_arranged_ = false;
    bool has_drawn_ = false, links_plain_ = true;
    Plan plan_;
    GraphTargets targets_;
    std::map<std::string, Inputs> executed_;  // by pass: inputs of its last execution
    std::set<std::string> changed_;           // resources written in this frame by such passes
    gl::VertexArray no_inputs_;
};

}  // namespace relevo::render
