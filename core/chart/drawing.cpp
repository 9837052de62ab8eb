#include "chart/drawing.h"

#include <array>
#include <cmath>

#include "base/text.h"

namespace relevo::chart {
namespace {

// Adobe's metrics of Helvetica and Helvetica-Bold, ASCII 32 to 126, in thousandths of the size.
constexpr std::array<int, 95> kRegular{
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
constexpr std::array<int, 95> kBold{
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 333, 333, 584, 584, 584, 611, 975, 722, 722, 722, 722, 667,
    611, 778, 722, 278, 556, 722, 611, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 333, 278, 333, 584, 556, 333, 556, 611, 556, 611, 556, 333, 611, 611, 278, 278, 556,
    278, 889, 611, 611, 611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389, 280, 389, 584};
constexpr int kOther = 556;  // accented letters; the degree sign is 400
// The ellipsis, and from U+3000 on what fills a square: Chinese, Japanese and Korean letters.
constexpr int kWhole = 1000;
constexpr std::string_view kEllipsis = "\u2026";

}  // namespace

Color mixed(const Color& a, const Color& b, double part) {
    std::uint32_t rgb = 0;
    for (unsigned shift : {0u, 8u, 16u}) {
        const double from = a.rgb >> shift & 255, to = b.rgb >> shift & 255;
        rgb |= static_cast<std::uint32_t>(std::lround(from + part * (to - from))) << shift;
    }
    return {rgb, a.opacity + part * (b.opacity - a.opacity)};
}

void Drawing::describe(const std::string& title, const std::string& description) {
    title_ = printable(title);
    description_ = printable(description);
}

// Items are made in place: of a variant's temporaries GCC 12 says at -O3 that they may not be
// whole.

void Drawing::path(std::vector<glm::dvec2> points, const Pen& pen, bool closed) {
    std::vector<glm::dvec2> piece;
    const auto flush = [&] {
        if (piece.size() >= 2)
            items_.emplace_back(std::in_place_type<Path>, Path{std::move(piece), closed, pen});
        piece.clear();
    };
    for (const glm::dvec2& p : points) {
        if (std::isfinite(p.x) && std::isfinite(p.y))
            piece.push_back(p);
        else
            flush();
    }
    flush();
}

void Drawing::line(const glm::dvec2& from, const glm::dvec2& to, const Pen& pen) {
    path({from, to}, pen);
}

void Drawing::rect(const Rect& r, const Pen& pen) {
    path({{r.x, r.y}, {r.x + r.width, r.y}, {r.x + r.width, r.y + r.height}, {r.x, r.y + r.height}},
         pen, true);
}

void Drawing::circle(const glm::dvec2& center, double radius, const Pen& pen) {
    items_.emplace_back(std::in_place_type<Circle>, Circle{center, radius, pen});
}

void Drawing::text(const glm::dvec2& at, const std::string& words, const Lettering& lettering) {
    items_.emplace_back(std::in_place_type<Text>, Text{at, printable(words), lettering});
}

void Drawing::clip(const Rect& rect) {
    items_.emplace_back(std::in_place_type<BeginClip>, BeginClip{rect, {}, 0});
}

void Drawing::clip_circle(const glm::dvec2& center, double radius) {
    items_.emplace_back(std::in_place_type<BeginClip>, BeginClip{std::nullopt, center, radius});
}

void Drawing::end_clip() {
    items_.emplace_back(std::in_place_type<EndClip>);
}

void Drawing::fill_opaquely() {
    for (Item& item : items_) {
        if (auto* const path = std::get_if<Path>(&item); path && path->pen.fill)
            path->pen.fill->opacity = 1;
        if (auto* const circle = std::get_if<Circle>(&item); circle && circle->pen.fill)
            circle->pen.fill->opacity = 1;
    }
}

double text_width(const std::string& words, double size, bool bold) {
    int sum = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto c = static_cast<unsigned char>(words[i]);
        if (c >= 32 && c < 127) {
            sum += (bold ? kBold : kRegular)[static_cast<std::size_t>(c - 32)];
        } else if (c >= 0xC0) {  // the first byte of a letter of several
            const bool degree = c == 0xC2 && i + 1 < words.size() && words[i + 1] == '\xB0';
            const bool whole = c >= 0xE3 || words.compare(i, kEllipsis.size(), kEllipsis) == 0;
            sum += degree ? 400 : whole ? kWhole : kOther;
        }
    }
    return sum * size / 1000;
}

std::string shortened(const std::string& words, double size, double width, bool bold) {
    if (text_width(words, size, bold) <= width) return words;
    const auto inside_a_letter = [&](std::size_t at) {
        return (static_cast<unsigned char>(words[at]) & 0xC0) == 0x80;
    };
    // The most letters that leave room for the ellipsis: widths grow from letter to letter.
    const double room = width - text_width(std::string(kEllipsis), size, bold);
    std::size_t fits = 0, too_long = words.size();
    while (too_long - fits > 1) {
        const std::size_t middle = (fits + too_long) / 2;
        (text_width(words.substr(0, middle), size, bold) <= room ? fits : too_long) = middle;
    }
    while (fits > 0 && inside_a_letter(fits))
        --fits;
    return std::string(trimmed(words.substr(0, fits))) + std::string(kEllipsis);
}

std::vector<std::string> wrapped(const std::string& words, double size, double width) {
    std::vector<std::string> lines(1);
    for (const std::string& word : split(words, ' ')) {
        const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
        if (lines.back().empty() || text_width(longer, size) <= width)
            lines.back() = longer;
        else
            lines.push_back(word);
    }
    return lines;
}

}  // namespace relevo::chart
