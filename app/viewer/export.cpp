#include "viewer/export.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/text.h"
#include "dem/remote.h"
#include "image/image.h"
#include "light/point/refraction_at.h"
#include "render/renderer.h"
#include "scene/job.h"
#include "session/non_finite.h"
#include "session/record.h"
#include "session/stamps.h"
#include "session/words.h"
#include "sun/position.h"
#include "viewer/mark_overlay.h"
#include "viewer/settings.h"
#include "viewer/translation.h"

namespace relevo::viewer {

std::string write_under_free_name(const std::string& ending,
                                  const std::function<void(OutputFile&)>& write) {
    for (int n = 1;; ++n) {
        const std::string name = fmt::format("relevo-{}.{}", n, ending);
        const auto is_taken = [&] {
            std::error_code ignored;
            return std::filesystem::exists(std::filesystem::symlink_status(name, ignored));
        };
        if (is_taken()) continue;
        try {
            OutputFile file(name, /*overwrite=*/false, "view");
            write(file);
            return name;
        } catch (const Error&) {
            // Another window may have taken the name meanwhile.
            if (!is_taken()) throw;
        }
    }
}

std::string free_name(const std::string& stem, const std::string& ending) {
    std::string name = stem + "." + ending;
    std::error_code ignored;
    for (int n = 2; std::filesystem::exists(std::filesystem::symlink_status(name, ignored)); ++n)
        name = fmt::format("{}-{}.{}", stem, n, ending);
    return name;
}

std::string folder_of(const std::string& file) {
    std::error_code unknown;
    const std::filesystem::path whole = std::filesystem::absolute(file, unknown);
    return unknown ? "." : printable(whole.parent_path().string());
}

std::string free_picture_name() {
    return free_name("picture", "png");
}

namespace {

/// @returns the file's name
std::string save_json(const std::string& text) {
    return write_under_free_name("json", [&](OutputFile& file) {
        file.write(text);
        file.finish();
    });
}

}  // namespace

scene::Scene whole_scene(const Document& document, const Land& land, glm::ivec2 size_px) {
    scene::Scene scene = document.whole(land);
    scene.width_px = size_px.x;
    scene.height_px = size_px.y;
    // As the window shows it, whatever projection a file asked for.
    scene.ortho = false;
    scene.resolution = 0;
    scene.sheet = {};
    scene.view.panorama = scene::Panorama::None;
    scene.view.stereo = scene::Stereo::None;
    scene.dems = absolute_names(std::move(scene.dems));
    return scene;
}

namespace {

/// The option that a command for this scene's file needs: Relevo uses plugin folders and remote
/// files only if the command line allows them.
std::string trust_option(const scene::Scene& scene) {
    const bool asks_net = std::ranges::any_of(scene.dems, is_remote) ||
                          (scene.overlay && is_remote(scene.overlay->file));
    return asks_net || !scene.effects.plugin_path.empty() ? " --trust" : "";
}

}  // namespace

std::string save_scene(const scene::Scene& scene) {
    const std::string name = save_json(scene::scene_text(scene, ""));
    return tr_format("{0}: scene saved in {2}; relevo view --scene {0}{1} opens it", name,
                     trust_option(scene), folder_of(name));
}

std::string save_job(const scene::Scene& scene, const SunDay& day, const sun::Zone& zone) {
    const auto rise = day.events.first(sun::EventKind::Sunrise),
               set = day.events.first(sun::EventKind::Sunset);
    const bool by_sun = rise && set && *rise < *set;
    const scene::JobDay of_day{.date = sun::to_string(day.date),
                               .zone = zone.name().starts_with("LMT") ? "solar" : zone.name(),
                               .from = by_sun ? "sunrise" : "00:00",
                               .to = by_sun ? "sunset" : "23:00",
                               .step = "1h",
                               .output = "{dem}_{time:%Y%m%dT%H%M}.png"};
    const std::string name = save_json(scene::day_job_text(scene, of_day, ""));
    const std::string trust = trust_option(scene);
    return by_sun ? tr_format(
                        "{0}: every hour of this day from sunrise to sunset; run it with relevo "
                        "run {0}{1}",
                        name, trust)
                  : tr_format("{0}: every hour of this day; run it with relevo run {0}{1}", name,
                              trust);
}

std::string save_film_job(const scene::Scene& scene, const scene::FilmJob& film) {
    const std::string name = save_json(scene::film_job_text(scene, film, ""));
    return tr_format("{0}: the job of the film; make it with relevo run {0}{1}", name,
                     trust_option(scene));
}

namespace {

/// As session::Session::sun_text().
std::string sun_of(const Picture& picture, const scene::Scene& scene,
                   const render::Ground& ground) {
    const auto eye = session::observer_of(ground.frame, picture.camera, scene.exaggeration);
    const geo::Geodetic middle = ground.frame.origin();
    const geo::Geodetic air =
        eye.value_or(geo::Geodetic{middle.lat_rad, middle.lon_rad, ground.air_height_m()});
    return session::sun_text(sun::position(picture.utc, eye.value_or(middle)),
                             light::refraction_at(scene.refraction, air));
}

}  // namespace

std::string save_picture(const Picture& picture, scene::Scene scene, const Opened& opened,
                         const Coloured& coloured) {
    scene.seconds = picture.seconds;
    scene.stamps.margin = false;
    const std::vector<std::uint8_t> rgba = picture.read_rgba();
    if (const int pixels = render::count_non_finite(rgba); pixels > 0)
        failed(tr_format("picture: {}; relevo capture names the effect",
                         session::non_finite_text(pixels, {picture.width_px, picture.height_px})));
    image::Image8 image = image::from_device(picture.width_px, picture.height_px, rgba);
    const geo::LocalFrame& frame = opened.ground.frame;
    session::Stamped stamped{scene, *opened.dem, frame, picture.camera};
    if (session::needs_depths(scene.stamps)) stamped.depths_m = picture.read_depths_m();
    const std::optional<session::OverlayTime>& overlay_time = coloured.overlay_time;
    if (scene.stamps.date)
        stamped.clock = overlay_time
                            ? session::clock_text(*overlay_time, scene.time.zone, frame.origin())
                            : session::clock_text(picture.utc, scene.time.zone, frame.origin());
    if (scene.stamps.sun)
        stamped.sun =
            overlay_time ? session::sun_text(*overlay_time) : sun_of(picture, scene, opened.ground);
    std::vector<chart::Rect> taken;
    const std::vector<std::string> notes =
        session::add_stamps(std::move(stamped), coloured.legends, image, taken);
    add_marks(picture, taken, image);
    const image::Metadata metadata{{"Software", "Relevo"},
                                   {"Description", capture_command(scene, "picture.png")},
                                   {session::kSceneKeyword, scene::scene_line(scene)}};
    const std::string name = write_under_free_name("png", [&](OutputFile& file) {
        image::write(file, image, metadata);
        file.finish();
    });
    std::string message = tr_format("{}: picture saved in {}", name, folder_of(name));
    for (const std::string& note : notes)
        message += "; " + note;
    return message;
}

}  // namespace relevo::viewer
