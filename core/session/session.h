#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files_in_use.h"
#include "chart/drawing.h"
#include "chart/legend.h"
#include "dem/fill_holes.h"
#include "dem/heightfield.h"
#include "dem/pyramid.h"
#include "dem/source.h"
#include "dem/water.h"
#include "gl/context.h"
#include "image/image.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "session/data_layers.h"
#include "session/overlay_time.h"
#include "sun/refraction.h"
#include "sun/zone.h"

/// Turns a scene into frames, pictures and descriptions. Shared by all front ends.
namespace relevo::session {

/// A DEM in memory. Immutable; may be read on several threads.
struct LoadedDem {
    std::shared_ptr<const dem::Source> source;  ///< never null
    dem::Heightfield field;                     ///< all posts, or means of them
    double took_ms = 0;
    /// A reduced preview, although all posts would fit into memory. For display only; nothing may
    /// be computed from `field`.
    bool is_preview = false;
    /// The heights as drawn, with small voids filled.
    struct Drawn {
        std::optional<dem::Heightfield> filled;  ///< nullopt: same as `field`
        /// As dem::FilledHoles::filled; empty without filled voids.
        Array2d<std::uint8_t> is_filled;
        bool has_covers = false;     ///< voids too wide to fill are covered
        dem::Water water;            ///< found in the drawn heights
        std::string holes_text;      ///< summary of voids; empty without voids
        bool has_houses = false;     ///< it looks like a surface model: dem/surface.h
        bool has_no_collar = false;  ///< a frame of fill around `field` is left out of `filled`
    };
    Drawn drawn{};
    std::optional<dem::Pyramid> pyramid{};  ///< of to_draw(); nullopt: the session builds it

    const dem::Heightfield& to_draw() const { return drawn.filled ? *drawn.filled : field; }
    /// What views are chosen by.
    const dem::Heightfield& to_frame() const { return drawn.has_no_collar ? to_draw() : field; }
    /// Words of effect::ground_words() that apply to the DEM.
    std::vector<std::string> ground_words(dem::Holes holes) const;
    /// Height [m] from all posts, even if only means of them are in memory; NaN without ground.
    double height_m(const geo::Geodetic& at) const;
};

/// Reads a scene's DEM, fills small voids, takes a collar away (dem/collar.h) and finds water. A
/// collar stays with LoadOptions::no_nodata, and in a DEM of which only means are read. @throws
/// Error as dem::load()
std::shared_ptr<const LoadedDem> load_dem(std::shared_ptr<const dem::Source> source,
                                          const scene::Scene& scene);

/// Reads a reduced preview of a large DEM from its overviews (LoadedDem::is_preview). Returns null
/// if the DEM is small or has none.
/// @throws Error as dem::load()
std::shared_ptr<const LoadedDem> load_preview(std::shared_ptr<const dem::Source> source,
                                              const scene::Scene& scene);

/// The ground of a DEM, in a local frame at the DEM's centre.
render::Ground ground_of(const LoadedDem& dem);

/// What a picture file is to hold besides what its scene says.
struct PictureFormat {
    int bits = 8;                         ///< of a channel of display-referred colour: 8 or 16
    std::vector<DataLayer> layers{};      ///< needs Options::radiance
    double frame_px = render::kFrame_px;  ///< pictures with more pixels are drawn in tiles
    /// Of a map sheet the map alone, without what stands around it: Session::paper_sheet() has
    /// that.
    bool map_alone = false;
};

/// True if a scene's picture takes more than kMaxPictureBytes: Session::make_bands().
bool needs_bands(const scene::Scene& scene, const PictureFormat& format, bool linear);
inline constexpr double kMaxPictureBytes = double{1 << 30};
/// @throws Error (BadInput) for what pictures in bands do not have: panoramas, stereo pairs, linear
///     light and stamps
void check_in_bands(const scene::Scene& scene, bool linear);

struct Options {
    std::string device = "auto";  ///< as gl::Context
    /// Creates the context, such as that of a window. By default one is created on `device`.
    std::function<gl::Context()> context{};
    /// The scene's DEM if it has been read; otherwise the session reads it.
    std::shared_ptr<const LoadedDem> dem{};
    /// The scene's DEM if it has been opened but not read; otherwise the session opens it.
    std::shared_ptr<const dem::Source> source{};
    /// Start with a preview of a large DEM if possible. Session::dem() then has `is_preview`, and
    /// Session::take() replaces it.
    bool allow_preview = false;
    bool radiance = false;  ///< keep linear radiance, for Session::radiance()
    /// For Session::make_picture(); the scene's samples, transparency and size are then those of
    /// pictures. nullopt: of frames, which have one sample a pixel and no alpha.
    std::optional<PictureFormat> format{};
    /// Keep the data that Session::read_sun_seen() reads.
    bool audited = false;
    /// Effects that the scene switches on by name may lack what they require: they are off, with a
    /// notice. Otherwise that is an error.
    bool allow_unmet = false;
    /// Ids of effects to compare: on in the left half of pictures, off in the right half.
    std::vector<std::string> compared{};
    /// Called before each frame of a picture with the share of its frames that are drawn, 0 to 1.
    /// What it throws ends the picture.
    std::function<void(double share)> on_frame{};
    /// Called with the shader sources before they are compiled.
    std::function<void(const render::StitchedFrames&)> stitched{};
};

struct ActiveEffects;
struct SceneWeather;
struct NonFiniteCause;
struct Marks;

/// Durations of stages [ms]: "device", "compile", "load", "upload". "load" runs concurrently with
/// the first two.
using StageTimes = std::vector<std::pair<std::string, double>>;

/// Colours on the ground.
struct LaidOverlay {
    std::shared_ptr<const render::OverlayRaster> raster;  ///< null: none
    bool without_shadows = false;  ///< cast shadows are off unless enabled by id

