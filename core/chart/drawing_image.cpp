#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <cairo.h>
#include <fmt/format.h>

#include "base/error.h"
#include "chart/cairo_painter.h"

namespace relevo::chart {
namespace {

/// A rectangle of pixels that Cairo draws on.
class Canvas {
  public:
    Canvas(int width, int height, cairo_format_t format = CAIRO_FORMAT_RGB24)
        : surface_(cairo_image_surface_create(format, width, height)) {}

    std::uint8_t* row(int y) {
        unsigned char* const data = cairo_image_surface_get_data(surface_.get());
        return data ? data + y * cairo_image_surface_get_stride(surface_.get()) : nullptr;
    }

    /// @param at  of the drawing's corner [px]
    void draw(const Drawing& drawing, double scale, const glm::ivec2& at = glm::ivec2(0)) {
        cairo_surface_mark_dirty(surface_.get());
        const std::unique_ptr<cairo_t, CairoDestroy> cairo(cairo_create(surface_.get()));
        cairo_translate(cairo.get(), at.x, at.y);
        cairo_scale(cairo.get(), scale, scale);
        // Letters as they are drawn at any size, not pulled to the pixels of one.
        const std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> font(
            cairo_font_options_create(), cairo_font_options_destroy);
        cairo_font_options_set_antialias(font.get(), CAIRO_ANTIALIAS_GRAY);
        cairo_font_options_set_hint_style(font.get(), CAIRO_HINT_STYLE_NONE);
        cairo_font_options_set_hint_metrics(font.get(), CAIRO_HINT_METRICS_OFF);
        cairo_set_font_options(cairo.get(), font.get());
        draw_items(drawing, cairo.get());
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

    std::unique_ptr<cairo_surface_t, CairoDestroy> surface_;
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

namespace {

/// Paints what lies in a rectangle of a picture. @param at  of the drawing's corner in there
void paint_part(const Drawing& drawing, const glm::ivec2& at, double scale, int left, int top,
                int width, int height, image::Image8& picture) {
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
    canvas.draw(drawing, scale, at);
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

}  // namespace

void paint(const Drawing& drawing, int x, int y, double scale, image::Image8& picture) {
    constexpr int kMost_px = 1 << 24;  // of a canvas
    const int left = std::max(x, 0), top = std::max(y, 0);
    const int right =
        std::min(picture.width, x + static_cast<int>(std::lround(drawing.width() * scale)));
    const int bottom =
        std::min(picture.height, y + static_cast<int>(std::lround(drawing.height() * scale)));
    if (left >= right) return;
    const int rows = std::max(kMost_px / (right - left), 1);
    for (int row = top; row < bottom; row += rows)
        paint_part(drawing, {0, top - row}, scale, left, row, right - left,
                   std::min(rows, bottom - row), picture);
}

void paint(const Placed& placed, image::Image8& picture) {
    paint(placed.drawing, static_cast<int>(std::lround(placed.corner_px.x)),
          static_cast<int>(std::lround(placed.corner_px.y)), placed.scale, picture);
}

}  // namespace relevo::chart
