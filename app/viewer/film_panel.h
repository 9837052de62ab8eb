#pragma once

#include <optional>
#include <string>

#include "viewer/film_choice.h"
#include "viewer/film_clock.h"
#include "viewer/film_export.h"
#include "viewer/film_plan.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// What the film panel shows.
struct FilmStatus {
    const FilmPlan* plan = nullptr;  ///< the latest; null: none yet
    bool is_planned = false;         ///< `plan` is of what is chosen now
    bool shows_frame = false;
    const FilmExport* drawing = nullptr;  ///< the film in work
    std::string error;                    ///< of the last film
    std::string missing;                  ///< what of the window is not in the film; empty: nothing
};

/// What the user does with a film.
enum class FilmAction { ShowFrame, EndPreview, SaveFilm, SaveJob, CopyCommand, ShowTrack, Cancel };

/// The time line at the lower edge of the window, and above it the settings of the film while no
/// frame is shown.
class FilmPanel {
  public:
    void toggle() { is_open_ = !is_open_; }
    void close() { is_open_ = false; }
    bool is_open() const { return is_open_; }
    const FilmChoice& choice() const { return choice_; }
    bool is_centred() const { return is_centred_; }

    /// @param clock    its position; the panel moves and plays it
    /// @param left_px, right_px  the part of the window's lower edge that is free
    std::optional<FilmAction> draw(State& state, FilmClock& clock, const FilmStatus& status,
                                   glm::vec2 window_px, float left_px, float right_px);

  private:
    void time_line(FilmClock& clock, const FilmStatus& status);
    void stamp(const State& state, const FilmClock& clock, const FilmStatus& status) const;
    void buttons(const FilmStatus& status);

    bool is_open_ = false, is_centred_ = true;
    FilmChoice choice_ = film_presets().front().choice;
    std::optional<FilmAction> action_;
};

/// Darkens what a window shows at both sides of a film that is narrower.
/// @param aspect  of the film, width over height
void draw_film_edges(double aspect, glm::vec2 size_px);

}  // namespace relevo::viewer
