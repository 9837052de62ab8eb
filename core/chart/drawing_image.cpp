#include <algorithm>
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

/// A rectangle of pixels that Cairo draws on.
class Canvas {
  public:
    Canvas(int width, int height, cairo_format_t format = CAIRO_FORMAT_RGB24)
        : surface_(cairo_image_surface_create(format, width, height)) {}

    std::uint8_t* row(int y) {
        unsigned char* const data = cairo_image_surface_get_data(surface_.get());
        return data ? data + y * cairo_image_surface_get_stride(surface_.get()) : nullptr;
    }

    void draw(const Drawing& drawing, double scale) {
        cairo_surface_mark_dirty(surface_.get());
        const std::unique_ptr<cairo_t, Destroy> cairo(cairo_create(surface_.get()));
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
        cairo_surface_flush(surface_.get());
        if (cairo_status(cairo.get()) != CAIRO_STATUS_SUCCESS) refuse(cairo_status(cairo.get()));
    }

    void check() const {
        if (cairo_surface_status(surface_.get()) != CAIRO_STATUS_SUCCESS)
            refuse(cairo_surface_status(surface_.get()));
    }

  private:
    [[noreturn]] void refuse(cairo_status_t status) const {
        failed(fmt::format(
            "chart: {} x {} pixels: {}", cairo_image_surface_get_width(surface_.get()),
            cairo_image_surface_get_height(surface_.get()), cairo_status_to_string(status)));
    }

    std::unique_ptr<cairo_surface_t, Destroy> surface_;
};

}  // namespace

image::Image8 to_image(const Drawing& drawing, double scale) {
    image::Image8 image(static_cast<int>(std::lround(drawing.width() * scale)),
                        static_cast<int>(std::lround(drawing.height() * scale)), 3);
    std::ranges::fill(image.values, std::uint8_t{255});
    paint(drawing, 0, 0, scale, image);
    return image;
}

image::Image8 to_transparent_image(const Drawing& drawing, double scale) {
    image::Image8 image(static_cast<int>(std::lround(drawing.width() * scale)),
                        static_cast<int>(std::lround(drawing.height() * scale)), 4);
    if (image.values.empty()) return image;
    Canvas canvas(image.width, image.height, CAIRO_FORMAT_ARGB32);
    canvas.check();
    canvas.draw(drawing, scale);
    for (int row = 0; row < image.height; ++row) {
        std::uint8_t* to = image.row(row);
        const std::uint8_t* const from = canvas.row(row);
        for (int column = 0; column < image.width; ++column, to += 4) {
            std::uint32_t pixel;  // premultiplied
            std::memcpy(&pixel, from + 4 * column, 4);
            const std::uint32_t alpha = pixel >> 24;
            if (alpha == 0) continue;
            for (int channel = 0; channel < 3; ++channel)
                to[channel] = static_cast<std::uint8_t>(
                    ((pixel >> (16 - 8 * channel) & 255) * 255 + alpha / 2) / alpha);
            to[3] = static_cast<std::uint8_t>(alpha);
        }
    }
    return image;
}

void paint(const Drawing& drawing, int x, int y, double scale, image::Image8& picture) {
    const int left = std::max(x, 0), top = std::max(y, 0);
    const int width =
        std::min(picture.width, x + static_cast<int>(std::lround(drawing.width() * scale))) - left;
    const int height =
        std::min(picture.height, y + static_cast<int>(std::lround(drawing.height() * scale))) - top;
    if (width <= 0 || height <= 0) return;
    Canvas canvas(width, height);
    canvas.check();
    for (int row = 0; row < height; ++row) {
        const std::uint8_t* from = picture.row(top + row) + 3 * left;
        std::uint8_t* const to = canvas.row(row);
        for (int column = 0; column < width; ++column, from += 3) {
            const std::uint32_t pixel =
                std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
            std::memcpy(to + 4 * column, &pixel, 4);
        }
    }
    canvas.draw(drawing, scale);
    for (int row = 0; row < height; ++row) {
        std::uint8_t* to = picture.row(top + row) + 3 * left;
        const std::uint8_t* const from = canvas.row(row);
        for (int column = 0; column < width; ++column) {
            std::uint32_t pixel;
            std::memcpy(&pixel, from + 4 * column, 4);
            *to++ = static_cast<std::uint8_t>(pixel >> 16);
            *to++ = static_cast<std::uint8_t>(pixel >> 8);
            *to++ = static_cast<std::uint8_t>(pixel);
        }
    }
}

}  // namespace relevo::chart
