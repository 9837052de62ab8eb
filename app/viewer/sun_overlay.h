#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "figure/run.h"
#include "session/overlay.h"
#include "session/session.h"
#include "viewer/document.h"
#include "viewer/latest_work.h"

/// Sun rasters as overlays, computed in the background.
namespace relevo::viewer {

/// A figure of the sun that the window shows.
struct OverlayFigure {
    const char* name;     ///< for tr()
    const char* title;    ///< in scenes and pictures
    const char* command;  ///< that writes it
    const char* band;     ///< of figure::Hours; empty: another figure
};
const OverlayFigure& overlay_figure(OverlayKind kind);

/// A figure of the sun with its time and air.
struct FigureWanted {
    OverlayKind kind = OverlayKind::Hours;
    sun::TimeSpan time{};  ///< a mask is of its beginning
    sun::Zone zone{};
    std::string refraction = "standard";

    std::unique_ptr<const figure::Figure> of(const dem::Posts& posts) const;
};

/// A requested overlay.
struct OverlayWanted {
    std::shared_ptr<const session::LoadedDem> dem;
    std::vector<std::string> dems;  ///< its files
    dem::LoadOptions options;       ///< options of reading them
    FigureWanted figure;
    std::optional<scene::Overlay> file;  ///< instead of `figure`
    double opacity = 1;
    bool lit = false;  ///< as scene::Overlay
};

/// The figure for the displayed time. Members that it does not depend on have their defaults. If a
/// range ends before it begins, only its first day counts.
/// @param utc, zone  as Document
FigureWanted figure_of(const OverlayChoice& choice, sun::Instant utc, const sun::Zone& zone,
                       const std::string& refraction);
/// "Sun hours, 21 Dec 2026".
std::string title_of(const FigureWanted& figure);
/// Whether both request the same values of the same DEM. Opacity and light may differ.
bool same_figures(const OverlayWanted& a, const OverlayWanted& b);

/// A displayed overlay.
struct OverlayShown {
    OverlayWanted of;
    session::Overlay overlay;                      ///< without colours if there is an error
    std::shared_ptr<const figure::Raster> raster;  ///< null: of a file
    output::RasterBand band;                       ///< of the raster
    std::optional<dem::Grid> grid;                 ///< of the raster's values
    double every = 1;                              ///< posts between values
    std::string error;                             ///< why there is no overlay

    /// Whether every post of the DEM has a value.
    bool is_whole() const { return raster && every == 1; }
    /// The value of the nearest post; NaN in voids, outside the DEM, and for overlays of files.
    double value_at(const geo::Geodetic& place) const;
};

/// Computes overlays on a thread of its own: first from some posts, then from all that are in
/// memory. Cancels the computation for an older request. A stale answer stays until there is a new
/// one for the same DEM.
class OverlayWork : public LatestWork<OverlayWanted, OverlayShown> {
  public:
    /// @param on_change  called on that thread after each answer
    explicit OverlayWork(std::function<void()> on_change);
    /// Waits some milliseconds until the computation is cancelled.
    ~OverlayWork() override;

    /// From 0 to 1.
    double progress() const { return progress_; }

  private:
    class Levels;
    void work_out(const OverlayWanted* wanted) override;
    void publish(OverlayShown shown, bool done);
    bool is_final() const;
    void measure(const OverlayWanted& now);
    void tell(double share);

    std::atomic<double> progress_ = 0;
    // The thread's own.
    std::unique_ptr<Levels> levels_;
    std::shared_ptr<const OverlayShown> last_;
    std::chrono::steady_clock::time_point reported_at_;
};

/// Writes the raster of all posts, as `relevo sun` does.
class OverlaySave {
  public:
    /// @param whole      the raster of all posts; null: it is computed in parts
    /// @param on_change  called on its thread, also at the end
    /// @param path       empty: a free name in the working folder
    OverlaySave(OverlayWanted wanted, std::shared_ptr<const figure::Raster> whole,
                std::function<void()> on_change, std::string path = {}, bool overwrite = false);
    OverlaySave(const OverlaySave&) = delete;
    OverlaySave& operator=(const OverlaySave&) = delete;
    /// Cancels. Leaves no partial file.
    ~OverlaySave();

    const OverlayWanted& wanted() const { return wanted_; }
    bool is_done() const { return is_done_; }
    double progress() const { return progress_; }
    /// The file's name. Requires is_done(). @throws Error why there is no file
    std::string result() const;

  private:
    void run(const figure::Raster* whole);
    void tell(double share);

    OverlayWanted wanted_;
    std::function<void()> on_change_;
    const std::string path_;
    const bool overwrite_;
    std::atomic<bool> is_cancelled_ = false, is_done_ = false;
    std::atomic<double> progress_ = 0;
    std::string name_;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace relevo::viewer
