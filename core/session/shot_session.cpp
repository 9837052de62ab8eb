#include "session/shot_session.h"

#include <new>
#include <utility>

namespace relevo::session {

std::string reason_of(const std::exception_ptr& thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        return "out of memory; use a smaller --size or --memory";
    } catch (const std::exception& error) {
        return error.what();
    }
}

scene::Scene of_any_view(scene::Scene scene) {
    const scene::View given = std::exchange(scene.view, {});
    scene.view.panorama = given.panorama;  // which renderers depend on: needs_of()
    scene.view.stereo = given.stereo;
    return scene;
}

Session& ShotSession::of(const scene::Shot& shot) {
    std::string key = dem_key(shot.scene);
    const RendererNeeds needs = needs_of(shot.scene, options_.format.value());
    if (session_ && key == dem_ && needs == needs_) return *session_;
    session_.reset();
    times_.keep_only(shot.scene);
    Options options = options_;
    options.dem = times_.loaded(shot.scene);
    session_ = std::make_unique<Session>(of_any_view(shot.scene), options, files_);
    dem_ = std::move(key);
    needs_ = needs;
    opened_ = true;
    return *session_;
}

}  // namespace relevo::session
