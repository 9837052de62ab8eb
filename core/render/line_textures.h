#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/file_stamps.h"
#include "dem/grid.h"
#include "gl/texture.h"

namespace relevo::render {

/// Lines of a plugin's texture of kind `lines`.
struct LineSource {
    std::string resource;   ///< "tracks.way": its name for the stitcher
    std::string who;        ///< "tracks.file": what chooses the file, for messages
    std::string file;       ///< empty: none chosen
    std::string attribute;  ///< of the file; empty: none

    friend bool operator==(const LineSource&, const LineSource&) = default;
};

/// Caches indices of lines (make_line_index) on the device. Unused ones are deleted.
class LineTextureCache {
  public:
    /// Reads a file, or finds it as it was read before. Reports once that no file is chosen, that
    /// nothing is near the DEM, or that lines are simplified.
    /// @throws Error (BadInput) as dem::read_lines
    std::shared_ptr<const gl::Texture> find_or_make(const LineSource& source, const dem::Grid& dem);

  private:
    struct Known {
        LineSource source;
        dem::Affine affine;
        std::string crs;
        glm::ivec2 size_posts;
        FileStamps stamps;
        std::weak_ptr<const gl::Texture> texture;
    };
    std::vector<Known> known_;
};

/// The textures of kind `lines` of the enabled effects, for one DEM at a time.
class LineTextures {
  public:
    explicit LineTextures(std::vector<LineSource> sources) : sources_(std::move(sources)) {}

    /// Makes the textures for a DEM, if they are not those of the last call.
    /// @param serial  of the terrain
    /// @throws Error as LineTextureCache
    void update(const dem::Grid& dem, std::uint64_t serial, LineTextureCache& cache);

    /// Null if no effect declares it.
    const gl::Texture* find(const std::string& resource) const;

  private:
    std::vector<LineSource> sources_;
    std::uint64_t serial_ = 0;
    std::map<std::string, std::shared_ptr<const gl::Texture>> textures_;
};

}  // namespace relevo::render
