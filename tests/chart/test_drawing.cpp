#include <cmath>
#include <memory>

#include <cairo.h>
#include <glm/geometric.hpp>

#include "chart/drawing.h"
#include "support/support.h"

namespace relevo::chart {
namespace {

std::array<int, 3> pixel(const image::Image8& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

TEST(Drawing, WidthsOfWordsAreThoseCairoSetsThemIn) {
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 8, 8);
    cairo_t* cairo = cairo_create(surface);
    cairo_font_options_t* font = cairo_font_options_create();
    cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo, font);
    std::vector<double> errors;
    for (const bool bold : {false, true})
        for (const char* words :
             {"Path of the sun, 21 June 2026", "47.26920 N 11.40410 E, 574 m", "civil dawn 04:38",
              "330°", "2334 m, 14.2 km", "(U.S. Naval Observatory)"}) {
            cairo_select_font_face(cairo, "Liberation Sans", CAIRO_FONT_SLANT_NORMAL,
                                   bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
            cairo_set_font_size(cairo, 13);
            cairo_text_extents_t extents;
            cairo_text_extents(cairo, words, &extents);
            errors.push_back(100 * std::abs(text_width(words, 13, bold) / extents.x_advance - 1));
            EXPECT_LT(errors.back(), 1) << words;
        }
    test::print_accuracy("widths of words", errors, "%", 1);
    cairo_font_options_destroy(font);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
}

TEST(Drawing, WordsAreWrappedWithinTheWidth) {
    const std::string words = "highest crossing with the rows and columns of the DEM";
    const std::vector<std::string> lines = wrapped(words, 10, 100);
    ASSERT_GT(lines.size(), 1U);
    std::string joined;
    for (const std::string& line : lines) {
        EXPECT_LE(text_width(line, 10), 100);
        joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, words);
    EXPECT_EQ(wrapped("incomprehensibilities", 10, 20).size(), 1U);  // nowhere to break
}

TEST(Drawing, WordsAreShortenedToTheWidth) {
    EXPECT_EQ(shortened("The valley", 21, 200, true), "The valley");
    for (const std::string letter : {"a", "W", "\u00e9", "\u5c71"}) {
        std::string name;
        for (int i = 0; i < 3000; ++i)
            name += letter;
        const std::string cut = shortened(name, 21, 400, true);
        EXPECT_LE(text_width(cut, 21, true), 400) << letter;
        EXPECT_GT(text_width(cut + letter, 21, true), 400) << letter;
        ASSERT_TRUE(cut.ends_with("\u2026")) << letter;
        // Nothing but whole letters before it.
        EXPECT_EQ((cut.size() - 3) % letter.size(), 0U) << letter;
    }
    EXPECT_EQ(shortened("aaa bbb", 10, text_width("aaa \u2026", 10)), "aaa\u2026");
    EXPECT_EQ(shortened("abc", 10, 0), "\u2026");
}

TEST(Drawing, SvgSaysWhatWasDrawn) {
    Drawing drawing(100, 50);
    drawing.describe("A & B", "1 < 2");
    drawing.clip({10, 10, 50, 20});
    drawing.path({{10, 10}, {20, 10}, {NAN, NAN}, {30, 5.126}, {31, 6}},
                 {.stroke = Color{0x123456}, .width = 2, .dash = {1, 2.5}});
    drawing.end_clip();
    drawing.circle({5, 6}, 3, {.fill = Color{0xff0000, 0.5}});
    drawing.text({50, 20}, "\"x\" < y", {.size = 10, .anchor = Anchor::Middle, .bold = true});
    EXPECT_EQ(
        to_svg(drawing),
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50\" viewBox=\"0 0 100 "
        "50\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
        "<title>A &amp; B</title>\n<desc>1 &lt; 2</desc>\n"
        "<defs>\n<clipPath id=\"clip1\"><rect x=\"10\" y=\"10\" width=\"50\" "
        "height=\"20\"/></clipPath>\n</defs>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "<g clip-path=\"url(#clip1)\">\n"
        "<path d=\"M10 10l10 0\" fill=\"none\" stroke=\"#123456\" stroke-width=\"2\" "
        "stroke-dasharray=\"1 2.5\"/>\n"
        "<path d=\"M30 5.13l1 0.87\" fill=\"none\" stroke=\"#123456\" stroke-width=\"2\" "
        "stroke-dasharray=\"1 2.5\"/>\n"
        "</g>\n"
        "<circle cx=\"5\" cy=\"6\" r=\"3\" fill=\"#ff0000\" fill-opacity=\"0.5\"/>\n"
        "<text x=\"50\" y=\"20\" font-size=\"10\" fill=\"#000000\" text-anchor=\"middle\" "
        "font-weight=\"bold\">&quot;x&quot; &lt; y</text>\n"
        "</svg>\n");
}

TEST(Drawing, WordsWithoutAFormAreEscapedInSvgAndInPixels) {
    // XML 1.0 takes no control characters but tabs and line ends, nothing that is not UTF-8, and
    // not U+FFFE or U+FFFF; Cairo ends a drawing with an error at what is not UTF-8, and at
    // noncharacters.
    const std::string odd =
        "a\x01\x1b[31m\n\t\x7f\xff\xc3(\xed\xa0\x80\xef\xbf\xbe\xc2\x85 S\xc3\xa3o";
    Drawing drawing(200, 50);
    drawing.describe(odd, odd);
    drawing.text({10, 20}, odd, {});
    const std::string svg = to_svg(drawing);
    const std::string seen =
        "a\\x01\\x1b[31m\\n\\t\\x7f\\xff\\xc3(\\xed\\xa0\\x80\\xef\\xbf\\xbe\\xc2\\x85 S\xc3\xa3o";
    EXPECT_NE(svg.find("<title>" + seen + "</title>\n<desc>" + seen + "</desc>"), std::string::npos)
        << svg;
    EXPECT_NE(svg.find(">" + seen + "</text>"), std::string::npos) << svg;
    for (const char c : svg)
        EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
    EXPECT_EQ(to_image(drawing, 1).width, 200);
}

TEST(Drawing, SvgLeavesOutPointsThatNobodySees) {
    Drawing drawing(400, 400);
    std::vector<glm::dvec2> circle;
    for (int i = 0; i <= 2000; ++i)
        circle.emplace_back(200 + 150 * std::cos(i / 1000.0 * 3.14159265358979),
                            200 + 150 * std::sin(i / 1000.0 * 3.14159265358979));
    drawing.path(circle, {.stroke = Color{0}});
    const std::string svg = to_svg(drawing);
    EXPECT_LT(svg.size(), 2500U);  // a point of 2001 takes ten letters
    // No chord leaves the circle by more than that, roundings to 0.01 included.
    std::string path = svg.substr(svg.find("d=\"M") + 4);
    path = path.substr(0, path.find('"'));
    std::vector<double> numbers;
    for (std::size_t at = 0; at < path.size();) {
        std::size_t used = 0;
        if (path[at] == 'l' || path[at] == ' ') {
            ++at;
            continue;
        }
        numbers.push_back(std::stod(path.substr(at), &used));
        at += used;
    }
    glm::dvec2 point(numbers[0], numbers[1]);
    double longest = 0;
    for (std::size_t i = 2; i + 1 < numbers.size(); i += 2) {
        const glm::dvec2 step(numbers[i], numbers[i + 1]);
        longest = std::max(longest, glm::length(step));
        point += step;
        EXPECT_NEAR(glm::length(point - glm::dvec2(200, 200)), 150, 0.02);
    }
    EXPECT_NEAR(glm::length(point - glm::dvec2(350, 200)), 0, 0.02);
    EXPECT_LT(longest * longest / (8 * 150), 0.06);  // the sagitta
}

TEST(Drawing, PixelsHaveTheColoursThatWereGiven) {
    Drawing drawing(40, 30);
    drawing.rect({5, 5, 20, 10}, {.fill = Color{0x1e90ff}});
    drawing.clip_circle({30, 20}, 5);
    drawing.rect({0, 0, 40, 30}, {.fill = Color{0x000000, 0.5}});
    drawing.end_clip();
    drawing.rect({36, 0, 4, 4}, {.fill = Color{0xff0000}});
    const image::Image8 image = to_image(drawing, 2);
    ASSERT_EQ(image.width, 80);
    ASSERT_EQ(image.height, 60);
    EXPECT_EQ(pixel(image, 2, 2), (std::array{255, 255, 255}));
    EXPECT_EQ(pixel(image, 20, 20), (std::array{0x1e, 0x90, 0xff}));
    EXPECT_EQ(pixel(image, 49, 29), (std::array{0x1e, 0x90, 0xff}));
    EXPECT_EQ(pixel(image, 51, 31), (std::array{255, 255, 255}));
    EXPECT_NEAR(pixel(image, 60, 40)[0], 128, 1);
    EXPECT_EQ(pixel(image, 60, 20), (std::array{255, 255, 255}));
    EXPECT_EQ(pixel(image, 79, 0), (std::array{255, 0, 0}));
}

TEST(Drawing, WordsBeginEndOrAreCentredAtTheirPlace) {
    const auto inked = [](Anchor anchor) {
        Drawing drawing(200, 30);
        drawing.text({100, 20}, "HIH", {.size = 20, .color = {0}, .anchor = anchor});
        const image::Image8 image = to_image(drawing);
        int first = 200, last = -1;
        for (int x = 0; x < 200; ++x)
            for (int y = 0; y < 30; ++y)
                if (image.at(x, y, 0) < 128) {
                    first = std::min(first, x);
                    last = std::max(last, x);
                }
        return std::pair(first, last);
    };
    const double width = text_width("HIH", 20);
    EXPECT_NEAR(inked(Anchor::Start).first, 100, 3);
    EXPECT_NEAR(inked(Anchor::Start).second, 100 + width, 3);
    EXPECT_NEAR(inked(Anchor::Middle).first, 100 - width / 2, 3);
    EXPECT_NEAR(inked(Anchor::End).second, 100, 3);
    EXPECT_NEAR(inked(Anchor::End).first, 100 - width, 3);
}

}  // namespace
}  // namespace relevo::chart
