#include "chart/cairo_painter.h"

#include "base/units.h"

namespace relevo::chart {
namespace {

class Painter {
  public:
    explicit Painter(cairo_t* cairo) : cairo_(cairo) {}

    void operator()(const Drawing::Path& path) {
        cairo_new_path(cairo_);
        for (const glm::dvec2& p : path.points)
            cairo_line_to(cairo_, p.x, p.y);
        if (path.closed) cairo_close_path(cairo_);
        draw(path.pen);
    }
    void operator()(const Drawing::Circle& circle) {
        cairo_new_path(cairo_);
        cairo_arc(cairo_, circle.center.x, circle.center.y, circle.radius, 0, 2 * kPi);
        cairo_close_path(cairo_);
        draw(circle.pen);
    }
    void operator()(const Drawing::Text& text) {
        const Lettering& l = text.lettering;
        cairo_save(cairo_);
        cairo_translate(cairo_, text.at.x, text.at.y);
        cairo_rotate(cairo_, radians(l.turn_deg));
        cairo_select_font_face(cairo_, "Liberation Sans",
                               l.italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                               l.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(cairo_, l.size);
        cairo_text_extents_t extents;
        cairo_text_extents(cairo_, text.words.c_str(), &extents);
        const double share = l.anchor == Anchor::Start ? 0 : l.anchor == Anchor::Middle ? 0.5 : 1;
        cairo_move_to(cairo_, -share * extents.x_advance, 0);
        if (l.halo) {
            cairo_text_path(cairo_, text.words.c_str());
            color(*l.halo);
            cairo_set_line_width(cairo_, l.size * 0.3);
            cairo_stroke(cairo_);
            cairo_move_to(cairo_, -share * extents.x_advance, 0);
        }
        color(l.color);
        cairo_show_text(cairo_, text.words.c_str());
        cairo_restore(cairo_);
    }
    void operator()(const Drawing::BeginClip& clip) {
        cairo_save(cairo_);
        cairo_new_path(cairo_);
        if (clip.rect)
            cairo_rectangle(cairo_, clip.rect->x, clip.rect->y, clip.rect->width,
                            clip.rect->height);
        else
            cairo_arc(cairo_, clip.center.x, clip.center.y, clip.radius, 0, 2 * kPi);
        cairo_clip(cairo_);
    }
    void operator()(const Drawing::EndClip&) { cairo_restore(cairo_); }

  private:
    void color(const Color& c) {
        cairo_set_source_rgba(cairo_, (c.rgb >> 16 & 255) / 255.0, (c.rgb >> 8 & 255) / 255.0,
                              (c.rgb & 255) / 255.0, c.opacity);
    }
    void draw(const Pen& pen) {
        cairo_set_antialias(cairo_, pen.crisp ? CAIRO_ANTIALIAS_NONE : CAIRO_ANTIALIAS_GOOD);
        if (pen.fill) {
            color(*pen.fill);
            cairo_fill_preserve(cairo_);
        }
        if (pen.stroke) {
            color(*pen.stroke);
            cairo_set_line_width(cairo_, pen.width);
            cairo_set_dash(cairo_, pen.dash.data(), static_cast<int>(pen.dash.size()), 0);
            cairo_stroke_preserve(cairo_);
        }
        cairo_new_path(cairo_);
    }

    cairo_t* cairo_;
};

}  // namespace

void draw_items(const Drawing& drawing, cairo_t* cairo) {
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    for (const Drawing::Item& item : drawing.items())
        std::visit(Painter(cairo), item);
}

}  // namespace relevo::chart
