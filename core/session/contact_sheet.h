#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "scene/job.h"
#include "session/scene_times.h"

/// One picture that shows all pictures of a job, smaller and with captions.
namespace relevo::session {

/// Where the pictures of a sheet are. The cells are alike; a picture that is wider or higher than
/// they are is smaller, in the middle of its cell.
struct SheetLayout {
    static constexpr int kCell_px = 320;    ///< width of a cell
    static constexpr int kGap_px = 12;      ///< between cells and around them
    static constexpr int kCaption_px = 24;  ///< height of the caption below a cell
    static constexpr int kMostSide_px = 16384;
    static constexpr double kMost_px = 1e8;

    int columns = 1, rows = 1;
    glm::ivec2 cell_px{0};  ///< without its caption

    /// @param pictures    at least one
    /// @param picture_px  size of the first
    /// @param columns     0: so many that the sheet is about as wide as high
    /// @throws Error (BadInput) for a sheet of more than kMostSide_px or kMost_px
    static SheetLayout of(std::size_t pictures, const glm::ivec2& picture_px, int columns);

    glm::ivec2 size_px() const;
    /// Upper left corner of a cell.
    glm::ivec2 corner_px(std::size_t picture) const;
};

/// What tells each picture from the others: its time, and names of shots, cameras, sites and
/// effects and values of parameters that differ. In the time zone of the picture.
std::vector<std::string> captions_of(const std::vector<scene::Shot>& shots);

struct SheetOptions {
    std::string device = "auto";  ///< as gl::Context
    std::filesystem::path output;
    bool overwrite = false;
    bool allow_blank = false;  ///< also writes a sheet of which no picture shows ground
    int columns = 0;           ///< as SheetLayout::of()
    image::Encoding encoding{};
    image::Metadata metadata{};
    /// Called with the number of pictures that are drawn.
    std::function<void(std::size_t)> drawn = [](std::size_t) {};
};

/// What became of a sheet.
struct SheetReport {
    glm::ivec2 size_px{0};
    std::size_t blank = 0;        ///< pictures that show no ground of the DEM
    std::size_t first_blank = 0;  ///< from 1
};

/// Draws shots as the cells of one picture. Each is scaled down as soon as it is drawn. The file
/// appears complete or not at all.
/// @param shots  settled, at least one
/// @throws Error as SheetLayout::of(), Session's constructor and image::write(), and (Failed) for a
///     picture that cannot be drawn, with its number, and if none shows ground
SheetReport draw_contact_sheet(const std::vector<scene::Shot>& shots, const SheetOptions& options,
                               SceneTimes& times, FilesInUse& files);

}  // namespace relevo::session
