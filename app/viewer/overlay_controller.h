#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/discard.h"
#include "viewer/export.h"
#include "viewer/messages.h"
#include "viewer/state.h"
#include "viewer/sun_overlay.h"

namespace relevo::viewer {

/// Keeps State::overlay the raster that the document asks for, and exports it.
class OverlayController {
  public:
    /// @param state, messages, discard  outlive this
    OverlayController(State& state, Messages& messages, Discard& discard);

    /// Removes the overlay before another DEM is opened. A running export continues.
    void clear();
    /// Requests the overlay that the document asks for and takes new results.
    /// @returns whether anything changed that panels show
    bool update(const Opened& opened);
    /// While a film's frame is shown: with the overlay if a file has it, else without any. What
    /// is requested stays.
    void show_frame();
    /// What lies on the ground; nullopt: the scene's own overlay, until there is an answer.
    std::optional<session::LaidOverlay> laid() const;
    /// Whether State::overlay is what the document asks for, from all posts.
    bool is_complete() const;

    /// Writes the overlay to a file, as soon as it is complete if the whole DEM is in memory.
    /// @param path  empty: a free name in the working folder
    void start_export(const std::string& path = {}, bool overwrite = false);
    void cancel_export();
    /// Reports a finished export. @returns whether there was one
    bool poll_export();

    /// Adds the overlay to a scene for export if a file has it.
    void add_to(scene::Scene& scene) const;
    /// The part of a message that reports an exported scene without its overlay; else empty.
    std::string missing_note() const;
    /// The legends of an image with the overlay on it.
    Coloured coloured(const Picture& image) const;

  private:
    struct ExportedOverlay {
        OverlayWanted of;
        std::string file;        ///< absolute
        std::string shown_name;  ///< for panels
    };

    bool waits_for_posts() const;
    /// Whether the document asks for an overlay that can be computed now.
    bool is_wanted() const;
    bool is_displayed() const;
    OverlayWanted wanted(const Opened& opened) const;
    bool request(const Opened& opened);
    /// Copies opacity, light and shadows of the choice.
    void copy_choice_to(scene::Overlay& overlay) const;
    /// Null: there is no file of the requested overlay.
    const ExportedOverlay* exported() const;

    State& state_;
    Messages& messages_;
    Discard& discard_;
    OverlayWork work_;
    std::optional<OverlayWanted> requested_;
    bool lays_overlay_ = false;
    std::unique_ptr<OverlaySave> export_;
    bool exports_when_complete_ = false, overwrites_ = false;
    std::string path_;        // of the export
    bool is_hidden_ = false;  // in a film's frame
    bool shows_frame_ = false;
    std::vector<ExportedOverlay> exported_;
};

}  // namespace relevo::viewer
