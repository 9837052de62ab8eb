#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/film_panel.h"
#include "viewer/film_preview.h"
#include "viewer/messages.h"

namespace relevo::viewer {

/// What a film takes from the window.
struct FilmSource {
    /// The scene of the document, with its overlay if a file has it.
    /// @param is_centred  on what the panels leave free, for a picture of this aspect
    std::function<scene::Scene(const Document&, bool is_centred, double aspect)> scene;
    std::function<Pose(const scene::View&)> pose_of;
    /// The part of a message that reports a scene without its overlay; else empty.
    std::function<std::string()> missing_overlay;
};

/// The film of the window: its panel, the preview of its frames, and the file.
class FilmController {
  public:
    /// @param state, messages  outlive this
    /// @param device  as session::Options
    FilmController(State& state, Messages& messages, std::string device, FilmSource source);

    void toggle() { panel_.toggle(); }
    void close() { panel_.close(); }
    bool is_open() const { return panel_.is_open(); }
    void play_or_pause();
    bool is_playing() const { return preview_.is_on() && clock_.is_playing(); }
    /// Whether the document is that of a frame.
    bool shows_frame() const { return preview_.is_on(); }
    /// Restores the document without a frame.
    void end_preview();
    /// Before another scene: its document is not this one's.
    void forget();

    /// Makes the document that of the frame after some time [s]. @returns whether it has changed
    bool advance(double passed_s);
    /// Draws the panel. @param left_px, right_px  the free part of the window's lower edge
    void draw(glm::vec2 window_px, float left_px, float right_px);
    /// Draws over the image of a frame what is not in the film.
    void draw_edges(glm::vec2 window_px) const;
    /// Plans the film, and does what the panel asks for. @returns whether panels have changed
    /// @param is_at_rest  neither camera nor sun moves
    bool update(const Opened& opened, bool is_at_rest);
    /// The line of a flight that is to be shown on the ground; empty: none.
    std::string take_track() { return std::exchange(track_to_show_, {}); }

    bool draws_film() const { return film_ != nullptr; }
    /// Reports a film that is done. @returns whether panels have changed
    bool poll();
    /// "drawing day.mp4, 34 of 300 frames"; empty: none is drawn
    std::string progress() const;
    /// Before the window closes while a film is drawn.
    void ask_to_quit() { asks_to_quit_ = true; }
    bool asks_to_quit() const { return asks_to_quit_; }
    /// Draws the question. @returns true if the user quits without the film
    bool draw_question(glm::vec2 window_px);

  private:
    /// Whether plan_ is of what is chosen now.
    bool is_planned() const;
    FilmWish wish() const;
    bool request(const Opened& opened, bool is_at_rest);
    bool take_plan();
    void act(FilmAction action);
    void save_film();

    State& state_;
    Messages& messages_;
    std::string device_;
    FilmSource source_;
    FilmPanel panel_;
    FilmClock clock_;
    FilmPreview preview_;
    FilmWork work_;
    std::optional<FilmWish> requested_;
    bool is_requested_ = false;             // requested_ is what is chosen now
    std::shared_ptr<const FilmPlan> plan_;  // the latest
    int shown_frame_ = -1;                  // of plan_; -1: none
    std::optional<FilmAction> action_;
    std::unique_ptr<FilmExport> film_;
    std::size_t shown_drawn_ = 0;  // frames of film_
    std::string missing_, error_, track_to_show_;
    bool plans_again_ = false, asks_to_quit_ = false;
};

}  // namespace relevo::viewer
