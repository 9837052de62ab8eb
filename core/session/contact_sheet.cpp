#include "session/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>

#include "base/error.h"
#include "base/text.h"
#include "chart/drawing.h"
#include "image/image.h"
#include "session/image_parts.h"
#include "session/shot_session.h"
#include "session/srgb16.h"
#include "session/stamps.h"

namespace relevo::session {
namespace {

constexpr chart::Color kInk{0x202020};

/// Of a channel of a pixel, over white paper.
float light_of(const image::Image8& image, int x, int y, int channel) {
    const float light = decoded(static_cast<std::uint16_t>(257 * image.at(x, y, channel)));
    if (image.channels < 4) return light;
    const float alpha = static_cast<float>(image.at(x, y, 3)) / 255;
    return alpha * light + 1 - alpha;
}

/// The means of the pixels below each pixel of a smaller size, in linear light.
image::Image8 scaled(const image::Image8& image, const glm::ivec2& size) {
    image::Image8 small(size.x, size.y, 3);
    const auto share = [](int at, int length, int of) {
        return static_cast<int>(std::int64_t{of} * at / length);
    };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const int left = share(x, size.x, image.width), top = share(y, size.y, image.height);
            const int right = std::max(share(x + 1, size.x, image.width), left + 1);
            const int bottom = std::max(share(y + 1, size.y, image.height), top + 1);
            for (int c = 0; c < 3; ++c) {
                float sum = 0;
                for (int j = top; j < bottom; ++j)
                    for (int i = left; i < right; ++i)
                        sum += light_of(image, i, j, c);
                const float mean = sum / static_cast<float>((right - left) * (bottom - top));
                small.row(y)[3 * x + c] =
                    static_cast<std::uint8_t>(std::lround(encoded(mean) / 257.0));
            }
        }
    return small;
}

/// The largest size of a picture's shape in a cell, and no larger than the picture.
glm::ivec2 size_within(const image::Image8& picture, const glm::ivec2& cell) {
    const double scale = std::min({1.0, static_cast<double>(cell.x) / picture.width,
                                   static_cast<double>(cell.y) / picture.height});
    return glm::max(
        glm::ivec2(std::lround(scale * picture.width), std::lround(scale * picture.height)),
        glm::ivec2(1));
}

void add_cell(const SheetLayout& layout, std::size_t number, const image::Image8& picture,
              const std::string& caption, image::Image8& sheet) {
    const glm::ivec2 corner = layout.corner_px(number), size = size_within(picture, layout.cell_px);
    put(scaled(picture, size), corner + (layout.cell_px - size) / 2, sheet);
    constexpr double kLetters_px = 13;
    chart::Drawing words(layout.cell_px.x, SheetLayout::kCaption_px);
    words.text({0.5 * layout.cell_px.x, 17},
               chart::shortened(caption, kLetters_px, layout.cell_px.x),
               {.size = kLetters_px, .color = kInk, .anchor = chart::Anchor::Middle});
    chart::paint(words, corner.x, corner.y + layout.cell_px.y, 1, sheet);
}

/// Draws a shot. @returns its picture
image::Image8 draw(ShotSession& sessions, const scene::Shot& shot, bool& shows_ground) {
    Session& session = sessions.of(shot);
    session.show(shot.scene, shot.utc);
    image::Picture picture = session.make_picture();
    shows_ground = session.shows_ground();
    return std::get<image::Image8>(std::move(picture.pixels));
}

}  // namespace

