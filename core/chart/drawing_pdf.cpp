#include <cstring>
#include <memory>

#include <cairo-pdf.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "chart/cairo_painter.h"

namespace relevo::chart {
namespace {

constexpr double kPointsPerInch = 72, kMmPerInch = 25.4;

/// Cairo is C: an exception of the file waits until it has returned.
struct Sink {
    OutputFile& file;
    std::exception_ptr error;
};

cairo_status_t write_bytes(void* closure, const unsigned char* bytes, unsigned count) {
    Sink& sink = *static_cast<Sink*>(closure);
    try {
        sink.file.write(std::as_bytes(std::span(bytes, count)));
    } catch (...) {
        sink.error = std::current_exception();
        return CAIRO_STATUS_WRITE_ERROR;
    }
    return CAIRO_STATUS_SUCCESS;
}

void describe(const PaperSheet& sheet, cairo_surface_t* pdf) {
    const auto set = [&](cairo_pdf_metadata_t what, const std::string& text) {
        if (!text.empty()) cairo_pdf_surface_set_metadata(pdf, what, printable(text).c_str());
    };
    set(CAIRO_PDF_METADATA_TITLE, sheet.title);
    set(CAIRO_PDF_METADATA_AUTHOR, sheet.author);
    set(CAIRO_PDF_METADATA_CREATOR, sheet.creator);
    // Of itself Cairo writes when it wrote, by which equal sheets would differ.
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATE_DATE, "");
}

/// Draws a JPEG over a rectangle. Cairo copies the bytes of a JPEG into a PDF and looks at no pixel
/// of its surface, which therefore has one only: decoded, an A0 has 560 MB.
void draw_jpeg(std::vector<std::byte> jpeg, const Rect& at, cairo_t* cairo) {
    const std::unique_ptr<cairo_surface_t, CairoDestroy> surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
    auto kept = std::make_unique<std::vector<std::byte>>(std::move(jpeg));
    auto* const bytes = reinterpret_cast<const unsigned char*>(kept->data());
    const std::size_t count = kept->size();
    const cairo_status_t status = cairo_surface_set_mime_data(
        surface.get(), CAIRO_MIME_TYPE_JPEG, bytes, count,
        [](void* closure) { delete static_cast<std::vector<std::byte>*>(closure); }, kept.get());
    if (status == CAIRO_STATUS_SUCCESS) kept.release();
    cairo_save(cairo);
    cairo_translate(cairo, at.x, at.y);
    cairo_scale(cairo, at.width, at.height);
    cairo_set_source_surface(cairo, surface.get(), 0, 0);
    cairo_paint(cairo);
    cairo_restore(cairo);
}

}  // namespace

void write_pdf(const PaperSheet& sheet, std::vector<std::byte> jpeg, OutputFile& file) {
    const double point = kPointsPerInch / sheet.dpi;
    const glm::dvec2 size = kPointsPerInch / kMmPerInch * sheet.size_mm;
    Sink sink{file, nullptr};
    const std::unique_ptr<cairo_surface_t, CairoDestroy> pdf(
        cairo_pdf_surface_create_for_stream(write_bytes, &sink, size.x, size.y));
    describe(sheet, pdf.get());
    const std::unique_ptr<cairo_t, CairoDestroy> cairo(cairo_create(pdf.get()));
    cairo_scale(cairo.get(), point, point);
    const Rect& at = sheet.picture;
    const double line = sheet.line_px;
    Drawing frame(size.x / point, size.y / point);
    frame.rect({at.x - line, at.y - line, at.width + 2 * line, at.height + 2 * line},
               {.fill = Color{0x303030}});
    draw_items(frame, cairo.get());
    draw_jpeg(std::move(jpeg), at, cairo.get());
    for (const Placed& placed : sheet.drawings) {
        cairo_save(cairo.get());
        cairo_translate(cairo.get(), placed.corner_px.x, placed.corner_px.y);
        cairo_scale(cairo.get(), placed.scale, placed.scale);
        draw_items(placed.drawing, cairo.get());
        cairo_restore(cairo.get());
    }
    cairo_show_page(cairo.get());
    cairo_surface_finish(pdf.get());
    if (sink.error) std::rethrow_exception(sink.error);
    for (const cairo_status_t status : {cairo_status(cairo.get()), cairo_surface_status(pdf.get())})
        if (status != CAIRO_STATUS_SUCCESS)
            failed(fmt::format("{}: {}: {}", file.who(), printable(file.path().string()),
                               cairo_status_to_string(status)));
}

}  // namespace relevo::chart
