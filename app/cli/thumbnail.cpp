#include <memory>
#include <string>
#include <string_view>

#include "base/files_in_use.h"
#include "base/percent.h"
#include "chart/shaded_relief.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "dem/quick_look.h"
#include "image/image.h"

namespace relevo::cli {
namespace {

struct ThumbnailArguments {
    std::string dem, output;
    int size_px = 256;
};

/// The path of "file:///home/me/an%20alp.hgt"; other names stay.
std::string path_of(std::string_view name) {
    const auto path = path_of_file_uri(name);
    return path ? percent_decoded(*path) : std::string(name);
}

void thumbnail(const ThumbnailArguments& arguments) {
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

void add_thumbnail(Verb app) {
    const auto arguments = std::make_shared<ThumbnailArguments>();
    const Verb verb = app.add_verb(
        "thumbnail", "Makes a small picture of a DEM for file managers, without a GL device");
    verb.add_option("DEM", arguments->dem, "Elevation raster, a name or a file:// address")
        .required();
    verb.add_option("OUTPUT", arguments->output, "PNG to write or replace").required();
    verb.add_option("-s,--size", arguments->size_px, "Longer side, pixels (256)")
        .check(in_range(1, 4096));
    verb.callback([arguments] { thumbnail(*arguments); });
}

}  // namespace relevo::cli
