#include "scene_drawer.h"

#include <utility>

#include "base/error.h"
#include "options.h"
#include "scene/panorama.h"
#include "scene/sheet.h"
#include "scene/stereo.h"
#include "session/batch.h"

namespace relevo::c {
namespace {

session::Options for_colours(const std::string& device) {
    session::Options options;
    options.device = device;
    options.format.emplace();
    return options;
}

session::Options for_data(const std::string& device) {
    session::Options options = for_colours(device);
    options.radiance = true;
    options.format->layers = {session::DataLayer::Depth, session::DataLayer::Position,
                              session::DataLayer::Normal};
    return options;
}

}  // namespace

SceneDrawer::SceneDrawer(scene::Scene scene, std::shared_ptr<Dem> dem, std::string device,
                         std::filesystem::path folder)
    : dem_(std::move(dem)),
      folder_(std::move(folder)),
      inputs_(RELEVO_VERSION),
      colours_(for_colours(device), times_, files_),
      data_(for_data(device), times_, files_) {
    take(std::move(scene));
}

void SceneDrawer::take(scene::Scene scene) {
    if (scene.dems.empty()) bad_input("scene: dem.files: missing, expected the files of a DEM");
    scene::check_panorama(scene);
    scene::check_stereo(scene);
    scene::check_sheet(scene, {});
    scene::Shot shot;
    shot.scene = times_.with_absolute_paths(scene);
    if (dem_) times_.use(shot.scene, dem_->loaded(shot.scene));
    times_.fit_map(shot.scene);
    if (session::needs_bands(shot.scene, {}, /*linear=*/false))
        bad_input("scene: picture.size: too large for memory; draw it by relevo capture");
    shot.utc = times_.of(shot.scene).utc;
    session::settle(shot, times_, inputs_);
    is_shown_ = false;
    colours_.of(shot).show(shot.scene, shot.utc);
    is_shown_ = true;
    given_ = std::move(scene);
    shot_ = std::move(shot);
    drawn_.reset();
}

void SceneDrawer::change(const char* text) {
    scene::Scene changed = given_;
    change_scene(changed, text, folder_);
    if (!same_dem(changed, given_))
        bad_input("scene: dem: a session keeps its DEM; open another session");
    take(std::move(changed));
}

void SceneDrawer::resize(int columns, int rows) {
    scene::Scene changed = given_;
    changed.width_px = columns;
    changed.height_px = rows;
    take(std::move(changed));
}

glm::ivec2 SceneDrawer::picture_px() {
    const scene::Scene& scene = shot_.scene;
    if (!scene.stamps.margin && scene.view.stereo == scene::Stereo::None &&
        scene.view.panorama == scene::Panorama::None)
        return {scene.width_px, scene.height_px};
    const image::Image8& drawn = picture();
    return {drawn.width, drawn.height};
}

const image::Image8& SceneDrawer::picture() {
    if (!drawn_) {
        session::Session& session = colours_.of(shot_);
        if (!is_shown_) session.show(shot_.scene, shot_.utc);
        is_shown_ = true;
        drawn_ = std::get<image::Image8>(session.make_picture().pixels);
    }
    return *drawn_;
}

void SceneDrawer::check_has_data() const {
    const scene::Scene& scene = shot_.scene;
    if (scene.stamps.margin || scene.view.stereo != scene::Stereo::None ||
        scene.view.panorama != scene::Panorama::None)
        bad_input(
            "depth, positions and normals: not of stereo pairs, panoramas and pictures with "
            "--margin");
}

DrawnData SceneDrawer::data() {
    check_has_data();
    session::Session& session = data_.of(shot_);
    session.show(shot_.scene, shot_.utc);
    return {session.make_picture().layers, session.ground().frame.origin()};
}

}  // namespace relevo::c
