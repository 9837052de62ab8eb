#include <cmath>
#include <cstring>
#include <memory>

#include <cairo.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "chart/drawing.h"

namespace relevo::chart {
namespace {

struct Destroy {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};

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

image::Image8 to_image(const Drawing& drawing, double scale) {
    const int width = static_cast<int>(std::lround(drawing.width() * scale));
    const int height = static_cast<int>(std::lround(drawing.height() * scale));
    const std::unique_ptr<cairo_surface_t, Destroy> surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
    const std::unique_ptr<cairo_t, Destroy> cairo(cairo_create(surface.get()));
    cairo_set_source_rgb(cairo.get(), 1, 1, 1);
    cairo_paint(cairo.get());
    cairo_scale(cairo.get(), scale, scale);
    cairo_set_line_join(cairo.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo.get(), CAIRO_LINE_CAP_ROUND);
    // Letters as they are drawn at any size, not pulled to the pixels of one.
    const std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> font(
        cairo_font_options_create(), cairo_font_options_destroy);
    cairo_font_options_set_antialias(font.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(font.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(font.get(), CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo.get(), font.get());
    for (const Drawing::Item& item : drawing.items())
        std::visit(Painter(cairo.get()), item);
    cairo_surface_flush(surface.get());
    if (cairo_status(cairo.get()) != CAIRO_STATUS_SUCCESS)
        failed(fmt::format("light::to_image: {} x {} pixels: {}", width, height,
                           cairo_status_to_string(cairo_status(cairo.get()))));

    image::Image8 image(width, height, 3);
    const unsigned char* data = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < height; ++y) {
        std::uint8_t* row = image.row(y);
        for (int x = 0; x < width; ++x) {
            std::uint32_t pixel;
            std::memcpy(&pixel, data + y * stride + 4 * x, 4);
            *row++ = static_cast<std::uint8_t>(pixel >> 16);
            *row++ = static_cast<std::uint8_t>(pixel >> 8);
            *row++ = static_cast<std::uint8_t>(pixel);
        }
    }
    return image;
}

}  // namespace relevo::chart
