#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "chart/legend.h"
#include "gl/fence.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "scene/camera.h"
#include "scene/view.h"
#include "session/marks.h"
#include "sun/time.h"

namespace relevo::viewer {

/// A frame on the device, drawn in a scene's context and displayed in the window's, which share
/// objects (gl::Context::sharing).
struct SharedFrame {
    gl::Texture colour;  ///< RGBA8
    gl::Texture depth;   ///< Depth32F, as in render::Renderer
    gl::Fence drawn;     ///< the scene has finished drawing
    gl::Fence shown;     ///< the window has finished its last use
};

/// A finished frame with its camera and sun.
struct Picture {
    /// Depth of ground along the optical axis [m]; infinite in the sky. Pixels of a shared frame
    /// are read on demand, on the window's thread, and cached.
    /// @param x, y  from the lower left corner
    float depth_m(int x, int y) const;
    /// Reads the depths of several pixels at once, for later calls of depth_m().
    void fetch_depths(std::span<const glm::ivec2> pixels) const;
    /// All pixels, rows from the bottom. Shared frames: on the window's thread.
    std::vector<std::uint8_t> read_rgba() const;
    /// As session::Session::read_depths. Shared frames: on the window's thread.
    std::vector<float> read_depths_m() const;

    std::uint64_t number = 0;
    std::uint64_t answers = 0;  ///< the latest of SceneThread::wants() that it includes
    int width_px = 0, height_px = 0;
    std::shared_ptr<SharedFrame> shared;  ///< null: the next two members hold the frame
    std::vector<std::uint8_t> rgba;       ///< rows from the bottom
    std::vector<float> depths_m;          ///< as session::Session::read_depths
    scene::Camera camera;                 ///< possibly raised above the drawn ground
    scene::GroundHeight aim_m;            ///< Session::heights_to_aim_at()
    sun::Instant utc;
    double seconds = 0;                  ///< of effects that move
    std::vector<chart::Legend> legends;  ///< of effects
    std::vector<session::Marks> marks;   ///< of effects
    /// Full size, all tile pages, the complete DEM, current shadows.
    bool sharp = false;

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(x);
    }
    mutable std::map<std::size_t, float> fetched_m_;  // of a shared frame, by index()
};

}  // namespace relevo::viewer
