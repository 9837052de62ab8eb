#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dem/fill_holes.h"
#include "dem/source.h"
#include "effect/preset.h"
#include "scene/view.h"
#include "weather/facts.h"

namespace relevo::scene {

/// A time as text, as given by --time, --date and --tz. session::parse() reads it.
struct TimeSpec {
    std::string at;    ///< "2026-06-21T18:30+02:00", "sunset-30min"; empty: scene::DefaultDay
    std::string date;  ///< of an event
    std::string zone;  ///< "Europe/Zurich", "auto", "solar"; empty: auto, that of the place

    bool operator==(const TimeSpec&) const = default;
};

/// Which effects are on, with which values.
struct Effects {
    effect::Switches switches;
    std::vector<std::string> presets;  ///< names and paths, applied in turn before the rest
    std::vector<effect::Setting> settings;
    std::vector<std::string> plugin_path;  ///< folders of further plugins
    /// Of Scene::weather. Sessions find it; no file has it.
    weather::Facts weather{};

    bool operator==(const Effects&) const = default;
};

/// A week: a 32-bit float still has steps of 1/16 s there.
inline constexpr double kMaxSeconds = 604800;

/// A raster that lies on the ground: figures in colours of a ramp, or an image in its own.
struct Overlay {
    std::string file;     ///< a name that GDAL opens
    int band = 1;         ///< from 1; of an image: 1 draws the image, others their band
    std::string colours;  ///< a ramp's name or a colour file; empty: by what the band says it is
    std::optional<std::pair<double, double>> range;  ///< of a ramp's ends; none: the raster's
    double opacity = 1;                              ///< 0 to 1
    bool lit = false;      ///< shaded by the scene's sun; else drawn in its own colours
    bool shadows = false;  ///< cast shadows are on also if it shows sunlight of its own time
    std::string title;     ///< of the legend; empty: the band's name

    bool operator==(const Overlay&) const = default;
};

/// Whether a text is the path of a file, which has a slash or a dot, and not one of the names that
/// the program knows.
bool names_file(std::string_view name_or_path);

/// A map of what grows on the ground and what is bare, which effects take for the climate's word.
struct LandCover {
    std::string file;     ///< a raster of classes that GDAL opens; empty: no map
    std::string classes;  ///< what they are: a name that the program knows, or a table's file
    bool climate_alone = false;  ///< without the shares that come with the program
    bool surface = false;  ///< the heights are of roofs and tree tops, which are drawn as such

    bool operator==(const LandCover&) const = default;
};

/// What stands on a picture beside the ground, in its corners and, of the graticule, on the ground.
struct Stamps {
    bool legend = true;  ///< of what colours mean, where there is something to tell
    bool title = false, scale = false, north = false, graticule = false, date = false, sun = false,
         attribution = false;
    bool exaggeration = false;     ///< where it is not 1
    bool margin = false;           ///< they stand around the view, not on it
    std::string title_text;        ///< empty: the DEM's name
    std::string attribution_text;  ///< needed with `attribution`

    bool operator==(const Stamps&) const = default;
};

/// Paper that a map is printed on (scene/sheet.h). Scenes with one have `ortho` and Stamps::margin.
struct Sheet {
    std::string paper;  ///< a word of --sheet, "a3-landscape"; empty: none
    double scale = 0;   ///< n of 1 : n; 0: the roundest at which all of the DEM fits
    double dpi = 300;   ///< pixels per inch

