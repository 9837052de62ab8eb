#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/file_stamps.h"
#include "chart/marks.h"
#include "dem/places.h"
#include "effect/module_marks.h"
#include "effect/selection.h"
#include "render/displacement.h"
#include "scene/camera.h"
#include "scene/panorama.h"
#include "session/session.h"

/// Marks of plugins: from their files and native modules to places on the ground to the picture.
namespace relevo::session {

/// What a module gives for a mark, and files do not.
struct MarkLook {
    std::optional<chart::Symbol> symbol;  ///< nullopt: that of the list
    std::optional<double> azimuth_rad;    ///< of the text; nullopt: upright
    std::optional<float> known_ground_m;  ///< height of the ground; nullopt: to be looked up
};

/// The places of a list, the first by rank first.
struct MarkPlaces {
    std::string path;                     ///< of the file; empty if a module has set them
    std::vector<dem::NamedPlace> places;  ///< names are printable()
    std::vector<MarkLook> looks;          ///< of the places; empty: those of a file
    FileStamps read;                      ///< of the file
};

/// Places of a native module's marks.
std::shared_ptr<const MarkPlaces> places_of(const effect::ModuleMarks& marks);

/// An active effect's list of marks. `places` is null if no file is set, for summits, which depend
/// on the DEM, and if its module sets them, which the renderer has then.
struct LoadedMarks {
    const effect::MarksSpec* spec = nullptr;  ///< in the registry
    std::string plugin;                       ///< its id
    std::shared_ptr<const MarkPlaces> places;
};

/// Reads the files of the active effects' marks, and the list of summits if they show it.
/// @param earlier  whose places are used again if their file has not changed
/// @param report   logs which lists have no file
/// @throws Error (BadInput) as dem::read_points() and names::Gazetteer, and for a rank that is not
/// a number
std::vector<LoadedMarks> load_marks(const effect::Selection& selection,
                                    const shader::ParamStore& values,
                                    const std::vector<LoadedMarks>& earlier, bool report);

/// Places of a list in the DEM's local frame. Those without ground are excluded.
struct StandingMarks {
    struct Mark {
        glm::dvec3 at_m{0};       ///< exaggerated, before displacement by effects
        glm::vec3 up{0, 0, 1};    ///< the vertical there
        float height_m = 0;       ///< of the mark, in the DEM's heights
        bool on_ground = true;    ///< false if the list gives a height
        bool on_crests = true;    ///< behind a crest by kHidden_px it is on the crest
        glm::vec3 along{0};       ///< unit vector along the text; 0: it is upright
        std::uint32_t index = 0;  ///< in MarkPlaces::places
    };
    std::shared_ptr<const MarkPlaces> places;
    std::vector<Mark> marks;  ///< in the order of the places
};

/// Of a DEM with means of posts in memory, the first kMostFromFile marks stand on the posts of the
/// file, others on the means.
std::shared_ptr<const StandingMarks> stand(std::shared_ptr<const MarkPlaces> places,
                                           const LoadedDem& dem, const geo::LocalFrame& frame,
                                           double exaggeration);
inline constexpr std::size_t kMostFromFile = 10'000;

/// Keeps where marks stand until file, DEM or exaggeration change.
class MarksOnGround {
  public:
    /// Places of a module's marks. Keeps those of the latest lists.
    std::shared_ptr<const MarkPlaces> places(
        const std::shared_ptr<const effect::ModuleMarks>& marks);
    /// Summits of names::Gazetteer on the tops of the heights as drawn, the highest first. Keeps
    /// those of the latest DEM.
    std::shared_ptr<const MarkPlaces> summits(const std::shared_ptr<const LoadedDem>& dem);
    std::shared_ptr<const StandingMarks> of(const std::shared_ptr<const MarkPlaces>& places,
                                            const std::shared_ptr<const LoadedDem>& dem,
                                            const geo::LocalFrame& frame, double exaggeration);

  private:
    struct Entry {
        std::shared_ptr<const LoadedDem> dem;
        double exaggeration;
        std::shared_ptr<const StandingMarks> standing;
    };
    std::vector<Entry> known_;  // the latest last
    std::vector<std::pair<std::shared_ptr<const effect::ModuleMarks>,
                          std::shared_ptr<const MarkPlaces>>>
        places_;  // the latest last
    std::pair<std::shared_ptr<const LoadedDem>, std::shared_ptr<const MarkPlaces>> summits_;
};

/// A list of marks as a frame shows it.
struct Marks {
    std::shared_ptr<const StandingMarks> standing;
    chart::MarkStyle style;
    effect::MarksSpec::Order order = effect::MarksSpec::Order::Rank;
    double above_m = 0;  ///< raises all marks, in the DEM's heights
    render::Displacement displacement;
    double exaggeration = 1;
    double pixel_error = 0;  ///< of the drawn ground against the posts [px]
};

/// With the values that an effect's parameters have now.
Marks marks_of(const LoadedMarks& loaded, std::shared_ptr<const StandingMarks> standing,
               const shader::ParamStore& values, const render::Displacement& displacement,
               const scene::Scene& scene);

/// A picture in which marks are placed.
struct MarkView {
    const scene::Camera& camera;
    int width_px, height_px;
    /// Depths of pixels, counted from the upper left corner [m]; infinite without ground.
    std::function<std::vector<float>(std::span<const glm::ivec2> pixels)> depths_m;
    /// Of a panorama around the camera's eye. Depths are then distances from the eye.
    struct Around {
        const scene::PanoramaMap& map;
        glm::dmat3 axes;  ///< as eye_axes()
    };
    std::optional<Around> around{};
};

/// A picture with the depths of all its pixels, as render::Renderer::read_depths(), which must
/// outlive the result.
MarkView view_of(const scene::Camera& camera, int width_px, int height_px,
                 const std::vector<float>& depths_m);

/// A panorama with the distances of all its pixels, as PanoramaImage::distances_m(), which must
/// outlive the result.
MarkView view_of(const scene::Camera& camera, const MarkView::Around& around,
                 const std::vector<float>& distances_m);

/// The marks that are in the picture and not hidden by ground, the most important first. A mark on
/// the ground stands where the frame shows ground at its place: displaced by effects, and coarser
/// than the posts by up to `pixel_error`. So much, and at least kHidden_px, may hide of a mark
/// whose place is just behind a crest: it stands on the crest then. Ground that is before a mark by
/// less than kNear of its depth does not hide it. A mark whose ground the module knows is on no
/// crest.
std::vector<chart::MarkPoint> visible_marks(const Marks& marks, const MarkView& view);
inline constexpr double kHidden_px = 3;
inline constexpr double kNear = 0.005;

/// Draws the visible marks of all lists without overlap.
/// @param within  where they may stand; all of the picture or a half
/// @param taken   where they may not: legends and other stamps
void draw_marks(std::span<const Marks> lists, const MarkView& view, const chart::Rect& within,
                std::span<const chart::Rect> taken, chart::Drawing& drawing);

}  // namespace relevo::session
