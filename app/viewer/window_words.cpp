#include "viewer/window_words.h"

#include <array>

namespace relevo::viewer {
namespace {

struct Words {
    std::string_view command_line, window;
};

/// Of two that begin alike the longer one is first.
constexpr std::array<Words, 20> kWords = {{
    {"name it on the command line, or add --trust",
     "relevo opens it if it is started with that name"},
    {", or --trust for all", ""},
    {"; add --plugin-path", "; to use them start relevo --plugin-path"},
    {"; choose another --eye", "; click the ground and stand there (G) first"},
    {"--panorama: ", "panorama: "},
    {"--nodata none keeps it", "none in the field Nodata keeps it"},
    {"; --unit sets another", "; the field Unit sets another"},
    {"; --crs sets another", "; the field CRS sets another"},
    {"; --band N selects another", "; the field Band selects another"},
    {"pass --encoding", "choose the Encoding"},
    {"pass --unit", "choose the Unit"},
    {"pass the right CRS with --crs", "enter the right CRS:"},
    {"add --crs", "enter the CRS"},
    {"--crs", "CRS"},
    {"--band", "Band"},
    {"--bounds", "Edges"},
    {"--crop", "Crop"},
    {"--unit", "Unit"},
    {"--nodata", "Nodata"},
    {"--encoding", "Encoding"},
}};

}  // namespace

std::string window_words(std::string_view message) {
    std::string text(message);
    for (const Words& words : kWords)
        for (std::size_t at = text.find(words.command_line); at != std::string::npos;
             at = text.find(words.command_line, at + words.window.size()))
            text.replace(at, words.command_line.size(), words.window);
    return text;
}

}  // namespace relevo::viewer
