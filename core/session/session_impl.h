#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "gl/context.h"
#include "render/renderer.h"
#include "render/terrain.h"
#include "session/drawn_effects.h"
#include "session/effect_fields.h"
#include "session/effect_rasters.h"
#include "session/marks.h"
#include "session/non_finite.h"
#include "session/overlay.h"
#include "session/scene_state.h"
#include "session/session.h"

/// What session.cpp and session_impl.cpp share.
namespace relevo::session {

inline constexpr int kDivider_px = 2;

/// Joins the left half of one image and the right half of another, with a dividing line.
template <typename Picture, typename Value>
Picture side_by_side(const Picture& left, const Picture& right, Value line) {
    Picture both = right;
    const int first = std::max((left.width - kDivider_px) / 2, 0) * left.channels;
    const int last = std::min(left.width * left.channels, first + kDivider_px * left.channels);
    for (int y = 0; y < left.height; ++y) {
        std::copy_n(left.row(y), first, both.row(y));
        std::fill(both.row(y) + first, both.row(y) + last, line);
    }
    return both;
}

/// Restores a camera at its end.
class CameraKept {
  public:
    explicit CameraKept(scene::Camera& camera) : camera_(camera), kept_(camera) {}
    ~CameraKept() { camera_ = kept_; }
    CameraKept(const CameraKept&) = delete;
    CameraKept& operator=(const CameraKept&) = delete;

  private:
    scene::Camera& camera_;
    scene::Camera kept_;
};

/// A scene on a device: its state, the effects that draw it, and its terrain.
struct Session::Impl {
    Options options;
    SceneState state;
    StageTimes stages;

    // In order of dependency.
    std::optional<gl::Context> context;
    render::SharedResources shared;
    std::shared_ptr<const LoadedDem> first_dem;  // until its sky_view is handed over
    render::SkyViewFuture sky_view;              // of first_dem, computed in the background
    RecentEffects recent;
    std::optional<DrawnEffects> drawn;
    std::optional<render::Terrain> terrain;

    LaidOverlay laid;
    std::optional<Overlay> overlay;                    // of the scene
    std::shared_ptr<const overlay::Photo> land_cover;  // of the scene; null: none
    std::shared_ptr<const render::OverlayRaster>
        houses;  // of the scene's surface model; null: none
    std::optional<OverlayTime> overlay_time;
    EffectRasters rasters;  // of the drawn effects
    EffectFields fields;
    std::vector<std::string> stamp_notes;
    MarksOnGround marks_on_ground;
    std::optional<render::PicturePart> part;  // of the scene's picture, that frames show
    glm::ivec2 map_corner_px{0, 0};           // Session::map_corner_px()
    std::shared_ptr<const chart::PaperSheet> paper_sheet;  // Session::paper_sheet()
    std::optional<bool> picture_shows_ground;              // of the last picture in several frames

