#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files_in_use.h"
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
#include "session/overlay_time.h"
#include "sun/zone.h"

/// What every front end shares: a scene becomes frames, pictures and words about them.
namespace relevo::session {

/// A DEM that has been read. What refers to it may be used on several threads at once.
struct LoadedDem {
    std::shared_ptr<const dem::Source> source;  ///< never null
    dem::Heightfield field;                     ///< all posts, or means of them
    double took_ms = 0;
    /// Memory would hold finer ones, which are not read yet: for pictures in the meantime, and no
    /// figure may come of `field`.
    bool stands_in = false;
    /// For pictures alone, where holes were filled.
    struct Drawn {
        std::optional<dem::Heightfield> filled;  ///< none: as `field`
        Array2d<std::uint8_t> is_filled;  ///< as dem::FilledHoles::filled; empty where none is
        bool has_covers = false;          ///< voids too wide to be filled have a cover
        dem::Water water;                 ///< of what is drawn
        std::string holes_text;           ///< for people; empty where there are none
    };
    Drawn drawn{};
    std::optional<dem::Pyramid> pyramid{};  ///< of to_draw(); none: a session makes its own

    const dem::Heightfield& to_draw() const { return drawn.filled ? *drawn.filled : field; }
    /// Words of effect::ground_words() that hold.
    std::vector<std::string> ground_words(dem::Holes holes) const;
    /// The height of the posts there [m], also where only means of them are in memory; NaN where
    /// there is no ground.
    double height_m(const geo::Geodetic& at) const;
};

/// Reads the heights of a scene's DEM, and finds what is drawn of them.
/// @throws Error as dem::load()
std::shared_ptr<const LoadedDem> load_dem(std::shared_ptr<const dem::Source> source,
                                          const scene::Scene& scene);

/// What stands in for a large DEM with overviews while it is read (LoadedDem::stands_in), and else
/// null. @throws Error likewise
std::shared_ptr<const LoadedDem> load_stand_in(std::shared_ptr<const dem::Source> source,
                                               const scene::Scene& scene);

/// The ground of a DEM, in a frame about the middle of all its posts.
render::Ground ground_of(const LoadedDem& dem);

struct Options {
    std::string device = "auto";  ///< as gl::Context takes it
    /// Gives the context of a window instead of one on `device`.
    std::function<gl::Context()> context{};
    /// The scene's DEM where it has been read already, such as for another session; else it is
    /// read.
    std::shared_ptr<const LoadedDem> dem{};
    /// Begin with what stands in for a DEM that takes long to read, where the scene allows it:
    /// Session::dem() says whether it does, and Session::take() brings the rest.
    bool may_stand_in = false;
    bool radiance = false;  ///< keep linear light, for Session::radiance()
    /// Keep with each frame what audits read, for read_sun_seen().
    bool audited = false;
    /// Effects of a comparison: pictures have them on the left and not on the right.
    std::vector<std::string> compared{};
    /// Called with the programs' texts before a driver sees them.
    std::function<void(const render::StitchedFrames&)> stitched{};
};

struct ActiveEffects;

/// Milliseconds of stages by their names: "device", "compile", "load", "upload". Loading goes on
/// beside the first two, so that their sum is more than the whole.
using StageTimes = std::vector<std::pair<std::string, double>>;

/// A scene on a device: its DEM, its effects and what draws them. Frames follow what is changed
/// here, without anything being loaded or compiled again. Several may live at once, each used on
/// the thread that made it.
class Session {
  public:
    /// Opens everything. The DEM is read on a thread of its own meanwhile.
    /// @param files  gets what the scene is read from, so that no output replaces it
    /// @throws Error as those who open: (BadInput, NoDevice, Failed)
    Session(scene::Scene scene, Options options, FilesInUse& files);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// As it is now; files that parameters name have absolute paths.
    const scene::Scene& scene() const;
    /// Moves the camera. An eye that is given above the ground stands on the ground as it is drawn.
    /// @param keep_above_m  other eyes are raised to be so far above it; none: they stay where they
    ///                      are given
    /// @throws Error (BadInput) as scene::make_camera
    void look(const scene::View& view, std::optional<double> keep_above_m = std::nullopt);
    /// Heights to aim cameras at, as effects draw the ground now; keeps the DEM, for any thread.
    scene::GroundHeight heights_to_aim_at() const;
    /// Moves the sun.
    void set_moment(sun::Instant utc);
    /// Shows another scene of the same DEM, with no more work than what differs takes. Its frames
    /// are the same bytes whatever was drawn before them.
    /// @param utc  the scene's moment
    /// @throws Error as look(), set(), set_effects() and resize(); another scene may be shown then
    void show(const scene::Scene& scene, sun::Instant utc);
    /// Draws with other effects, or with what their files have become, from the next frame on.
    /// @throws Error as those who load, compile and draw; the session then goes on as it was
    void set_effects(const scene::Effects& effects);
    /// The effects there are, those that are on, and their parameters.
    const ActiveEffects& effects() const;
    /// Sets a parameter that is not static. @throws Error (BadInput) as shader::ParamStore::set
    void set(const std::string& address, const std::string& value);
    /// Sides of the picture [px].
    void resize(int width_px, int height_px);
    /// Lays colours on the ground from the next frame on; null: none. The first ones are another
    /// program.
    void drape(std::shared_ptr<const render::Drape> drape);
    /// What colours on the ground mean: of the scene's overlay, and of effects that say it.
    std::vector<chart::Legend> legends() const;
    /// Options::compared.
    const std::vector<std::string>& compared() const;
    /// When the scene's overlay is of; none where it is not of the sun. Stamps say it instead of
    /// the scene's own time, and cast shadows, which are another sun's, are off unless asked for.
    const std::optional<OverlayTime>& overlay_time() const;
    /// Likewise of effects alone.
    std::vector<chart::Legend> colour_legends() const;
    /// Whether native effects leave what they have made as it is, such as shadow maps while the sun
    /// is dragged, which cost more than the frame. The light that core finds by place never lags.
    void keep_native(bool keep);