SheetLayout SheetLayout::of(std::size_t pictures, const glm::ivec2& picture_px, int columns) {
    SheetLayout layout;
    const int count = static_cast<int>(std::min<std::size_t>(pictures, 1 << 24));
    const double height = std::round(static_cast<double>(kCell_px) * picture_px.y / picture_px.x);
    layout.cell_px = {kCell_px, static_cast<int>(std::clamp(height, 1.0, double{kMostSide_px}))};
    const double shape = static_cast<double>(layout.cell_px.y + kCaption_px + kGap_px) /
                         (layout.cell_px.x + kGap_px);
    if (columns <= 0) columns = static_cast<int>(std::ceil(std::sqrt(count * shape)));
    layout.columns = std::clamp(columns, 1, count);
    layout.rows = (count + layout.columns - 1) / layout.columns;
    const double width_px = kGap_px + double{1} * layout.columns * (kCell_px + kGap_px);
    const double height_px =
        kGap_px + double{1} * layout.rows * (layout.cell_px.y + kCaption_px + kGap_px);
    if (std::max(width_px, height_px) > kMostSide_px || width_px * height_px > kMost_px)
        bad_input(fmt::format(
            "--contact-sheet: {} pictures in {} columns need {:.0f} x {:.0f} px, expected at most "
            "{} px a side and {:.0f} million in all; use other --columns or fewer pictures",
            pictures, layout.columns, width_px, height_px, kMostSide_px, kMost_px * 1e-6));
    return layout;
}

glm::ivec2 SheetLayout::size_px() const {
    return corner_px(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows - 1)) +
           glm::ivec2((columns) * (cell_px.x + kGap_px), cell_px.y + kCaption_px + kGap_px);
}

glm::ivec2 SheetLayout::corner_px(std::size_t picture) const {
    const auto of = static_cast<std::size_t>(columns);
    const glm::ivec2 at(static_cast<int>(picture % of), static_cast<int>(picture / of));
    return glm::ivec2(kGap_px) + at * (cell_px + glm::ivec2(kGap_px, kCaption_px + kGap_px));
}

std::vector<std::string> captions_of(const std::vector<scene::Shot>& shots) {
    std::set<sun::Instant> times;
    std::map<std::string, std::set<std::string>> values;
    for (const scene::Shot& shot : shots) {
        times.insert(shot.utc);
        for (const auto& [key, value] : shot.names)
            values[key].insert(value);
    }
    std::vector<std::string> captions;
    for (const scene::Shot& shot : shots) {
        std::vector<std::string> parts;
        for (const auto& [key, value] : shot.names)
            if (values[key].size() > 1)
                // Names say what they are; values of parameters do not.
                parts.push_back(
                    printable(key.find('.') == std::string::npos ? value : key + " " + value));
        if (times.size() > 1 || parts.empty())
            parts.insert(parts.begin(), clock_text(shot.utc, shot.zone));
        captions.push_back(fmt::format("{}", fmt::join(parts, ", ")));
    }
    return captions;
}

SheetReport draw_contact_sheet(const std::vector<scene::Shot>& shots, const SheetOptions& options,
                               SceneTimes& times, FilesInUse& files) {
    const scene::Scene& first = shots.front().scene;
    const SheetLayout layout =
        SheetLayout::of(shots.size(), {first.width_px, first.height_px}, options.columns);
    OutputFile file = files.open_alone(options.output, options.overwrite, "run");
    SheetReport report{.size_px = layout.size_px()};
    image::Image8 sheet(report.size_px.x, report.size_px.y, 3);
    std::ranges::fill(sheet.values, std::uint8_t{255});
    const std::vector<std::string> captions = captions_of(shots);
    ShotSession sessions({.device = options.device, .format = PictureFormat{}}, times, files);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        bool shows_ground = true;
        try {
            add_cell(layout, i, draw(sessions, shots[i], shows_ground), captions[i], sheet);
        } catch (...) {
            if (!sessions.was_opened()) throw;
            failed(
                fmt::format("{}: picture {} of {} ({}) cannot be drawn, so there is no sheet: {}",
                            printable(options.output.string()), i + 1, shots.size(), captions[i],
                            reason_of(std::current_exception())));
        }
        if (!shows_ground && report.blank++ == 0) report.first_blank = i + 1;
        options.drawn(i + 1);
    }
    if (report.blank == shots.size() && !options.allow_blank)
        failed(fmt::format("{}: the pictures show only sky; turn the camera or add --allow-blank",
                           printable(options.output.string())));
    image::write(file, image::Picture{std::move(sheet)}, options.metadata, options.encoding);
    file.finish();
    return report;
}

}  // namespace relevo::session
