#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session/trust.h"
#include "viewer/camera_moves.h"
#include "viewer/file_kind.h"
#include "viewer/film_controller.h"
#include "viewer/import_sheet.h"
#include "viewer/open_dialog.h"

namespace relevo::viewer {

/// Opens files that are dropped on the window or chosen, by their kinds, and asks how to read those
/// that need it.
class FileOpener {
  public:
    /// @param moves, film   outlive this
    /// @param first_wanted  what the thread of a scene begins with
    /// @param is_cached     as scene::Scene::dem.cached of all that are opened
    FileOpener(const Parts& parts, CameraMoves& moves, FilmController& film,
               std::function<Wanted()> first_wanted, bool is_cached)
        : parts_(parts),
          moves_(moves),
          film_(film),
          first_wanted_(std::move(first_wanted)),
          is_cached_(is_cached) {}

    /// The dialog of files.
    void ask_which();
    /// The sheet of how the DEM is read.
    void ask_how();
    /// The same after a DEM could not be opened, if options could help.
    void ask_after_failure();
    /// The next DEM of the folder, or the one before. @param step  1 or -1
    void open_neighbour(int step);
    /// What was dropped, chosen, or asked for by panels since the last call.
    void open_requested_files();

    bool is_asking() const { return sheet_.is_open(); }
    void draw(glm::vec2 window_px);
    void close();

  private:
    RecentDem opened_last() const;
    void open_files(const std::vector<std::string>& files);
    void open_dem(const RecentDem& dem);
    /// Opens what the sheet gives, as part of the scene that could not be opened.
    void open_imported(const RecentDem& dem);
    void open_scene(scene::Scene scene);

    // They throw Error (BadInput) for files that are wrong.
    void open_file(FileKind kind, const std::string& path);
    /// Opens a scene that a file names, without plugin folders and names on the net in it.
    void open_named_scene(scene::Scene scene, const std::string& path, session::NamedBy by);
    /// Switches on an effect that shows the places or lines of a file.
    void show_features(FileKind kind, const std::string& path);
    void lay_over(const std::string& path);
    /// Stands where a photograph was taken, at its time, with its lens.
    void stand_where_taken(const std::string& path);

    Parts parts_;
    CameraMoves& moves_;
    FilmController& film_;
    std::function<Wanted()> first_wanted_;
    const bool is_cached_;  // not --no-cache
    OpenDialog dialog_;
    ImportSheet sheet_;
    std::optional<scene::Scene> refused_;  // for whose DEM the sheet was opened
};

}  // namespace relevo::viewer
