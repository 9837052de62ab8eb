#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "render/frame_block.h"
#include "sun/moon_events.h"
#include "viewer/command.h"
#include "viewer/document.h"
#include "viewer/layout.h"
#include "viewer/measurement.h"
#include "viewer/point_light.h"
#include "viewer/scene_thread.h"
#include "viewer/settings.h"
#include "viewer/sun_model.h"
#include "viewer/sun_overlay.h"

/// The data that panels show and change.
namespace relevo::viewer {

/// The ground under the cursor.
struct Cursor {
    glm::dvec3 point_m{0};  ///< in the local frame
    geo::Geodetic place;    ///< height of the DEM; NaN in voids and on the sides of a block
    double slope_deg = std::numeric_limits<double>::quiet_NaN();  ///< NaN next to voids, too
    /// Downhill, from true north; NaN where level.
    double aspect_deg = std::numeric_limits<double>::quiet_NaN();
};

struct State {
    Document document;
    Land land;
    geo::Geodetic centre;                           ///< of the DEM
    sun::Refraction air = sun::Refraction::none();  ///< at the DEM's centre
    std::unique_ptr<EffectsModel> effects;
    effect::GroundWords ground_words;  ///< of the DEM; empty: not known yet
    bool is_outside = false;           ///< the DEM is seen as a block
    bool is_preview = false;           ///< a coarse DEM stands in until all posts are read
    SunDay day;
    std::vector<SunDay> extremes;      ///< the solstices of its year
    std::optional<sun::MoonDay> moon;  ///< of the day; nullopt: not computed yet

    bool time_is_pinned = false;  ///< other DEMs are shown at this time of day even if it is night
    bool playing = false;
    double hours_a_second = 1;
    std::string search, zone_text;   ///< text in input fields
    std::string found_names;         ///< in the list of the sheet that finds places
    std::string zone_to_show;        ///< a request: "Europe/Zurich", "auto"; empty: none
    int sensor = 0;                  ///< of the panel Camera
    float dragged_exaggeration = 1;  ///< while its slider is dragged
    bool drags_exaggeration = false;
    bool chooses_exaggeration = false;  ///< by the DEM, as long as nobody sets it or moves the time
    bool compare_is_wanted = false;     ///< with the effects at the time it starts

    Settings settings;
    std::vector<RecentDem> recent;  ///< DEMs, latest first
    std::vector<SavedView> views;   ///< of this DEM
    double spacing_m = 1;           ///< mean post spacing

    std::optional<Cursor> cursor;
    std::optional<geo::Geodetic> chosen;      ///< the clicked point
    std::shared_ptr<const PointLight> point;  ///< its sunlight; null: not computed yet
    bool point_in_work = false;               ///< `point` is incomplete
    Measurement measurement;
    std::string undo_name, redo_name;  ///< what undo and redo would change; empty: nothing
    bool opens_menu = false;           ///< a request: the first menu

    std::shared_ptr<const OverlayShown> overlay;  ///< on the ground; null: none
    std::optional<double> overlay_progress;       ///< of its computation, 0 to 1
    std::optional<double> saving_progress;        ///< of an overlay's export, 0 to 1
    std::string saved_overlay;                    ///< the file of an exported overlay; empty: none
    std::set<std::string> files_outside;          ///< of layers, of which nothing is on the DEM
    std::vector<chart::Legend> layer_legends;     ///< of effects, of the displayed image

    std::string message;  ///< the last error or note

    // Requests of the panels in this frame.
    std::vector<Command> commands;
    std::vector<std::string> files_to_open;
    std::optional<RecentDem> recent_to_open;
    std::optional<std::size_t> view_to_go_to;  ///< of views
    bool views_changed = false;
    float point_room_px = 0;  ///< height of the point's text
    Layout layout;            ///< of this frame
    glm::ivec2 chart_px{0};   ///< size of the point's charts; 0: hidden
    bool sun_moves = false;   ///< the user drags a widget of the sun
    bool step = false;        ///< a change is complete: a step of undo
    std::optional<scene::Effects> asked_effects;

    /// Places the observer of the sun at a DEM's centre, with the scene's refraction there.
    void stand_on(const render::Ground& ground);
    /// Takes ground, heights and post spacing of the DEM that is open. `land` refers to `opened`.
    /// @throws Error (BadInput) if its effects cannot be loaded or selected
    void use_dem_of(const Opened& opened);
    /// Sets the time. Ignores dates outside 1900-2100.
    void set_utc(sun::Instant utc);
    /// The same time of another day.
    void set_date(sun::Date date);
    /// Requests other effects or values, also of static parameters. take_effects() applies them
    /// after the panels are drawn.
    void set_effects(scene::Effects changed) { asked_effects = std::move(changed); }
    /// Sets a parameter of an effect.
    void set_value(const shader::Param& param, const std::string& text);
    /// Makes the requested effects those of the document. @param is_step  for undo
    void take_effects(bool is_step);
    /// Replaces the document with a state of its history.
    void restore(const Document& restored);
};

/// "September", in the user's language. @param month  1 to 12
const char* month_name(int month);
/// Date, time and the day's light at the lower edge.
void time_bar(State& state);
void sun_panel(State& state);
/// "azimuth 114.27°, height 65.13°": the sun's position at the DEM's centre.
std::string sun_figures(const State& state);

/// Lens, exposure, exaggeration and time zone. @param aspect  of the window
void view_panel(State& state, double aspect);
void effects_panel(State& state);
/// The values of one effect, those that matter most first.
void effect_values(State& state, const effect::Effect& effect);
void menu_bar(State& state);
/// The panels of the scene, in one column, whose width the user can change.
/// @param size_px    of the window
/// @param px_a_unit  pixels per unit of a layout for the default text size
void side_panel(State& state, glm::vec2 size_px, double px_a_unit);
/// The ground under the cursor, in the picture's lower left corner.
/// @param work  in progress; empty: none
void status_line(const State& state, const std::string& work);
/// Before the first picture, in its place.
void draw_no_picture();
/// While the first scene opens. @param since_s  for so long
void opening_card(const State& state, const scene::Scene& scene, double since_s);
/// State::message, at the picture's upper edge, also if panels are hidden.
void message_box(State& state, double px_a_unit);
void point_panel(State& state);
/// What can be done with the chosen point. @param opens  at the cursor
void point_menu(State& state, bool opens);
/// What lies on the ground, from top to bottom.
void layers_panel(State& state);
/// The choice of the overlay, its computation and export.
void overlay_panel(State& state);
/// "sun hours 5.43 h": the overlay's value at a place; empty: unknown.
std::string overlay_words(const OverlayShown& overlay, const geo::Geodetic& place);

/// The sun path of the day with its hours; parts behind the ground are faint.
/// @param picture  the displayed image; its depths give the ground
/// @param size_px  of the window
void draw_sun_path(const State& state, const Picture& picture, glm::vec2 size_px);
/// The time whose sun is nearest to a place in the window; none if the sun path is not near.
std::optional<sun::Instant> time_at(const State& state, const Picture& picture, glm::vec2 size_px,
                                    glm::vec2 at_px);

}  // namespace relevo::viewer