    bool is_on() const { return !paper.empty(); }
    bool operator==(const Sheet&) const = default;
};

/// Background of the DEM in the picture.
enum class Backdrop {
    Auto,     ///< Horizon in aerial views, else Studio
    Horizon,  ///< sky and air, wherever the eye is
    Studio    ///< from outside a plain one, and the DEM as a block
};

/// The backdrop of a view: what was chosen, or what Auto means for it.
inline Backdrop backdrop_of(Backdrop chosen, const View& view) {
    if (chosen != Backdrop::Auto) return chosen;
    return view.orbit.aerial && !view.eye ? Backdrop::Horizon : Backdrop::Studio;
}

/// Everything that decides about a picture but the device it is drawn on: a value, which the
/// command line, files and windows make, and a session draws. Ranges and words: options().
struct Scene {
    std::vector<std::string> dems;        ///< names that GDAL opens; several are one DEM
    dem::LoadOptions dem;                 ///< how they are read
    dem::Holes holes = dem::Holes::Fill;  ///< how they are drawn
    TimeSpec time;
    std::string refraction = "standard";
    std::string weather;  ///< a METAR; empty: none. Readers replace names of files by their report
    std::string weather_file;  ///< which that was read from; empty: none. No scene file has it
    std::string forecast;      ///< a file of cloud cover instead; empty: none
    std::optional<double> station_height_m;  ///< of the weather's station; none: of the ground
    View view;
    Backdrop backdrop = Backdrop::Auto;
    std::optional<Overlay> overlay;
    LandCover land_cover;
    Stamps stamps;
    double exaggeration = 1;
    /// The session chooses the exaggeration by the DEM, and then resets this. Of the command line:
    /// no file has it.
    bool chooses_exaggeration = false;
    Effects effects;
    int width_px = 1280, height_px = 720;  ///< 1 to kMaxSide_px
    double seconds = 0;  ///< of effects that move, frame.seconds in their shaders; to kMaxSeconds
    double exposure_ev = 0;
    std::optional<double> ev100;  ///< exposure of a camera, not that of the sun's elevation
    double pixel_error = 4;       ///< render::TerrainOptions
    int samples = 1;              ///< of each pixel, 1 to kMaxSamples
    bool transparent = false;     ///< what shows no ground of the DEM
    bool ortho = false;           ///< pictures are maps (scene/map_view.h), and `view` is not used
    double resolution = 0;  ///< of a map: side of a pixel [units of the DEM's CRS]; 0: by size
    Sheet sheet;            ///< then the picture's size follows from it

    bool operator==(const Scene&) const = default;
};

/// A raster that a scene lays on the ground, and the file of its colours or classes.
struct Layer {
    std::string raster, table;         ///< table: empty without a file
    const char *role, *role_of_table;  ///< "the overlay", "the colours"
};

/// The land cover and the overlay, if a scene has them.
std::vector<Layer> layers_of(const Scene& scene);

inline constexpr int kMaxSide_px = 65536;
inline constexpr int kMaxSamples = 64;

/// Takes out all stamps but the legend, and puts in those of a list: "title,scale", "all", "none".
/// Without words for it "all" leaves out the attribution.
/// @param who  what an error begins with
/// @throws Error (BadInput) for other words
void show_stamps(const std::vector<std::string>& words, std::string_view who, Stamps& stamps);

/// Reads a scene from a file, docs/scene.md. Paths that are relative count from the file's folder.
/// @throws Error (BadInput) `scene: FILE:LINE: camera.fov: what, expected E but got G`
Scene read_scene(const std::filesystem::path& path);

/// The same from a text, such as that inside a picture.
/// @param file    as messages name it
/// @param folder  from which relative paths count
Scene read_scene_text(const std::string& text, const std::string& file,
                      const std::filesystem::path& folder);

/// Effects with a change: `only` and presets replace those before, the rest is added; what is
/// switched on is no longer off, and the other way round; of a parameter the last value counts.
Effects merge(Effects effects, const Effects& change);

/// The file of a scene. Paths below `folder` are written relative to it, others absolute.
std::string scene_text(const Scene& scene, const std::filesystem::path& folder);

/// The same on one line, with absolute paths: what pictures carry, and what tells whether two
/// scenes are one.
std::string scene_line(const Scene& scene);

/// The same of what with_absolute_paths() returns, without a look at the disk: each name costs some
/// 20 us there.
std::string whole_scene_line(const Scene& scene);

/// The same with absolute names of the files there are, which then hold in any folder.
Scene with_absolute_paths(Scene scene);

}  // namespace relevo::scene
