#pragma once

#include "viewer/film_choice.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// Places widgets in rows, as many in each as have room.
class WidgetRows {
  public:
    /// Before a widget of a width [px]. @returns whether it begins a row
    bool next(float width_px);
    /// Before a widget with its label on its left. @param width_em  of the widget, in text heights
    void next(const char* label, float width_em);
    /// The next widget begins a row.
    void end_row() { is_first_ = true; }

  private:
    bool is_first_ = true;
};

/// What moves.
void film_choice_fields(FilmChoice& choice, const State& state);
/// The film's file. @param is_centred  as in the export sheet
void film_file_fields(FilmFile& file, bool& is_centred, glm::vec2 window_px);

}  // namespace relevo::viewer
