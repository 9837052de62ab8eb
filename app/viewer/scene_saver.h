#pragma once

#include <memory>
#include <string>

#include "viewer/export_sheet.h"
#include "viewer/file_export.h"
#include "viewer/parts.h"

namespace relevo::viewer {

/// What the user takes along: pictures, scenes, jobs and commands of what the window shows.
class SceneSaver {
  public:
    /// @param device  as session::Options, for exported pictures
    SceneSaver(const Parts& parts, std::string device)
        : parts_(parts), device_(std::move(device)) {}

    /// The scene as it is shown, for files and commands.
    scene::Scene whole_scene() const;
    /// The scene of a document for a picture.
    /// @param is_centred  on what the panels leave free
    scene::Scene scene_for(Document document, bool is_centred, double aspect) const;

    /// The camera of such a picture.
    Pose pose_for(const Document& document, bool is_centred, double aspect) const;

    void copy_command();
    void save_scene();
    void save_job();
    /// Saves the displayed image; until it is complete, waits for poll().
    void take_picture() { takes_picture_ = true; }
    bool awaits_image() const { return takes_picture_; }

    ExportSheet& sheet() { return sheet_; }
    void draw_sheet();
    bool is_exporting() const { return export_ != nullptr; }
    /// "drawing the picture, 34 %"; empty: none is drawn
    std::string progress() const;
    /// Waits for a picture that is being exported.
    void finish() { export_.reset(); }
    /// Saves the image that was asked for once it is complete; starts what the sheet orders, and
    /// reports what is done.
    /// @param image  the displayed one if it is complete, else null
    void poll(const std::shared_ptr<const Picture>& image);

  private:
    /// A message of what was saved, with a note if the overlay is not part of it.
    std::string with_overlay_note(const std::string& text) const;
    void save_image(const Picture& image);
    void start_export();

    Parts parts_;
    std::string device_;
    ExportSheet sheet_;
    std::unique_ptr<FileExport> export_;
    bool takes_picture_ = false, had_sheet_ = false;
};

}  // namespace relevo::viewer
