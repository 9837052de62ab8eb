#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/frame_block.h"
#include "viewer/command.h"
#include "viewer/document.h"
#include "viewer/overlay.h"
#include "viewer/point_light.h"
#include "viewer/scene_thread.h"
#include "viewer/settings.h"
#include "viewer/sun_model.h"
#include "viewer/sun_overlay.h"

/// What panels show and change.
namespace relevo::viewer {

/// The ground under the cursor.
struct Cursor {
    glm::dvec3 point_m{0};  ///< in the local frame
    geo::Geodetic place;    ///< height as the DEM has it; NaN in holes and on the sides of a block
    double slope_deg = std::numeric_limits<double>::quiet_NaN();  ///< NaN beside holes, too
    /// Downhill, from true north; NaN where level.
    double aspect_deg = std::numeric_limits<double>::quiet_NaN();
};

struct State {
    Document document;
    Land land;
    geo::Geodetic centre;                           ///< of the DEM
    sun::Refraction air = sun::Refraction::none();  ///< over it
    std::unique_ptr<EffectsModel> effects;
    effect::GroundWords ground_words;  ///< what the DEM has; none: it is not known yet
    bool stands_in = false;            ///< not all of its posts have been read
    SunDay day;
    std::vector<SunDay> extremes;  ///< the solstices of its year

    bool playing = false;
    double hours_a_second = 1;
    std::string search, place;       ///< as they are being written
    bool compare_is_wanted = false;  ///< with the effects as they are when it is

    Settings settings;
    std::vector<RecentDem> recent;  ///< DEMs that were opened
    std::vector<SavedView> views;   ///< of this DEM
    double spacing_m = 1;           ///< of its posts, about

    std::optional<Cursor> cursor;
    std::optional<geo::Geodetic> chosen;      ///< that was clicked
    std::shared_ptr<const PointLight> point;  ///< what is known of it; null: nothing yet
    bool point_in_work = false;               ///< there is more to come
    std::vector<glm::dvec3> measured;         ///< ends of a measured line, up to two
    bool measuring = false;                   ///< its second end follows the cursor
    std::optional<Profile> profile;           ///< of that line

    std::shared_ptr<const OverlayShown> overlay;  ///< that lies on the ground; null: none
    std::optional<double> overlay_progress;       ///< of what is worked out for it
    std::optional<double> saving_progress;        ///< of a raster that is being written
    std::string saved_overlay;                    ///< the file that has it; empty: none yet

    std::string message;  ///< the last thing that went wrong, or was done

    // What panels have done in this frame.
    std::vector<Command> commands;
    std::vector<std::string> files_to_open;
    std::optional<RecentDem> recent_to_open;
    std::optional<std::size_t> view_to_go_to;  ///< of views
    std::string place_to_go_to;                ///< "47.4395, 11.8935"; empty: none
    bool views_changed = false;
    /// Where the side panel lies, from left to right [px]; none: not drawn yet.
    std::optional<glm::vec2> side_panel_px;
    float point_room_px = 0;  ///< that the point's lines have had
    glm::ivec2 chart_px{0};   ///< that drawings of the point have room in; 0: none is shown
    bool sun_moves = false;   ///< a widget of the sun is held
    bool step = false;        ///< a change is done, for undo
    std::optional<scene::Effects> asked_effects;
    std::optional<scene::Effects> new_effects;  ///< for the thread that draws
    std::vector<std::pair<std::string, std::string>> new_values;

    /// The sun is seen from a DEM's middle from now on, through the air that the scene has there.
    void stand_on(const render::Ground& ground);
    /// Moves the sun. Dates outside 1900-2100 leave it where it is.
    void set_utc(sun::Instant utc);
    /// Other switches or values, of parameters that need another program too. Panels go on with the
    /// effects that they show; take_effects() follows.
    void set_effects(scene::Effects changed) { asked_effects = std::move(changed); }
    /// Makes what was asked for the document's. @param is_step  for undo
    void take_effects(bool is_step);
};

void sun_panel(State& state);
/// "azimuth 114.27°, height 65.13°": where the sun is seen from the DEM's middle.
std::string sun_figures(const State& state);

void effects_panel(State& state);
void menu_bar(State& state);
/// Those that are about the scene, one below the other.
/// @param size_px    of the window; likewise below
/// @param px_a_unit  of what is made for usual letters; likewise
void side_panel(State& state, glm::vec2 size_px, double px_a_unit);
/// What it covers where it stands at a side of the window; none where it covers most of it.
scene::Insets side_panel_insets(const State& state, glm::vec2 size_px, double px_a_unit);
/// The ground under the cursor, at the lower edge.
void status_line(const State& state, bool is_drawing);
/// While no scene is open.
/// @param can_give_up  there was another one before
void waiting_text(const State& state, bool has_failed, bool can_give_up);
/// State::message, at the upper edge, also where there are no panels.
void message_box(State& state, glm::vec2 size_px, double px_a_unit);
void point_panel(State& state);
void overlay_panel(State& state);
/// "sun hours 5.43 h": what lies on the ground there; empty: nothing that is known.
std::string overlay_words(const OverlayShown& overlay, const geo::Geodetic& place);

/// The sun's way of the day over the picture, with its hours; what the ground hides is faint.
/// @param picture  that is shown, in whose pixels the ground is looked up
/// @param size_px  of the window
void draw_sun_path(const State& state, const Picture& picture, glm::vec2 size_px);
/// The moment whose sun is nearest to a place in the window; none where no part of the way is near.
std::optional<sun::Instant> moment_at(const State& state, const Picture& picture, glm::vec2 size_px,
                                      glm::vec2 at_px);

}  // namespace relevo::viewer