    bool operator==(const LaidOverlay&) const = default;
};

/// What a window knows of the frames that it asks for. Pictures have none of it.
struct Hints {
    /// Frames equal those of a session that is opened with the scene, byte by byte; else detail of
    /// earlier frames may stay.
    bool exact = true;
    /// Least height above the drawn ground for eyes that are not given above it [m]; nullopt: they
    /// are not raised.
    std::optional<double> keep_above_m{};
    bool reload_effects = false;  ///< changed files of effects are read again
    /// Instead of the scene's overlay. The first one requires other shader programs. nullopt: what
    /// is there stays.
    std::optional<LaidOverlay> overlay{};
};

/// A scene on a device: its DEM, its effects and their renderer. Several sessions may exist at
/// once; each is used on the thread that created it.
class Session {
  public:
    /// Opens everything. Reads the DEM in the background.
    /// @param files  receives the input files, so that no output replaces them
    /// @throws Error as those that open (BadInput, NoDevice, Failed)
    Session(scene::Scene scene, Options options, FilesInUse& files);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// The current scene. File names in parameters are absolute.
    const scene::Scene& scene() const;
    /// Heights of the currently drawn ground to aim cameras at, unexaggerated. May be called on any
    /// thread, and keeps the DEM alive.
    scene::GroundHeight heights_to_aim_at() const;
    /// Shows another scene of the same DEM, holes and overlay, and reuses what both share. An eye
    /// that is given above ground is placed on the drawn ground.
    /// @param utc  the scene's time
    /// @throws Error (BadInput) as scene::make_camera, as those that load, compile and draw
    ///     effects, and for a time that the weather lacks. Effects are then those before or the
    ///     scene's, and the session may show other parts of both scenes.
    void show(scene::Scene scene, sun::Instant utc, const Hints& hints = {});
    /// Installed effects, those that are on, and their parameters.
    const ActiveEffects& effects() const;
    /// Legends of the scene's overlay and of the active effects.
    std::vector<chart::Legend> legends() const;
    /// The legend of the scene's overlay; nullopt without one.
    std::optional<chart::Legend> overlay_legend() const;
    /// Options::compared.
    const std::vector<std::string>& compared() const;
    /// Time of the scene's overlay; nullopt if it does not show sunlight. Stamps show it instead of
    /// the scene's time. Cast shadows are then off unless enabled by id or scene::Overlay::shadows.
    const std::optional<OverlayTime>& overlay_time() const;
    /// Legends of the active effects and of their rasters.
    std::vector<chart::Legend> colour_legends() const;
    /// True if an active effect reads frame.seconds.
    bool is_animated() const;

    /// Replaces a preview (Options::allow_preview) with the complete DEM. The frame's size stays.
    /// Default view and time become those of the complete DEM.
    /// @param given  the scene that the session was opened with
    /// @throws Error as those that open; the session is then unusable
    void take(std::shared_ptr<const LoadedDem> dem, const scene::Scene& given);

    sun::Instant time() const;

    /// Draws a complete frame, waiting for its terrain.
    /// @param times  if not null, receives the duration of each pass
    void draw(render::PassTimes* times = nullptr);
    /// Draws a frame without waiting. Terrain that is not loaded yet is drawn coarser and loads in
    /// the background.
    /// @param freezes_native  cached passes of native effects, such as shadow maps, stay as they
    ///     are: they are expensive while the sun is dragged. Lighting by core is always current.
    /// @returns true if the frame is complete
    bool draw_available(bool freezes_native = false);
    /// True if terrain is loading, so that a later frame has more detail.
    bool is_loading() const;
    /// Draws only the left half's effects of a comparison, and waits for the device.
    void draw_alone(render::PassTimes* times = nullptr);

