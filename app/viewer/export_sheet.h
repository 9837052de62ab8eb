#pragma once

#include <array>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "viewer/command.h"
#include "viewer/picture_export.h"

namespace relevo::viewer {

/// Asks what is exported: kind of picture, size, format, samples, transparency, stamps, name.
class ExportSheet {
  public:
    void open() { is_open_ = true; }
    void close() { is_open_ = false; }
    /// Takes the stamps and the kind of picture of another scene.
    void take_scene(const scene::Scene& scene);
    bool is_open() const { return is_open_; }
    /// What the sheet does to the view: centres the picture on what the panels leave free.
    bool is_centred() const { return is_centred_; }
    /// Width over height of the picture, of a stereo pair of each of its two.
    double aspect() const;

    /// @param scene    as it is now, with the view of the picture
    /// @param utc, zone  its time, for the name
    /// @param is_busy  a picture is being exported
    void draw(glm::vec2 window_px, const scene::Scene& scene, sun::Instant utc,
              const sun::Zone& zone, bool is_busy);
    /// What was ordered since the last call.
    std::optional<PictureOrder> take() { return std::exchange(order_, std::nullopt); }

    /// The film panel, or the export of the overlay, if the user wants that instead.
    std::optional<Command> take_command() { return std::exchange(command_, std::nullopt); }

  private:
    void kind_field();
    void size_fields(glm::vec2 window_px);
    void format_fields();
    bool can_be_transparent() const;
    void stamp_fields(const scene::Scene& scene);
    /// @throws Error (BadInput) for names and formats that cannot be
    PictureOrder order(const scene::Scene& scene, sun::Instant utc, const sun::Zone& zone) const;
    void result(const scene::Scene& scene, sun::Instant utc, const sun::Zone& zone, bool is_busy);

    bool is_open_ = false, is_centred_ = true, is_transparent_ = false;
    glm::ivec2 size_px_{1920, 1080};
    int format_ = 0, samples_ = 4, quality_ = image::kQuality;
    std::optional<scene::Stamps> stamps_;  // nullopt: the scene's
    std::size_t what_ = 0;                 // index of a kind of picture
    std::string name_ = "{dem}_{time:%Y%m%dT%H%M}";
    std::optional<PictureOrder> order_;
    std::optional<Command> command_;
};

}  // namespace relevo::viewer
