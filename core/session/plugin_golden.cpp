#include "session/plugin_golden.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"
#include "effect/effect.h"
#include "session/session.h"

namespace relevo::session {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kWho = "plugins test";

/// The id of the plugin in a folder. @throws Error (BadInput)
std::string id_of(const fs::path& folder) {
    return effect::load_effect(folder, share_dir() / "data").id();
}

void write_picture(const fs::path& file, const image::Image8& picture) {
    image::write(file, picture, {}, /*overwrite=*/true);
}

}  // namespace

image::Image8 draw_with_plugin(const fs::path& folder, const std::string& id) {
    scene::Scene scene;
    scene.dems = {(share_dir() / "data/dem/jacksboro.tif").string()};
    scene.width_px = 240;
    scene.height_px = 160;
    scene.pixel_error = 2;
    scene.time.at = "2026-06-21T18:30-04:00";
    scene.view = scene::parse_view("az=210,el=30");
    scene.effects.switches.only.emplace();
    if (!id.empty()) scene.effects.switches.only->push_back(id);
    scene.effects.plugin_path = {folder.string()};
    FilesInUse files;
    Session session(scene, {.device = "software"}, files);
    session.draw();
    return session.picture();
}

GoldenResult test_plugin(const fs::path& folder, bool update) {
    const std::string id = id_of(folder);
    const fs::path golden = folder / "golden.png", found = folder / "found.png";
    std::error_code ignored;
    if (!update && !fs::is_regular_file(golden, ignored))
        bad_input(fmt::format("{}: {}: no such file; --update writes it", kWho, golden.string()));
    const image::Image8 picture = draw_with_plugin(folder, id);
    if (update) {
        write_picture(golden, picture);
        const image::Difference change = image::compare(picture, draw_with_plugin(folder, ""));
        return {fmt::format("{} is written; {} changes {:.3g} % of its values", golden.string(), id,
                            100 * change.share_over_1),
                true};
    }
    const image::Difference difference = image::compare(picture, image::read(golden));
    if (difference.share_over_1 > kGoldenShare || difference.worst > kGoldenWorst) {
        write_picture(found, picture);
        throw Error(
            ErrorCode::Differ,
            fmt::format("{}: {}: {:.3g} % of the values differ by more than 1/255, at most "
                        "by {:.0f}/255, expected at most {} % and {}/255; the picture is "
                        "{}, --update replaces golden.png",
                        kWho, golden.string(), 100 * difference.share_over_1, difference.worst,
                        100 * kGoldenShare, kGoldenWorst, found.string()));
    }
    fs::remove(found, ignored);
    return {fmt::format("{} is as in {}", id, golden.string())};
}

}  // namespace relevo::session
