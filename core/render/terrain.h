#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "dem/heightfield.h"
#include "geo/local_frame.h"
#include "gl/buffer.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "render/patch_net.h"

namespace relevo::render {

struct TerrainOptions {
    /// Vertices that may be drawn in a frame: posts are left out evenly until they fit.
    int vertex_budget = 600000;
};

/// A heightfield on the device: one 65 x 65 grid of vertices, drawn once for every patch and
/// displaced there by the elevation pages.
class Terrain {
  public:
    /// @param frame  the DEM's local frame; every position below is in it
    /// @throws Error (BadInput) where the DEM has more pages than the device can hold
    Terrain(const dem::Heightfield& heightfield, const geo::LocalFrame& frame,
            const TerrainOptions& options, int max_array_layers);

    /// Draws all patches with the program and framebuffer that are bound. Texture unit 0 must hold
    /// height_pages().
    void draw(const glm::dvec3& eye_m);

    const gl::Texture& height_pages() const { return height_pages_; }
    const gl::Texture& normal_pages() const { return normal_pages_; }
    bool has_holes() const { return has_holes_; }
    int stride() const { return stride_; }  ///< posts from vertex to vertex
    int triangles() const;                  ///< drawn in a frame

  private:
    struct Patch {
        PatchNet net;
        glm::vec2 quads;  ///< of the patch that lie on the DEM
        float height_layer;
        float normal_layer;
        glm::vec2 first_texel;  ///< in the normal page
        float texels_per_quad;
    };

    std::vector<Patch> patches_;
    int stride_ = 1;
    bool has_holes_ = false;
    gl::Texture height_pages_, normal_pages_;
    gl::Buffer grid_, grid_indices_, instances_;
    std::optional<gl::VertexArray> vertex_array_;
};

}  // namespace relevo::render