    Impl(scene::Scene given, Options o, FilesInUse& files);
    bool is_seen_from_outside() const;  ///< as a block, or as a map
    /// Logs which effects of those that were asked for draw nothing in this view.
    void say_unseen(const scene::Effects& asked) const;
    /// A stop less for ground that is snow and ice all over, which else is white without form.
    void choose_exposure();
    /// Events that depend on terrain need all posts, not a preview.
    std::shared_ptr<const LoadedDem> load_own() const;
    void open_device(FilesInUse& files);
    EffectsRequest request(const scene::Effects& effects) const;
    bool has_overlay_raster() const { return laid.raster || (state.scene.overlay && !terrain); }
    /// Copies the drawn effects into the scene.
    void take_effects();
    render::RendererOptions renderer_options();
    /// @param first_dem  the DEM before its terrain is created; else null
    void compile(DrawnEffects& effects, const LoadedDem* first_dem = nullptr);
    /// Computes the sky-view factor on the CPU while the driver compiles programs that read it.
    void compute_sky(const LoadedDem& dem, const std::vector<render::ProgramText>& texts);
    /// Draws a request: with the current effects, with recent ones, or with newly loaded ones.
    void switch_to(const EffectsRequest& wanted);
    void switch_effects(const EffectsRequest& wanted);
    /// Reads the rasters and fields of effects and lays them over the terrain.
    void lay_rasters(const DrawnEffects& of);
    /// Lays the fields over the terrain, those of the weather as they are at the current time.
    void lay_fields();
    void set_time(sun::Instant utc);
    void resize(int width_px, int height_px);
    void show(const scene::Scene& next, sun::Instant utc, const Hints& hints);
    /// @returns whether the weather is another one
    bool show_weather(const scene::Scene& next);
    /// Its effects, over the overlay of the hints.
    /// @returns whether others are on, or were read again
    bool show_effects(const scene::Scene& next, const Hints& hints);
    void lay(LaidOverlay& other);  ///< swaps what lies on the ground
    void upload(const std::shared_ptr<const LoadedDem>& dem);
    void take(const std::shared_ptr<const LoadedDem>& dem, const scene::Scene& given);
    void look(const scene::View& view);
    DrawnShape shape();
    /// @param around  as drawn in a panorama
    DrawnShape shape(bool around);
    std::optional<double> drawn_height_m(const scene::Camera& camera, bool around);
    /// For scenes as given, not while a user moves the eye.
    void warn_of_eye() { state.warn_of_eye(shape()); }
    void draw(render::Loading loading, render::PassTimes* times = nullptr);
    /// Marks of the effects of a half.
    std::vector<Marks> marks(const std::vector<LoadedMarks>& loaded, const ActiveEffects& effects,
                             const render::Renderer& renderer);
    /// The marks of both halves of the frame's picture, as they are drawn on it.
    /// @param taken     has none of them
    /// @param depths_m  of the picture, if it is not the last frame
    std::vector<chart::Drawing> mark_drawings(const glm::ivec2& size_px,
                                              std::span<const chart::Rect> taken,
                                              const std::vector<float>* depths_m = nullptr);
    /// The same on the picture.
    void draw_marks_on(image::Image8& picture, std::span<const chart::Rect> taken,
                       const std::vector<float>* depths_m = nullptr);
    /// The same of the places of files, on a panorama.
    void draw_marks_around(image::Image8& picture, std::span<const chart::Rect> taken,
                           const MarkView::Around& around, const std::vector<float>& distances_m);
    /// Whether active effects may draw marks.
    bool has_marks() const;
    /// Size of frames [px]: that of the scene, or less if its picture is drawn in tiles.
    glm::ivec2 frame_px() const;
    image::Picture make_picture(const Session& session, render::PassTimes* times);
    /// The same with the scene's stamps in a margin around the picture (Stamps::margin).
    image::Picture make_with_margin(const Session& session, render::PassTimes* times);
    /// The same of a map sheet (Scene::sheet).
    image::Picture make_sheet(const Session& session, render::PassTimes* times);
    image::Picture make_panorama(const Session& session, render::PassTimes* times);
    /// @throws Error (BadInput) for what a panorama cannot have
    void check_panorama() const;
    image::Picture make_stereo(const Session& session, render::PassTimes* times);
    /// @throws Error (BadInput) for what a stereo pair cannot have
    void check_stereo() const;
    /// Of pictures of several cameras. @param what  "--stereo"
    void refuse_with_several_cameras(const std::string& what) const;
    /// Whether a picture has marks, stamps or legends. @throws Error (BadInput) if it is too large
    bool is_annotated(const Session& session) const;
    /// Draws on a picture of any kind but linear light. @param draw  draws on its colours
    void annotate(image::Picture& picture, const std::function<void(image::Image8&)>& draw) const;
    /// @param has_legends  which are not drawn; stamp_notes says so
    void make_bands(const std::function<void(const image::Picture&)>& take, bool has_legends);
    FaultyPicture faulty(const ActiveEffects& shown, int count);
    /// @throws Error (Failed) if count > 0, the number of non-finite pixels
    void check_numbers(int count, const ActiveEffects& shown);
    template <typename Read, typename Value>
    auto read(const Read& read_of, Value line) {
        context->make_current();
        int non_finite = 0, others_non_finite = 0;
        auto picture = read_of(drawn->renderer(), &non_finite);
        if (const render::Renderer* const without = drawn->without())
            picture = side_by_side(picture, read_of(*without, &others_non_finite), line);
        check_numbers(non_finite, drawn->effects());
        if (drawn->without()) check_numbers(others_non_finite, drawn->others());
        return picture;
    }
};

}  // namespace relevo::session
