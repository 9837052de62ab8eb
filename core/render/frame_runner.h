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
#include "render/watched_programs.h"
#include "shader/param_store.h"

namespace relevo::render {

/// Executes frame graphs: for each step of the plan it binds the program, its textures and the
/// targets, sets the state, and draws.
class FrameRunner {
  public:
    /// A texture that no pass of the graph's own makes, by the resource's name; null: there is
    /// none.
    using Provider =
        std::function<const gl::Texture*(const shader::TextureUnit& unit, const Terrain& terrain)>;

    /// @param frames  whose passes have their bodies; must outlive this, as must the rest
    FrameRunner(gl::Context& context, const StitchedFrames& frames, WatchedPrograms& programs,
                TexturePool& pool, Provider provider, const shader::ParamStore& values);

    /// Sets the size of frames, and which graph they are drawn by. Where it throws, nothing has
    /// changed. @throws Error (Failed) as GraphTargets
    void arrange(bool outside, int width_px, int height_px);
    /// Returns the memory of frames to the pool, with the last frame. Call arrange() before the
    /// next one.
    void release();
    bool is_arranged() const { return is_arranged_; }

    const FrameGraph& graph() const { return graph_of(outside_); }
    const Plan& plan() const { return plan_; }
    GraphTargets& targets() { return targets_; }
    /// Of the last frame. @pre the graph has such a texture
    const gl::Texture& texture(std::string_view resource);

    /// Draws a frame.
    /// @param night  passes with a program for nights take that
    /// @param times  filled with what each pass took if not null
    void run(PassContext& frame, bool night, PassTimes* times);

    /// Makes a program and its textures current. @throws Error (Failed) where a texture is missing
    void use(const std::string& program, const Terrain& terrain);

    /// Fills memory with NaN where the contents of a resource begin, for tests.
    void set_poison(bool poison) { poisons_ = poison; }

  private:
    const FrameGraph& graph_of(bool outside) const;
    /// What a pass that is not executed in every frame depends on.
    struct Inputs {
        std::uint64_t ground = 0;
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
    void draw_geometry(const Pass& pass, const std::string& program, const gl::Framebuffer& target,
                       PassContext& frame);
    void fill(const std::string& program, const gl::Framebuffer& target);

    gl::Context& context_;
    const StitchedFrames& frames_;
    WatchedPrograms& programs_;
    TexturePool& pool_;
    Provider provider_;
    const shader::ParamStore& values_;
    bool outside_ = false, poisons_ = false, is_arranged_ = false;
    Plan plan_;
    GraphTargets targets_;
    std::map<std::string, Inputs> executed_;  // by pass: for what it was executed last
    std::set<std::string> changed_;  // by passes of this frame that are not executed in every one
    gl::VertexArray no_inputs_;
};

}  // namespace relevo::render
