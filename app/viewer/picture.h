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
#include "sun/time.h"

namespace relevo::viewer {

/// A frame on the device, drawn in the context of a scene and shown in that of the window, which
/// share (gl::Context::sharing).
struct SharedFrame {
    gl::Texture colour;  ///< RGBA8
    gl::Texture depth;   ///< Depth32F, as renderers have it
    gl::Fence drawn;     ///< by the scene
    gl::Fence shown;     ///< by the window, the last time
};

/// A frame as it was drawn, whatever has been asked for since.
struct Picture {
    /// How far the ground is from the eye, along the direction it looks in [m]; infinity where
    /// there is sky. Of a shared frame each pixel is read once, on the window's thread.
    /// @param x, y  from the lower left corner
    float depth_m(int x, int y) const;
    /// Reads the depths of pixels together, of which depth_m() is asked next.
    void fetch_depths(std::span<const glm::ivec2> pixels) const;
    /// All pixels, rows from below. Of a shared frame on the window's thread.
    std::vector<std::uint8_t> read_rgba() const;
    /// As session::Session::read_depths, likewise.
    std::vector<float> read_depths_m() const;

    std::uint64_t number = 0;
    std::uint64_t answers = 0;  ///< the last of SceneThread::wants() that is in it
    int width_px = 0, height_px = 0;
    std::shared_ptr<SharedFrame> shared;  ///< null: the two below have it
    std::vector<std::uint8_t> rgba;       ///< rows from below
    std::vector<float> depths_m;          ///< as session::Session::read_depths
    scene::Camera camera;       ///< raised above the drawn ground where the eye wanted is not
    scene::GroundHeight aim_m;  ///< Session::heights_to_aim_at()
    sun::Instant utc;
    std::vector<chart::Legend> legends;  ///< of what effects colour the ground by
    /// In the window's size, with all its ground, from all posts, and with its sun's shadows.
    bool sharp = false;

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(x);
    }
    mutable std::map<std::size_t, float> fetched_m_;  // of a shared frame, by index()
};

}  // namespace relevo::viewer
