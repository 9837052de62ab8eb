#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "session/picture_tiles.h"
#include "session/session_impl.h"

namespace relevo::session {

/// What the pictures of a scene need of a session's renderers: sessions can be shared by scenes
/// that need the same.
struct RendererNeeds {
    bool deep = false;          ///< colours of 16 bits, of which pictures are made
    bool antialias = true;      ///< silhouettes are smoothed in each frame
    bool data = false;          ///< layers
    bool albedo = false;        ///< the layer of that name
    bool orthographic = false;  ///< maps
    bool operator==(const RendererNeeds&) const = default;
};
RendererNeeds needs_of(const scene::Scene& scene, const PictureFormat& format);

/// Samples of each pixel of a scene's picture.
int samples_of(const scene::Scene& scene);

/// How far full-screen effects may read around a pixel: bloom's widest level reaches 157 px.
inline constexpr int kMargin_px = 256;
/// Pixels of the frames that larger pictures are made of: their targets take 60 bytes each.
inline constexpr double kTileFrame_px = 1 << 23;
/// Pixels of the largest map that is one frame. A map may have a pixel for each post, and larger
/// ones more pages of normals than there is room for: all normals would be of a coarser level.
inline constexpr double kMapFrame_px = 1 << 24;

/// @throws Error (BadInput) for active effects that compute from the whole frame
/// @param expected  what they would need, for the message
void refuse_whole_frame_effects(const DrawnEffects& drawn, const std::string& expected);

/// Size of the frames that a scene's picture is drawn in [px]: the picture's, or less.
glm::ivec2 frame_px(const scene::Scene& scene, const PictureFormat& format, int max_side_px);

/// Draws the picture of a session's scene, in one frame or in many.
class PictureMaker {
  public:
    /// @param impl  must outlive this
    explicit PictureMaker(Session::Impl& impl);

    /// Without marks and stamps. @param times  of the first frame; may be null
    image::Picture whole(render::PassTimes* times);
    /// Rows of tiles from the top.
    void bands(const std::function<void(const image::Picture&)>& take);

    /// @param times  of the first frame; may be null
    void time_first_frame(render::PassTimes* times) { times_ = times; }
    /// For Options::on_frame, before draw(). @param frames  without their samples
    void expect(std::size_t frames) { expected_ = frames; }
    /// A frame of another camera than the scene's.
    struct Frame {
        scene::Camera camera;
        glm::ivec2 picture_px{0};  ///< size of the camera's picture
        PictureRect rect;          ///< of that picture
        glm::dvec2 moved_px{0};    ///< further to the right and up
        bool of_panorama = false;  ///< as render::PicturePart
    };
    /// Draws a frame with the scene's samples, in 8 bits only if the renderer has no more.
    /// depths_m() are then its own, rows from the top. The session keeps the camera.
    image::Picture draw(const Frame& frame);

    bool is_tiled() const { return tiles_.size() > 1; }
    bool shows_ground() const { return shows_ground_; }
    /// Depths of the whole picture as render::Renderer::read_depths(); kept by whole() if wanted.
    std::vector<float>& depths_m() { return depths_m_; }
    void keep_depths() { keeps_depths_ = true; }

  private:
    /// @throws Error (BadInput) for what needs the whole picture
    /// @throws Error (BadInput) for what only a single frame can have
    void refuse_in_tiles() const;
    image::Picture draw(const PictureTile& tile);
    image::Picture draw_once(const PictureTile& tile);
    image::Picture draw_samples(const PictureTile& tile);
    // Of the last frame, cut to the tile.
    image::ImageF radiance(const PictureTile& tile);
    image::Image16 colours16(const PictureTile& tile);
    image::Image8 colours8(const PictureTile& tile);
    void draw_frame(const PictureTile& tile, const glm::dvec2& offset_px);
    /// Depths of a tile, rows from the top.
    std::vector<float> depths_of(const PictureTile& tile) const;
    void take_depths(const PictureTile& tile, const std::vector<float>& depths_m);
    void add_layers(const PictureTile& tile, image::Picture& picture);

    Session::Impl& impl_;
    const scene::Scene& scene_;
    const PictureFormat& format_;
    bool linear_;
    glm::ivec2 picture_px_;
    std::vector<PictureTile> tiles_;
    render::PassTimes* times_ = nullptr;
    std::size_t expected_ = 1, drawn_ = 0;  // frames; each sample of the drawn ones counts
    bool keeps_depths_ = false, shows_ground_ = false;
    std::optional<Frame> frame_;  // instead of tiles
    std::vector<float> depths_m_;
};

}  // namespace relevo::session
