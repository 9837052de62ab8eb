#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geo/geodetic.h"
#include "names/gazetteer.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// A place that a text means.
struct FoundPlace {
    std::string name;  ///< or coordinates
    geo::Geodetic place;
    const names::Entry* summit = nullptr;  ///< of a summit that Relevo brings
    std::string details{};                 ///< "AT, 12.3 km NNW of the DEM's middle"
};

/// Places whose names have a text, whatever its case, of the files that active effects show as
/// marks. Names that begin with it come first.
/// @param most  at most so many
std::vector<FoundPlace> find_names(const std::string& text, const EffectsModel& effects,
                                   std::size_t most);

/// "12.3 km NNW of the DEM's middle" of a DEM, or "834.0 km N, outside the DEM".
std::string way_text(const geo::Geodetic& place, const dem::Grid& grid);

/// Asks for coordinates or a name, and goes there. Finds names of files that are shown, and those
/// that Relevo brings.
class FindSheet {
  public:
    FindSheet();
    ~FindSheet();
    void open();
    void close() { is_open_ = false; }
    /// @param state  gets the names in the list, for their letters
    /// @param grid   of the DEM
    void draw(glm::vec2 size_px, State& state, const dem::Grid& grid);
    /// The place that was chosen since the last call.
    std::optional<FoundPlace> take() { return std::exchange(chosen_, std::nullopt); }

  private:
    class Search;
    bool draw_field();
    void look_up(State& state, const dem::Grid& grid);
    void draw_rows();
    void choose(const FoundPlace& place);

    bool is_open_ = false, takes_focus_ = false;
    bool enters_ = false;  ///< chooses a row when the names are found
    std::string text_, error_;
    std::optional<std::string> searched_;  ///< none: nothing yet on this grid
    const dem::Grid* grid_ = nullptr;
    std::vector<FoundPlace> own_, rows_;  ///< coordinates and names of files; all
    bool is_done_ = false;                ///< the search for `searched_` has ended
    int selected_ = 0;
    std::unique_ptr<Search> search_;  ///< null until the sheet is opened
    std::optional<FoundPlace> chosen_;
};

}  // namespace relevo::viewer
