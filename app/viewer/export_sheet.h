#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <glm/vec2.hpp>

#include "viewer/command.h"
#include "viewer/export_choice.h"

namespace relevo::viewer {

/// What the export sheet shows of the window.
struct ExportView {
    const scene::Scene& scene;  ///< as it is now, with the view of the picture
    sun::Instant utc;           ///< its time, for the name
    const sun::Zone& zone;
    /// Of a file that is being written: the share that is done; none: unknown, or no file is.
    std::optional<double> done{};
    std::function<void()> cancel{};  ///< ends it; empty: cannot
    bool is_busy = false;            ///< a file is being written
    bool has_figures = false;        ///< a sun overlay is shown, which can be written
    const std::string& message;      ///< how the last export ended
    double map_aspect = 1;           ///< of the DEM
    unsigned texture = 0;            ///< the displayed image; rows from the bottom
    /// Where that has an image position (-1 to 1) of the exported picture, from 0 to 1.
    std::function<std::optional<glm::vec2>(glm::dvec2)> shown_at;
};

/// Asks what is exported and where to: for which use, kind, size, format, stamps, folder, name.
class ExportSheet {
  public:
    void open() { is_open_ = takes_focus_ = true; }
    void close() { is_open_ = false; }
    bool is_open() const { return is_open_; }
    bool has_focus() const { return is_open_ && has_focus_; }
    /// Takes the stamps of another scene.
    void take_scene(const scene::Scene& scene) { stamps_ = scene.stamps; }

    void draw(glm::vec2 window_px, ExportChoice& choice, const ExportView& view);
    /// What was ordered since the last call.
    std::optional<ExportOrder> take() { return std::exchange(order_, std::nullopt); }
    /// The film panel, if the user wants that instead.
    std::optional<Command> take_command() { return std::exchange(command_, std::nullopt); }

  private:
    void use_field(ExportChoice& choice, glm::vec2 window_px);
    /// A map sheet has all stamps until the user takes some away.
    void set_kind(ExportChoice& choice, int index);
    void kind_field(ExportChoice& choice);
    void fields(ExportChoice& choice, const ExportView& view, glm::vec2 window_px);
    void stamp_fields(const ExportKind& kind);
    void preview(const ExportChoice& choice, const ExportView& view) const;
    void file_fields(ExportChoice& choice);
    void result(const ExportChoice& choice, const ExportView& view);
    void buttons(const ExportOrder& wanted, bool is_taken, const ExportView& view);
    /// Asks what becomes of the file that has the name of `wanted`.
    void question(const ExportOrder& wanted);

    bool is_open_ = false, takes_focus_ = false;
    bool has_focus_ = false, has_popup_ = false;  // in the frame before
    bool is_entered_ = false;                     // Return was pressed
    scene::Stamps stamps_;
    std::string asks_;  // the path whose file may be replaced; empty: none
    std::optional<ExportOrder> order_;
    std::optional<Command> command_;
};

}  // namespace relevo::viewer
