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

#include "session/overlay.h"
#include "session/session.h"
#include "session/sun_raster.h"
#include "viewer/document.h"
#include "viewer/latest_work.h"

/// Figures of the sun that lie on the ground, worked out while one looks.
namespace relevo::viewer {

/// What is to lie on the ground.
struct OverlayWanted {
    std::shared_ptr<const session::LoadedDem> dem;
    std::vector<std::string> dems;  ///< its files
    dem::LoadOptions options;       ///< how they are read
    session::SunRasterWanted raster;
    std::optional<scene::Overlay> file;  ///< instead of `raster`
    std::string title;                   ///< of the legend
    double opacity = 1;
};

/// The figures of a choice for the shown moment.
/// @param utc, zone  as Document
session::SunRasterWanted raster_of(OverlayKind kind, sun::Instant utc, const sun::Zone& zone,
                                   const std::string& refraction);
/// "Sun hours, 21 Dec 2026".
std::string title_of(OverlayKind kind, const session::SunRasterWanted& raster);
/// Whether the figures are of one DEM and the same.
bool same_figures(const OverlayWanted& a, const OverlayWanted& b);

/// What lies on the ground.
struct OverlayShown {
    OverlayWanted of;
    session::Overlay overlay;                          ///< without colours where there is an error
    std::shared_ptr<const session::SunRaster> raster;  ///< null: of a file
    std::optional<dem::Grid> grid;                     ///< of the raster's values
    double every = 1;                                  ///< posts from one figure to the next
    std::string error;                                 ///< why there is none

    /// Whether each post of the DEM has its figure.
    bool is_whole() const { return raster && every == 1; }
    /// Of the nearest post that has one; NaN in holes, beyond the DEM, and of files.
    double value_at(const geo::Geodetic& place) const;
};

/// Works it out on a thread of its own: first for some posts, then for all, or for as many as the
/// window has in memory. What was begun for other figures is given up.
/// An answer stays until there are other figures of the same DEM.
class OverlayWork : public LatestWork<OverlayWanted, OverlayShown> {
  public:
    /// @param on_change  called on that thread whenever there is more to be had
    explicit OverlayWork(std::function<void()> on_change);
    /// Waits until the work in hand is given up, which takes some milliseconds.
    ~OverlayWork() override;

    /// How much of it has been done, 0 to 1.
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
    std::chrono::steady_clock::time_point told_at_;
};

/// Writes what `relevo sun` writes, of every post, into the working folder under a free name.
class OverlaySave {
  public:
    /// @param whole      the figures of all posts; null: they are worked out part by part
    /// @param on_change  called on its thread, also at the end
    OverlaySave(OverlayWanted wanted, std::shared_ptr<const session::SunRaster> whole,
                std::function<void()> on_change);
    OverlaySave(const OverlaySave&) = delete;
    OverlaySave& operator=(const OverlaySave&) = delete;
    /// Gives up; no part of the file is left.
    ~OverlaySave();

    const OverlayWanted& wanted() const { return wanted_; }
    bool is_done() const { return is_done_; }
    double progress() const { return progress_; }
    /// The file's name, once it is done. @throws Error why there is none
    std::string result() const;

  private:
    void run(const session::SunRaster* whole);
    void tell(double share);

    OverlayWanted wanted_;
    std::function<void()> on_change_;
    std::atomic<bool> gives_up_ = false, is_done_ = false;
    std::atomic<double> progress_ = 0;
    std::string name_;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace relevo::viewer
