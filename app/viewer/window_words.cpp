#include "viewer/window_words.h"

#include <array>

#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

struct Words {
    std::string_view command_line;
    const char* window;
};

/// Of two that begin alike the longer one is first.
constexpr std::array<Words, 20> kWords = {{
    {"name it on the command line, or add --trust",
     tr_later("relevo opens it if it is started with that name")},
    {", or --trust for all", ""},
    {"; add --plugin-path", tr_later("; to use them start relevo --plugin-path")},
    {"; choose another --eye", tr_later("; click the ground and stand there (G) first")},
    {"--panorama: ", tr_later("panorama: ")},
    {"--nodata none keeps it", tr_later("none in the field Nodata keeps it")},
    {"; --unit sets another", tr_later("; the field Unit sets another")},
    {"; --crs sets another", tr_later("; the field CRS sets another")},
    {"; --band N selects another", tr_later("; the field Band selects another")},
    {"pass --encoding", tr_later("choose the Encoding")},
    {"pass --unit", tr_later("choose the Unit")},
    {"pass the right CRS with --crs", tr_later("enter the right CRS:")},
    {"add --crs", tr_later("enter the CRS")},
    {"--crs", tr_later("CRS")},
    {"--band", tr_later("Band")},
    {"--bounds", tr_later("Edges")},
    {"--crop", tr_later("Crop")},
    {"--unit", tr_later("Unit")},
    {"--nodata", tr_later("Nodata")},
    {"--encoding", tr_later("Encoding")},
}};

}  // namespace

std::string window_words(std::string_view message) {
    std::string text(message);
    for (const Words& words : kWords) {
        const std::string_view window = words.window[0] == '\0' ? "" : tr(words.window);
        for (std::size_t at = text.find(words.command_line); at != std::string::npos;
             at = text.find(words.command_line, at + window.size()))
            text.replace(at, words.command_line.size(), window);
    }
    return text;
}

}  // namespace relevo::viewer
