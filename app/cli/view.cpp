#include <memory>
#include <utility>

#include "base/paths.h"
#include "cli/commands.h"
#include "cli/exaggeration_argument.h"
#include "cli/scene_arguments.h"
#include "viewer/viewer.h"

namespace relevo::cli {
namespace {

struct WindowArguments {
    SceneArguments scene;
    ExaggerationArgument exaggeration;
    std::string device = "auto";
};

void view(WindowArguments arguments) {
    // A window has a zone to show times in, whatever the time.
    TimeArguments& time = arguments.scene.time;
    const std::string zone = time.time.empty() ? std::exchange(time.zone, {}) : std::string();
    scene::Scene scene = arguments.scene.scene();
    arguments.exaggeration.apply_to(scene, !arguments.scene.file.empty());
    if (!zone.empty()) scene.time.zone = zone;
    if (scene.dems.empty()) scene.dems.push_back((share_dir() / "data/dem/jacksboro.tif").string());
    viewer::run(scene, arguments.device);
}

}  // namespace

void add_view(Verb app) {
    const auto arguments = std::make_shared<WindowArguments>();
    const Verb verb = app.add_verb("view", "Opens a window on a DEM (default: the bundled DEM)");
    arguments->exaggeration.add_to(verb);
    arguments->scene.add_to(verb);
    arguments->scene.dem.dem_option.required(false);
    verb.add_option("--device", arguments->device,
                    "GL device that draws the ground: auto, an index, software, or a part of its "
                    "name");
    verb.callback([arguments] { view(*arguments); });
}

}  // namespace relevo::cli