    /// Goes on with all posts of a DEM of which others stood in. The frame stays; view and moment
    /// become those that a session opened with these posts would have.
    /// @param given  the scene as it was opened
    /// @throws Error as those who open; the session cannot be used then
    void take(std::shared_ptr<const LoadedDem> dem, const scene::Scene& given);

    sun::Instant moment() const;

    /// Draws a frame of the scene as it is now, whole.
    /// @param times  filled with what each pass took if not null
    void draw(render::PassTimes* times = nullptr);
    /// Draws a frame at once: what is not loaded yet is coarser, and being loaded.
    /// @returns whether all was there; if not, the next frame has more
    bool draw_what_is_there();
    /// Whether the next frame would have more of it if one waited.
    bool is_loading() const;
    /// Draws none of a comparison's other half, and waits for the device.
    void draw_alone();

    /// The last frame with the scene's stamps; of a comparison, both halves.
    /// @throws Error (Failed) where light or colour is no number, naming the effect
    image::Image8 picture() const;
    /// What the last picture() has no stamp of though the scene wants it: whole sentences.
    const std::vector<std::string>& stamp_notes() const;
    /// The same as linear radiance, without stamps; Options::radiance.
    image::ImageF radiance() const;
    /// The picture on the device, RGBA with rows from below, until the next frame.
    const gl::Texture& texture() const;
    /// As render::Renderer::depth().
    const gl::Texture& depth() const;
    /// Whether ground of the DEM is in the last frame; of a comparison, in its left half's.
    bool shows_ground() const;
    /// As render::Renderer::read_depths().
    void read_depths(std::vector<float>& depths_m) const;

    /// As render::Renderer::read_sun_seen(); of a comparison, with its effects. Options::audited.
    std::vector<render::SunSeen> read_sun_seen() const;
    /// The sun as frames have it.
    const render::SunLight& sun_light() const;

    const scene::Camera& camera() const;
    /// What orbits fit into the picture, as it is now.
    scene::Outline outline() const;
    /// Its DEM, which may outlive it.
    const std::shared_ptr<const LoadedDem>& dem() const;
    /// The DEM's ground; its local frame is the camera's.
    const render::Ground& ground() const;

    /// What is drawn of holes, what was assumed of water, and what effects invent of the ground
    /// that the camera is near: whole sentences.
    std::vector<std::string> ground_notes() const;

    /// "46.50 N 8.00 E", with " (the eye)" where it is that and not the DEM's middle.
    std::string place_text() const;
    /// "2026-06-21 10:12 UTC+02:00", by the clocks of the scene's zone.
    std::string clock_text() const;
    /// "azimuth 114.27, elevation 65.12 (65.13 with refraction)", as seen from there.
    std::string sun_text() const;

    /// Why the ground is seen from where it is, and empty where all of that was given.
    std::string view_reason() const;
    /// Why it is that time, as scene::DefaultMoment::reason(), and empty where one was given.
    const std::string& moment_reason() const;
    /// climate_text() and ground_text() of the DEM's middle, at the middle of its heights; empty
    /// where no effect that is on draws by the climate.
    std::string climate_text() const;

    const StageTimes& stages() const;
    /// As render::Renderer::link_rest(): for sessions whose user may move the sun or the eye.
    void link_rest();
    /// How many programs the driver has linked so far.
    int linked_programs() const;
    int triangles() const;  ///< of the last frame
    const gl::DeviceInfo& device() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::session
