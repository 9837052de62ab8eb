#include <memory>
#include <string>
#include <string_view>

#include "base/files_in_use.h"
#include "chart/shaded_relief.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "dem/quick_look.h"
#include "image/image.h"

namespace relevo::cli {
namespace {

struct Arguments {
    std::string dem, output;
    int size_px = 256;
};

/// The path of "file:///home/me/an%20alp.hgt"; other names stay.
std::string path_of(std::string_view name) {
    constexpr std::string_view kFile = "file://";
    if (!name.starts_with(kFile)) return std::string(name);
    name.remove_prefix(kFile.size());
    std::string path;
    const auto digit = [](char c) {
        const std::size_t at =
            std::string_view("0123456789abcdef")
                .find(static_cast<char>(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c));
        return at == std::string_view::npos ? -1 : static_cast<int>(at);
    };
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool is_code = name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 &&
                             digit(name[i + 2]) >= 0;
        path += is_code ? static_cast<char>(16 * digit(name[i + 1]) + digit(name[i + 2])) : name[i];
        if (is_code) i += 2;
    }
    return path;
}

void thumbnail(const Arguments& arguments) {
    const std::string path = path_of(arguments.dem);
    FilesInUse files;
    files.add_input(path, "the DEM");
    // A file manager has made an empty file of that name.
    OutputFile& file = files.open_output(arguments.output, /*overwrite=*/true, "OUTPUT");
    const dem::QuickLook look = dem::quick_look(path, 2 * arguments.size_px);
    image::write(file, image::Picture{chart::shaded_relief(look, arguments.size_px)}, {},
                 {.format = "png"});
    files.finish_outputs();
}

}  // namespace

void add_thumbnail(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *app.add_subcommand(
        "thumbnail", "Makes a small picture of a DEM for file managers, without a GL device");
    verb.add_option("DEM", arguments->dem, "Elevation raster, a name or a file:// address")
        ->required();
    verb.add_option("OUTPUT", arguments->output, "PNG to write or replace")->required();
    verb.add_option("-s,--size", arguments->size_px, "Longer side, pixels (256)")
        ->check(in_range(1, 4096));
    verb.callback([arguments] { thumbnail(*arguments); });
}

}  // namespace relevo::cli
