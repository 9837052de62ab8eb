#include "viewer/file_opener.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/allowed_name.h"
#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "overlay/camera_photo.h"
#include "scene/exaggeration.h"
#include "scene/job.h"
#include "session/record.h"
#include "session/trust.h"
#include "viewer/file_kind.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

std::string name_of(const std::string& path) {
    return printable(std::filesystem::path(path).filename().string());
}

/// The scene in a picture of relevo. @throws Error (BadInput)
scene::Scene scene_in_picture(const std::string& path) {
    const image::Metadata metadata = session::read_record(path);
    const auto text = metadata.find(session::kSceneKeyword);
    if (text == metadata.end()) bad_input(tr_format("{}: contains no scene", printable(path)));
    return scene::read_scene_text(text->second, path, std::filesystem::path(path).parent_path());
}

/// The scene that the pictures of a job have in common, without a time that needs a date.
scene::Scene scene_of_job(const std::string& path) {
    scene::Scene scene = scene::read_job(path).scene;
    if (scene.time.date.empty() && scene.time.at.find('T') == std::string::npos)
        scene.time.at.clear();
    return scene;
}

}  // namespace

void FileOpener::ask_which() {
    const std::string& file = parts_.opening.requested_file();
    // The folder of the bundled DEM has no files of the user's.
    dialog_.open(file.starts_with(share_dir().string()) ? "" : file);
}

void FileOpener::ask_how() {
    if (!parts_.opening.opened()) return;
    const scene::Scene& scene = parts_.state.document.scene;
    refused_.reset();
    sheet_.open({scene.dems, scene.dem, scene.holes}, "", opened_last());
}

RecentDem FileOpener::opened_last() const {
    return parts_.state.recent.empty() ? RecentDem{} : parts_.state.recent.front();
}

void FileOpener::draw(glm::vec2 window_px) {
    dialog_.draw(window_px);
    sheet_.draw(window_px);
}

void FileOpener::close() {
    dialog_.close();
    sheet_.close();
}

void FileOpener::open_requested_files() {
    std::vector<std::string> files = parts_.window.take_dropped_files();
    if (std::vector<std::string> chosen = dialog_.take(); !chosen.empty())
        files = std::move(chosen);
    const std::vector<std::string> dems = std::exchange(parts_.state.files_to_open, {});
    std::optional<RecentDem> recent = std::exchange(parts_.state.recent_to_open, std::nullopt);
    const std::optional<RecentDem> imported = sheet_.take();
    if (!parts_.opening.opened()) {
        if (imported) open_imported(*imported);
        return;
    }
    if (const std::string track = film_.take_track(); !track.empty()) files.push_back(track);
    if (imported || recent || !dems.empty() || !files.empty()) film_.end_preview();
    if (imported) return open_imported(*imported);
    if (recent) return open_dem(*recent);
    if (!dems.empty()) return open_dem({.files = dems});
    if (!files.empty()) open_files(files);
}

void FileOpener::open_files(const std::vector<std::string>& files) {
    RecentDem dem;
    for (const std::string& file : absolute_names(files)) {
        allow_name(file);
        const FileKind kind = kind_of_file(file);
        if (kind == FileKind::Dem)
            dem.files.push_back(file);
        else
            parts_.messages.try_to([&] { open_file(kind, file); });
    }
    if (!dem.files.empty()) open_dem(dem);
}

void FileOpener::open_dem(const RecentDem& dem) {
    // Options of the last DEM do not apply, except for the window's limit of memory.
    scene::Scene scene = parts_.state.document.scene;
    const MemoryBudget memory = scene.dem.memory;
    scene.dems = dem.files;
    std::ranges::for_each(scene.dems, allow_name);
    scene.dem = dem.options;
    scene.dem.memory = memory;
    scene.holes = dem.holes;
    scene.view = {};
    scene.overlay.reset();
    scene.land_cover = {};
    scene.time.at.clear();
    scene.time.date.clear();
    if (parts_.state.chooses_exaggeration) {
        scene.exaggeration = 1;
        scene.chooses_exaggeration = scene::may_exaggerate(scene);
        // Not what was chosen for the snow of the DEM before.
        if (parts_.opening.opened() &&
            scene.exposure_ev == parts_.opening.opened()->scene.exposure_ev)
            scene.exposure_ev = parts_.opening.scene().exposure_ev;
    }
    open_scene(std::move(scene));
}

void FileOpener::open_imported(const RecentDem& dem) {
    if (!refused_) return open_dem(dem);
    scene::Scene scene = *std::exchange(refused_, std::nullopt);
    scene.dem = dem.options;
    scene.holes = dem.holes;
    open_scene(std::move(scene));
}

void FileOpener::open_scene(scene::Scene scene) {
    parts_.state.message.clear();
    sheet_.close();
    scene.dem.cached = is_cached_;
    parts_.opening.open(std::move(scene), first_wanted_());
    parts_.pacing.need_frames(3);
}

void FileOpener::open_file(FileKind kind, const std::string& path) {
    switch (kind) {
        case FileKind::Scene:
            return open_named_scene(scene::read_scene(path), path, session::NamedBy::File);
        case FileKind::Job:
            open_named_scene(scene_of_job(path), path, session::NamedBy::File);
            if (!parts_.state.message.empty()) return;  // a warning
            return parts_.messages.note(
                tr_format("the scene of {}; relevo run draws its pictures", name_of(path)));
        case FileKind::Picture:
            return open_named_scene(scene_in_picture(path), path, session::NamedBy::Picture);
        case FileKind::Photograph:
            return stand_where_taken(path);
        case FileKind::Places:
        case FileKind::Lines:
            return show_features(kind, path);
        case FileKind::Overlay:
            return lay_over(path);
        case FileKind::Dem:
            return open_dem({.files = {path}});
    }
}

