#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geo/geodetic.h"
#include "scene/scene.h"
#include "sun/time.h"
#include "viewer/export_choice.h"
#include "viewer/film_choice.h"

/// Settings and history of the viewer. Invalid files do not keep the window from opening: they
/// count as empty. Files are replaced as a whole.
namespace relevo::viewer {

enum class Coordinates { Utm, Mgrs, Degrees };

/// "47.41700 N 11.43708 E", "32N 683473 E 5255234 N", "32TPT8347355234".
std::string coordinates_text(const geo::Geodetic& place, Coordinates coordinates);

inline constexpr int kLeastText_px = 11, kUsualText_px = 16, kMostText_px = 32;

/// Appearance of the window.
struct Settings {
    bool light_style = false;
    int text_px = kUsualText_px;  ///< kLeastText_px to kMostText_px
    Coordinates coordinates = Coordinates::Utm;
    bool panels = true;     ///< shows all panels
    bool charts = true;     ///< the chosen point's horizon and year
    int panel_width = 360;  ///< of the side panel, in units of a layout for the usual text size
    int charts_height = 0;  ///< the same of the charts; 0: by the window
    ExportChoice exporting;
    FilmFile film;  ///< `exporting` has its folder

    bool operator==(const Settings&) const = default;
};

/// A named camera and time.
struct SavedView {
    std::string name;
    geo::Geodetic eye;  ///< height not exaggerated
    double heading_deg = 0, pitch_deg = 0;
    double fov_y_rad = 0;
    sun::Instant utc;
};

/// A DEM that was opened: its files, and options of reading them.
struct RecentDem {
    std::vector<std::string> files;
    dem::LoadOptions options;
    dem::Holes holes = dem::Holes::Fill;
};

/// The files of settings, history and saved views.
class Memory {
  public:
    /// Folders of the XDG base directory specification: $XDG_CONFIG_HOME/relevo (~/.config/relevo),
    /// and for history $XDG_STATE_HOME/relevo (~/.local/state/relevo). Without a home folder
    /// nothing is saved.
    static Memory of_user();
    /// @param config, state  folders, created when needed; empty: nothing is saved
    Memory(std::filesystem::path config, std::filesystem::path state);

    Settings settings() const;
    /// @throws Error (BadInput, Failed) as OutputFile; also the functions below
    void write(const Settings& settings) const;

    /// DEMs that were opened, most recent first.
    std::vector<RecentDem> recent() const;
    /// Adds a DEM in front, replacing one of the same files. The oldest are dropped.
    void add_recent(const RecentDem& dem) const;

    /// Saved views of a DEM.
    std::vector<SavedView> views(const std::vector<std::string>& dems) const;
    void write_views(const std::vector<std::string>& dems,
                     const std::vector<SavedView>& views) const;

  private:
    std::filesystem::path views_file(const std::vector<std::string>& dems) const;

    std::filesystem::path config_, state_;
};

/// Absolute file names. Names that are not files, such as "/vsizip/a.zip/a.tif", are kept.
std::vector<std::string> absolute_names(std::vector<std::string> dems);

/// "jacksboro.tif", "a.tif and 3 more".
std::string short_name(const std::vector<std::string>& dems);

/// Names of DEM files in a folder by their extensions, sorted, without the folder.
std::vector<std::string> dems_in(const std::filesystem::path& folder);

/// The DEM next to one in its folder by name, wrapping around; empty if there is no other.
/// @param by  1: next, -1: previous
std::string neighbour_in_folder(const std::string& dem, int by);

}  // namespace relevo::viewer
