#pragma once

#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "gl/handle.h"
#include "gl/texture.h"

namespace relevo::gl {

/// A set of textures that draws go to. The textures must outlive it.
class Framebuffer {
  public:
    Framebuffer() = default;
    /// @param colours  in the order of the fragment program's outputs, an array's layers one after
    ///                 another; may be empty
    /// @param depth    a Depth32F or a Stencil8 texture, or null
    /// @throws Error (Failed) if the device cannot draw to this combination
    Framebuffer(std::span<const Texture* const> colours, const Texture* depth,
                std::string_view label);
    Framebuffer(std::initializer_list<const Texture*> colours, const Texture* depth,
                std::string_view label)
        : Framebuffer(std::span(colours.begin(), colours.size()), depth, label) {}

    /// One layer of one level of a colour texture, alone.
    Framebuffer(const Texture& colour, int level, int layer, std::string_view label);

    /// Draws go here from now on, to the whole of it.
    void bind() const;
    void clear_colour(int index, glm::vec4 value) const;
    void clear_depth(float value) const;
    void clear_stencil(int value) const;

    /// Copies its first colour to the window of the current context, rows from below, stretched.
    /// @param share  of the width, from the left, that is copied
    void copy_to_window(int width_px, int height_px, float share = 1) const;

    /// Depths of single pixels, counted from below, with one wait for the device.
    std::vector<float> read_depths(std::span<const glm::ivec2> pixels) const;

    Extent extent() const { return extent_; }
    unsigned name() const { return handle_.name(); }  ///< 0: there is none

  private:
    static void destroy(unsigned name);
    Handle<&Framebuffer::destroy> handle_;
    Extent extent_;
};

}  // namespace relevo::gl