    /// Draws the scene as its picture file has it: with all samples, transparency, layers, in tiles
    /// if it is larger than a frame, with marks and stamps. Requires Options::format.
    /// @param times  as draw(), of the first frame
    /// @throws Error as draw() and picture(); (BadInput) where it is too large for memory
    image::Picture make_picture(render::PassTimes* times = nullptr);
    /// Where the upper left corner of the view is in the last make_picture() [px]: not (0, 0) of
    /// one with a margin.
    glm::ivec2 map_corner_px() const;
    /// What the last make_picture() left out by PictureFormat::map_alone; else null.
    std::shared_ptr<const chart::PaperSheet> paper_sheet() const;
    /// The same of a picture that is too large for memory, in bands of rows from the top.
    /// @param take  called with each band
    /// @throws Error (BadInput) for marks, stamps and layers, which need the whole
    void make_bands(const std::function<void(const image::Picture&)>& take);

    /// The last frame with marks of effects and the scene's stamps; both halves of a comparison.
    /// @throws Error (Failed) if pixels are not finite, naming the effect at fault
    image::Image8 picture() const;
    /// The marks of the active effects, for frames from now on; of a comparison those of its left
    /// half.
    std::vector<Marks> marks() const;
    /// Pixels of the last frame that are NaN or infinite.
    render::NonFinite non_finite() const;
    /// Which hook of an active effect makes pixels of the last frame NaN or infinite, by drawing it
    /// without each hook; nullopt if none does. Slow.
    std::optional<NonFiniteCause> non_finite_cause(const std::string& id) const;
    /// Options::format.
    const std::optional<PictureFormat>& format() const;
    /// Sentences on stamps that the last picture() omitted.
    const std::vector<std::string>& stamp_notes() const;
    /// As picture(), as linear radiance without marks and stamps. Requires Options::radiance.
    image::ImageF radiance() const;
    /// The last frame on the device: RGBA, rows from the bottom. Valid until the next frame.
    const gl::Texture& texture() const;
    /// As render::Renderer::depth().
    const gl::Texture& depth() const;
    /// True if the last frame shows ground of the DEM; in a comparison, its left half.
    bool shows_ground() const;
    /// As render::Renderer::read_depths().
    void read_depths(std::vector<float>& depths_m) const;

    /// As render::Renderer::read_sun_seen(), of a comparison's left half. Requires
    /// Options::audited.
    std::vector<render::SunSeen> read_sun_seen() const;
    /// The sun of the next frame.
    const render::SunLight& sun_light() const;

    const scene::Camera& camera() const;
    /// Points that orbits fit into the frame.
    scene::Outline outline() const;
    /// The DEM; may outlive the session.
    const std::shared_ptr<const LoadedDem>& dem() const;
    /// The DEM's ground. Cameras are in its local frame.
    const render::Ground& ground() const;

    /// Sentences on filled voids, assumptions about water, and visible synthetic detail.
    std::vector<std::string> ground_notes() const;

    /// "46.50 N 8.00 E" of the DEM's centre, or of the eye, with " (the eye)".
    std::string place_text() const;
    /// "2026-06-21 10:12 UTC+02:00" in the scene's time zone.
    std::string clock_text() const;
    /// "azimuth 114.27, elevation 65.12 (65.13 with refraction)", in degrees, at place_text().
    std::string sun_text() const;

    /// Refraction at a place, by the scene's model and the air of its weather.
    sun::Refraction refraction(const geo::Geodetic& place) const;

    /// The scene's weather; null without one.
    const SceneWeather* weather() const;

    /// Reason for the default view angles; empty if all were given.
    std::string view_reason() const;
    /// Reason for the default time, as scene::DefaultTime::reason(); empty if one was given.
    const std::string& time_reason() const;
    /// climate_text() and ground_text() at the DEM's centre and middle height; empty if no active
    /// effect depends on climate.
    std::string climate_text() const;

    const StageTimes& stages() const;
    /// As render::Renderer::link_rest(): for sessions in which sun or eye may move.
    void link_rest();
    /// Number of programs linked so far.
    int linked_programs() const;
    int triangles() const;  ///< of the last frame
    double ev100() const;   ///< exposure value of the last frame at ISO 100, sun::ev100_of_exposure
    const gl::DeviceInfo& device() const;

  private:
    friend class PictureMaker;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::session
