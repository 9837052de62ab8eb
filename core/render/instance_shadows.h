#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/frame_block.h"
#include "render/instance_blocks.h"
#include "render/terrain.h"
#include "shader/instance_set.h"
#include "shader/param_store.h"

namespace relevo::render {

/// Where the shadow maps of instances lie, and which of them must be drawn.
///
/// Three square maps across the sun's rays, centred on the ground below the eye. Each has four
/// times the side of the next finer one; the last reaches as far as instances are drawn. Maps are
/// kept until the sun, the parameters or the ground change, or until the eye leaves the middle of a
/// map. Their texels lie on a fixed grid, so that shadows do not move when a map is drawn again.
class InstanceShadows {
  public:
    // shaders/lib/instances.glsl has the number, too.
    static constexpr int kMaps = 3;
    static constexpr int kSide_px = 2048;

    explicit InstanceShadows(const std::vector<shader::InstanceSet>& sets);

    /// Decides which maps the frame must draw.
    /// @param ground_m   the drawn ground below the eye, in the local frame
    /// @param pixel_rad  a pixel at the frame's centre
    /// @param values     of the parameters
    /// @param block      with the sun as the eye sees it; receives the maps' places
    void prepare(const Terrain& terrain, const FrameInputs& inputs, const glm::dvec3& ground_m,
                 double pixel_rad, const shader::ParamStore& values, FrameBlock& block);
    /// All maps are lost.
    void forget() { key_.reset(); }

    bool is_due(int map) const { return due_[static_cast<std::size_t>(map)]; }
    bool is_any_due() const;

    /// Range of all sets that cast shadows [m]. @pre prepare()
    double range_m() const { return range_m_; }

    /// Clears the maps that are due, in the depth of the bound framebuffer.
    void clear_due() const;

    /// True if the shadow of something in a box may lie in a map.
    bool meets(int map, const Box& box) const;

  private:
    /// What all maps depend on.
    struct Key {
        std::uint64_t ground = 0;
        bool is_complete = true;
        glm::dvec3 towards_sun{0};
        glm::dvec3 up{0};  ///< of deterministic frames, which depend on no earlier one
        double exaggeration = 1, range_m = 0;
        double day = 0;
        std::vector<shader::ParamValue> values;
        bool operator==(const Key&) const = default;
    };
    struct Map {
        glm::dvec2 centre_m{0};  ///< across the rays, in the local frame
        glm::dvec3 eye_m{0};     ///< when it was drawn
        double half_side_m = 1;
    };
    void write(const glm::dvec3& eye_m, SunBlock& block) const;
    glm::dvec2 across(const glm::dvec3& position_m) const {
        return {dot(axes_[0], position_m), dot(axes_[1], position_m)};
    }

    const std::vector<shader::InstanceSet> sets_;
    std::optional<Key> key_;
    double range_m_ = 0;
    std::array<glm::dvec3, 3> axes_{};  ///< across the rays, upwards across them, towards the sun
    std::array<Map, kMaps> maps_{};
    std::array<bool, kMaps> due_{};
};

}  // namespace relevo::render