void FileOpener::open_named_scene(scene::Scene scene, const std::string& path,
                                  session::NamedBy by) {
    const scene::Scene& now = parts_.state.document.scene;
    session::Trust trusted({.plugin_folders = now.effects.plugin_path}, name_of(path), by);
    trusted.check_names(scene);
    trusted.keep_folders(scene.effects);
    if (scene.dems.empty()) {
        scene.dems = now.dems;
        scene.dem = now.dem;
    }
    open_scene(std::move(scene));
    if (const std::vector<std::string> warnings = trusted.warnings(); !warnings.empty())
        parts_.messages.show(fmt::format("{}", fmt::join(warnings, "\n")));
}

void FileOpener::show_features(FileKind kind, const std::string& path) {
    const std::string address = file_text_for(kind, parts_.state.effects->registry);
    if (address.empty()) bad_input(tr_format("no installed effect shows {}", name_of(path)));
    const std::string id = address.substr(0, address.find('.'));
    const dem::Grid& grid = parts_.opening.opened()->dem->source->grid();
    const FilePlace place = place_of_file(kind, path, grid);
    parts_.state.set_effects(
        switched(with_value(parts_.state.document.scene.effects, address, path), id, true));
    parts_.state.message.clear();
    parts_.state.take_effects(/*is_step=*/true);
    if (!parts_.state.message.empty()) return;  // why the effect is not on
    moves_.show(place);
    parts_.messages.note(tr_format("{}: {}; shown by the effect {}", name_of(path),
                                   words_of(place, kind, grid), id));
}

void FileOpener::lay_over(const std::string& path) {
    const dem::Grid& grid = parts_.opening.opened()->dem->source->grid();
    const FilePlace place = place_of_file(FileKind::Overlay, path, grid);
    parts_.state.document.scene.overlay = scene::Overlay{.file = path};
    parts_.state.document.overlay = choice_of(*parts_.state.document.scene.overlay);
    parts_.state.step = true;
    moves_.show(place);
    parts_.messages.note(
        tr_format("{}: {}", name_of(path), words_of(place, FileKind::Overlay, grid)));
    parts_.pacing.need_frames(3);
}

void FileOpener::stand_where_taken(const std::string& path) {
    const overlay::CameraPhoto photo = overlay::camera_photo(path).value();
    const geo::Geodetic place{photo.place->lat_rad, photo.place->lon_rad, 0};
    const double ground_m = parts_.state.land.aim_m(place);
    if (std::isnan(ground_m))
        bad_input(tr_format("{}: taken at {}, where the DEM has no ground", name_of(path),
                            coordinates_text(place, Coordinates::Degrees)));
    // Heights of a GPS are off by tens of metres: from higher up it was taken in the air.
    constexpr double kInTheAir_m = 100;
    const bool flies = photo.place->height_m > ground_m + kInTheAir_m;
    scene::View view;
    view.eye = scene::Standpoint{place, /*above_ground=*/!flies};
    view.eye->place.height_m = flies ? photo.place->height_m : kWalk_m;
    view.heading_deg = photo.heading_deg.value_or(parts_.state.document.pose.heading_deg);
    view.fov_y_rad = parts_.state.document.pose.fov_y_rad;
    if (photo.focal_length_mm)
        view.fov_y_rad = scene::fov_y_of_focal_length(
            *photo.focal_length_mm, static_cast<double>(photo.width_px) / photo.height_px);
    std::optional<sun::Instant> taken;
    try {
        if (!photo.time.empty())
            taken = sun::parse_time(photo.time, parts_.state.document.zone).utc;
    } catch (const Error&) {
        // A camera whose clock was not set.
    }
    parts_.history.end_step(parts_.state.document);
    parts_.hand.rest();
    parts_.state.document.pose = moves_.pose_in(view);
    if (taken) parts_.state.set_utc(*taken);
    parts_.pacing.moved();
    parts_.state.step = true;
    parts_.messages.note(
        fmt::format("{}: {}{}{}{}", name_of(path),
                    flies ? tr("from the air") : tr("from eye height at its place"),
                    photo.heading_deg ? "" : tr(", which way it looks is not known"),
                    photo.is_magnetic ? tr(", by the magnetic heading, not corrected") : "",
                    taken ? "" : tr(", without a time")));
}

void FileOpener::open_neighbour(int step) {
    const std::string& file = parts_.opening.requested_file();
    if (file.empty()) return;
    if (const std::string next = neighbour_in_folder(file, step); !next.empty())
        parts_.state.files_to_open = {next};
    else
        parts_.messages.show(tr("no other DEM in this folder"));
}

void FileOpener::ask_after_failure() {
    const std::optional<Opening::Failure> failure = parts_.opening.take_failure();
    if (!failure || !is_raster_file(failure->scene.dems.front())) return;
    const scene::Scene& scene = failure->scene;
    // Without an open scene the sheet is alone in the window; it mends nothing else.
    if (!parts_.opening.opened() &&
        preview_of({scene.dems, scene.dem, 4})->error != failure->reason)
        return;
    parts_.state.message.clear();
    refused_ = failure->scene;
    sheet_.open({refused_->dems, refused_->dem, refused_->holes}, failure->reason, opened_last());
}

}  // namespace relevo::viewer
