#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "base/output_file.h"
#include "image/image.h"

namespace relevo::chart {

/// sRGB as people write it, 0xRRGGBB, with an opacity.
struct Color {
    std::uint32_t rgb = 0;
    double opacity = 1;

    bool operator==(const Color&) const = default;
};

/// Between two colours: `a` at part 0, `b` at part 1.
Color mixed(const Color& a, const Color& b, double part);

/// How an outline is drawn and filled.
struct Pen {
    std::optional<Color> fill = {};
    std::optional<Color> stroke = {};
    double width = 1;
    std::vector<double> dash = {};  ///< on, off, ...; empty: a whole line
    bool crisp = false;             ///< no antialiasing: cells that must join without seams
};

enum class Anchor { Start, Middle, End };

struct Lettering {
    double size = 12;
    Color color = {};
    Anchor anchor = Anchor::Start;
    bool bold = false;
    bool italic = false;
    double turn_deg = 0;  ///< clockwise, about the anchor
    std::optional<Color> halo =
        {};  ///< an outline behind the letters, so that lines do not spoil them
};

struct Rect {
    double x = 0, y = 0, width = 0, height = 0;

    bool operator==(const Rect&) const = default;
};

inline bool overlap(const Rect& a, const Rect& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
           b.y < a.y + a.height;
}

/// Of a diagram in a panel of a window: without title, keys and small print, and with letters as
/// large as otherwise.
struct PanelSize {
    double width = 0, height = 0;
};

/// A drawing of lines, areas and words, in units of a pixel, y downwards. What comes later lies on
/// top. Letters are Helvetica's widths everywhere: Liberation Sans, Arial and Nimbus Sans share
/// them. Words are as printable() leaves them: neither SVG nor Cairo takes control characters, or
/// bytes that are not UTF-8.
class Drawing {
  public:
    Drawing(double width, double height) : width_(width), height_(height) {}

    double width() const { return width_; }
    double height() const { return height_; }

    /// For readers that do not see: the SVG's title and description, and the PNG's metadata.
    void describe(const std::string& title, const std::string& description);

    /// Open lines, or areas where `closed`; not-a-number points part a line in two.
    void path(std::vector<glm::dvec2> points, const Pen& pen, bool closed = false);
    void line(const glm::dvec2& from, const glm::dvec2& to, const Pen& pen);
    void rect(const Rect& rect, const Pen& pen);
    void circle(const glm::dvec2& center, double radius, const Pen& pen);
    /// @param at  on the base line
    void text(const glm::dvec2& at, const std::string& words, const Lettering& lettering);

    /// Everything until end_clip() is cut to a rectangle or a circle.
    void clip(const Rect& rect);
    void clip_circle(const glm::dvec2& center, double radius);
    void end_clip();
    /// Makes fills of areas opaque: on white paper nothing has to show through panels.
    void fill_opaquely();

    struct Path {
        std::vector<glm::dvec2> points;
        bool closed;
        Pen pen;
    };
    struct Circle {
        glm::dvec2 center;
        double radius;
        Pen pen;
    };
    struct Text {
        glm::dvec2 at;
        std::string words;
        Lettering lettering;
    };
    struct BeginClip {
        std::optional<Rect> rect;  // else the circle
        glm::dvec2 center{0};
        double radius = 0;
    };
    struct EndClip {};
    using Item = std::variant<Path, Circle, Text, BeginClip, EndClip>;

    const std::vector<Item>& items() const { return items_; }
    const std::string& title() const { return title_; }
    const std::string& description() const { return description_; }

  private:
    double width_, height_;
    std::string title_, description_;
    std::vector<Item> items_;
};

/// Width of words in Helvetica [px]. Accuracy: 1 % of Liberation Sans as Cairo sets it
/// (tests/light/test_drawing.cpp). Source: Adobe's font metrics, Helvetica and Helvetica-Bold.
double text_width(const std::string& words, double size, bool bold = false);

/// Words that are wider than `width` without their end, which is an ellipsis then.
/// @param words  as printable() leaves them
std::string shortened(const std::string& words, double size, double width, bool bold = false);

/// Words broken into lines no wider than `width`.
std::vector<std::string> wrapped(const std::string& words, double size, double width);

/// As SVG 1.1: text remains text.
std::string to_svg(const Drawing& drawing);

/// As pixels on white, `scale` of them a unit. @throws Error (Failed) where memory does not do
image::Image8 to_image(const Drawing& drawing, double scale = 1);

/// The same on nothing: RGBA with straight alpha.
image::Image8 to_transparent_image(const Drawing& drawing, double scale = 1);

/// Puts a drawing on a picture, RGB, its corner on the pixel (x, y). @throws Error as to_image()
void paint(const Drawing& drawing, int x, int y, double scale, image::Image8& picture);

/// A drawing and its place in a picture.
struct Placed {
    Drawing drawing;
    glm::dvec2 corner_px{0};  ///< its upper left corner
    double scale = 1;         ///< pixels of a unit
};
/// The corner is rounded to whole pixels.
void paint(const Placed& placed, image::Image8& picture);

/// A sheet of paper with a picture on it, in pixels of that picture from the sheet's upper left
/// corner.
struct PaperSheet {
    glm::dvec2 size_mm{0};
    double dpi = 300;
    Rect picture;                    ///< where it lies
    double line_px = 0;              ///< width of a line around it
    std::vector<Placed> drawings{};  ///< upon it and around it
    std::vector<Rect> taken{};       ///< where panels and labels stand around it
    std::string title{}, author{}, creator{};
};

/// Writes a sheet as PDF 1.5, all of it but finish(): text as text, lines as lines. Sizes are
/// exact; there is no date in it.
/// @param jpeg  the picture; the PDF has these bytes, with the metadata in them
/// @throws Error (Failed) where memory or the disk refuses
void write_pdf(const PaperSheet& sheet, std::vector<std::byte> jpeg, OutputFile& file);

}  // namespace relevo::chart
