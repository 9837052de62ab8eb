#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "chart/drawing.h"

// Cairo's SVG surface would do without this file. It writes letters as outlines, without a title
// and without a description, and a dozen times the bytes: docs/performance.md.
namespace relevo::chart {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

/// Hundredths of a pixel, without needless zeros.
std::string number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    while (text.back() == '0')
        text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string paint(const char* what, const std::optional<Color>& color) {
    if (!color) return std::string(what) == "fill" ? " fill=\"none\"" : "";
    std::string text = fmt::format(" {}=\"#{:06x}\"", what, color->rgb);
    if (color->opacity < 1) text += fmt::format(" {}-opacity=\"{}\"", what, number(color->opacity));
    return text;
}

std::string attributes(const Pen& pen) {
    std::string text = paint("fill", pen.fill) + paint("stroke", pen.stroke);
    if (pen.stroke && pen.width != 1)
        text += fmt::format(" stroke-width=\"{}\"", number(pen.width));
    if (pen.stroke && !pen.dash.empty()) {
        std::string dash;
        for (const double d : pen.dash)
            dash += (dash.empty() ? "" : " ") + number(d);
        text += fmt::format(" stroke-dasharray=\"{}\"", dash);
    }
    if (pen.crisp) text += " shape-rendering=\"crispEdges\"";
    return text;
}

/// Points of a line without those that leave it within a tolerance (U. Ramer, Computer Graphics and
/// Image Processing 1 (1972), 244; D. Douglas and T. Peucker, Cartographica 10 (1973), 112).
std::vector<glm::dvec2> simplified(const std::vector<glm::dvec2>& points, double tolerance) {
    std::vector<bool> kept(points.size());
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> stretches{{0, points.size() - 1}};
    while (!stretches.empty()) {
        const auto [from, to] = stretches.back();
        stretches.pop_back();
        const glm::dvec2 way = points[to] - points[from];
        const double length2 = glm::dot(way, way);
        double farthest = tolerance;
        std::size_t at = from;
        for (std::size_t i = from + 1; i < to; ++i) {
            const glm::dvec2 off = points[i] - points[from];
            const double t = length2 > 0 ? std::clamp(glm::dot(off, way) / length2, 0.0, 1.0) : 0;
            const double distance = glm::length(off - t * way);
            if (distance > farthest) {
                farthest = distance;
                at = i;
            }
        }
        if (at == from) continue;
        kept[at] = true;
        stretches.emplace_back(from, at);
        stretches.emplace_back(at, to);
    }
    std::vector<glm::dvec2> result;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (kept[i]) result.push_back(points[i]);
    return result;
}

constexpr double kTolerance = 0.05;  // of a pixel; nobody sees it, and files are a third as large

struct Writer {
    std::string out, clips;
    int clip_count = 0;

    void operator()(const Drawing::Path& path) {
        // Relative moves in hundredths that do not drift: each is from where the last one ended.
        std::string d;
        long x = 0, y = 0;
        const std::vector<glm::dvec2> points = simplified(path.points, kTolerance);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const long to_x = std::lround(points[i].x * 100);
            const long to_y = std::lround(points[i].y * 100);
            if (i > 0 && to_x == x && to_y == y) continue;
            const std::string dx = number((to_x - x) / 100.0), dy = number((to_y - y) / 100.0);
            d += i == 0 ? "M" : i == 1 ? "l" : dx[0] == '-' ? "" : " ";
            d += dx + (dy[0] == '-' ? "" : " ") + dy;
            x = to_x;
            y = to_y;
        }
        out +=
            fmt::format("<path d=\"{}{}\"{}/>\n", d, path.closed ? "z" : "", attributes(path.pen));
    }
    void operator()(const Drawing::Circle& c) {
        out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(c.center.x),
                           number(c.center.y), number(c.radius), attributes(c.pen));
    }
    void operator()(const Drawing::Text& text) {
        const Lettering& l = text.lettering;
        std::string extra;
        if (l.anchor != Anchor::Start)
            extra += fmt::format(" text-anchor=\"{}\"", l.anchor == Anchor::End ? "end" : "middle");
        if (l.bold) extra += " font-weight=\"bold\"";
        if (l.italic) extra += " font-style=\"italic\"";
        if (l.turn_deg != 0)
            extra += fmt::format(" transform=\"rotate({} {} {})\"", number(l.turn_deg),
                                 number(text.at.x), number(text.at.y));
        if (l.halo)
            extra += paint("stroke", l.halo) + fmt::format(
                                                   " stroke-width=\"{}\" stroke-linejoin=\"round\" "
                                                   "paint-order=\"stroke\"",
                                                   number(l.size * 0.3));
        out += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\"{}{}>{}</text>\n",
                           number(text.at.x), number(text.at.y), number(l.size),
                           paint("fill", l.color), extra, escaped(text.words));
    }
    void operator()(const Drawing::BeginClip& clip) {
        const int id = ++clip_count;
        const std::string shape =
            clip.rect ? fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                                    number(clip.rect->x), number(clip.rect->y),
                                    number(clip.rect->width), number(clip.rect->height))
                      : fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>", number(clip.center.x),
                                    number(clip.center.y), number(clip.radius));
        clips += fmt::format("<clipPath id=\"clip{}\">{}</clipPath>\n", id, shape);
        out += fmt::format("<g clip-path=\"url(#clip{})\">\n", id);
    }
    void operator()(const Drawing::EndClip&) { out += "</g>\n"; }
};

}  // namespace

std::string to_svg(const Drawing& drawing) {
    Writer writer;
    for (const Drawing::Item& item : drawing.items())
        std::visit(writer, item);
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
        "viewBox=\"0 0 {0} {1}\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{2}</title>\n"
        "<desc>{3}</desc>\n{4}<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{5}</svg>\n",
        number(drawing.width()), number(drawing.height()), escaped(drawing.title()),
        escaped(drawing.description()),
        writer.clips.empty() ? "" : "<defs>\n" + writer.clips + "</defs>\n", writer.out);
}

}  // namespace relevo::chart
