#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geo/geodetic.h"
#include "scene/scene.h"
#include "sun/time.h"

/// What the window remembers from one time to the next. Whatever is wrong with a file of it, the
/// window opens: what cannot be read is as if it had never been written. Files are replaced whole.
namespace relevo::viewer {

enum class Coordinates { Utm, Mgrs, Degrees };

/// "47.41700 N 11.43708 E", "32N 683473 E 5255234 N", "32TPT8347355234".
std::string coordinates_text(const geo::Geodetic& place, Coordinates coordinates);

inline constexpr int kLeastText_px = 11, kUsualText_px = 16, kMostText_px = 32;

/// How the window looks.
struct Settings {
    bool light_style = false;
    int text_px = kUsualText_px;  ///< kLeastText_px to kMostText_px
    Coordinates coordinates = Coordinates::Utm;
    bool panels = true;  ///< all of them
    bool charts = true;  ///< the chosen point's horizon and year

    bool operator==(const Settings&) const = default;
};

/// A camera and a moment, by a name.
struct SavedView {
    std::string name;
    geo::Geodetic eye;  ///< height as the DEM has it
    double heading_deg = 0, pitch_deg = 0;
    double fov_y_rad = 0;
    sun::Instant utc;
};

/// A DEM that was opened: the files that it is made of, and how they are read.
struct RecentDem {
    std::vector<std::string> files;
    dem::LoadOptions options;
    dem::Holes holes = dem::Holes::Fill;
};

/// The files in which that is kept.
class Memory {
  public:
    /// Where the desktop wants them: $XDG_CONFIG_HOME/relevo (~/.config/relevo), and
    /// $XDG_STATE_HOME/relevo (~/.local/state/relevo) for what was opened last. Where there is no
    /// home either, nothing is remembered.
    static Memory of_user();
    /// @param config, state  folders, which need not be there; empty: nothing is remembered
    Memory(std::filesystem::path config, std::filesystem::path state);

    Settings settings() const;
    /// @throws Error (BadInput, Failed) as OutputFile; here and below
    void write(const Settings& settings) const;

    /// DEMs that were opened, the last one first.
    std::vector<RecentDem> recent() const;
    /// Puts a DEM before the others, of which some are kept; one of the same files goes.
    void add_recent(const RecentDem& dem) const;

    /// Of a DEM.
    std::vector<SavedView> views(const std::vector<std::string>& dems) const;
    void write_views(const std::vector<std::string>& dems,
                     const std::vector<SavedView>& views) const;

  private:
    std::filesystem::path views_file(const std::vector<std::string>& dems) const;

    std::filesystem::path config_, state_;
};

/// The same names from the root of the file system, so that they mean the same from every folder;
/// what is no file, such as "/vsizip/a.zip/a.tif", stays.
std::vector<std::string> absolute_names(std::vector<std::string> dems);

/// The files of a folder whose names end as those of DEMs do, in order, without their folder.
std::vector<std::string> dems_in(const std::filesystem::path& folder);

/// The DEM before or after one in its folder, by name, at the end the first; none where there is no
/// other.
/// @param by  1 or -1
std::string neighbour_in_folder(const std::string& dem, int by);

}  // namespace relevo::viewer
