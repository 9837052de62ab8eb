#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "geo/geodetic.h"
#include "viewer/document.h"

namespace relevo::viewer {

/// A place with a name, of a file that an effect shows.
struct FoundPlace {
    std::string name;
    geo::Geodetic place;
};

/// Places whose names have a text, whatever its case, of the files that active effects show as
/// marks. Names that begin with it come first.
/// @param most  at most so many
std::vector<FoundPlace> find_names(const std::string& text, const EffectsModel& effects,
                                   std::size_t most);

/// Asks for coordinates or a name, and goes there.
class FindSheet {
  public:
    void open() { is_open_ = takes_focus_ = true; }
    void close() { is_open_ = false; }
    /// @param effects  null: none yet
    void draw(glm::vec2 size_px, const EffectsModel* effects);
    /// The place that was chosen since the last call.
    std::optional<geo::Geodetic> take() { return std::exchange(chosen_, std::nullopt); }

  private:
    void choose(const geo::Geodetic& place);

    bool is_open_ = false, takes_focus_ = false;
    std::string text_, searched_;
    std::vector<FoundPlace> found_;
    std::optional<geo::Geodetic> chosen_;
};

}  // namespace relevo::viewer
