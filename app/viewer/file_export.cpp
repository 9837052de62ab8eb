#include "viewer/file_export.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files_in_use.h"
#include "base/text.h"
#include "dem/files_of.h"
#include "mesh/refine.h"
#include "output/mesh_file.h"
#include "scene/map_view.h"
#include "scene/sheet.h"
#include "session/picture_file.h"
#include "session/record.h"
#include "viewer/export.h"
#include "viewer/translation.h"

namespace relevo::viewer {
FileExport::FileExport(ExportOrder order, std::string device,
                       std::shared_ptr<const session::LoadedDem> dem,
                       std::function<void()> on_change)
    : order_(std::move(order)),
      device_(std::move(device)),
      dem_(std::move(dem)),
      on_change_(std::move(on_change)),
      thread_([this] { run(); }) {}

FileExport::~FileExport() {
    thread_.join();
}

std::string FileExport::result() const {
    if (failure_) std::rethrow_exception(failure_);
    return result_;
}

void FileExport::run() {
    try {
        result_ = order_.is_picture() ? write_picture() : write_mesh();
    } catch (const Cancelled&) {
        result_ = tr_format("{}: cancelled, no file was written", printable(order_.path));
    } catch (const Error&) {
        failure_ = std::current_exception();
    } catch (const std::exception& error) {
        failure_ = std::make_exception_ptr(Error(
            ErrorCode::Failed, tr_format("export: {}: {}; use a smaller size or fewer samples",
                                         printable(order_.path), error.what())));
    }
    is_done_ = true;
    on_change_();
}

void FileExport::tell(double share) {
    if (is_cancelled_) throw Cancelled();
    share_ = std::max<double>(share_, share);
    on_change_();
}

std::string FileExport::write_picture() {
    scene::Scene scene = order_.scene;
    // Linear light has no stamps.
    if (image::holds_linear_light(order_.path)) scene.stamps.margin = false;
    scene::fit_map(scene, dem_->source->grid());
    const std::filesystem::path path = order_.path;
    FilesInUse files;
    dem::add_named(scene.dems, files);
    OutputFile& file = files.open_output(path, order_.overwrite, "export");
    const session::SceneIn scene_in = session::scene_in(path, scene);
    OutputFile* const sidecar =
        scene_in == session::SceneIn::Sidecar
            ? &files.open_output(session::sidecar_to_write(path), order_.overwrite, "export")
            : nullptr;
    std::vector<OutputFile*> beside;
    for (const std::filesystem::path& file_beside : session::files_beside(scene, path))
        beside.push_back(&files.open_output(file_beside, order_.overwrite, "export"));
    const session::PictureFormat format{.bits = order_.encoding.bits,
                                        .map_alone = scene::is_pdf(path)};
    const bool linear = image::holds_linear_light(path);
    const bool in_bands = session::needs_bands(scene, format, linear);
    if (in_bands) image::check_bands(path);
    image::load_format(path);
    session::SceneInputs inputs(RELEVO_VERSION);
    inputs.record(scene);
    dem::add_all(scene.dems, files);
    session::Session session(scene,
                             {.device = device_,
                              .dem = dem_,
                              .radiance = linear,
                              .format = format,
                              .on_frame = [this](double share) { tell(share); }},
                             files);
    std::optional<image::Picture> picture;
    if (!in_bands) picture = session.make_picture();
    session::write_picture(session, picture, file,
                           session::metadata_of(session, inputs, scene_in,
                                                session::format_text(order_.encoding, format)),
                           order_.encoding);
    if (const auto where = session::georeference_of(session)) session::write_beside(beside, *where);
    if (is_cancelled_) throw Cancelled();
    if (sidecar) sidecar->write(session::sidecar_text(session, inputs, path.filename().string()));
    files.finish_outputs();
    std::string text = tr_format("{}: picture saved in {}, {} x {}", printable(order_.path),
                                 folder_of(order_.path), scene.width_px, scene.height_px);
    for (const std::string& note : session.stamp_notes())
        text += "; " + note;
    return text;
}

std::string FileExport::write_mesh() {
    const scene::Scene& scene = order_.scene;
    FilesInUse files;
    dem::add_named(scene.dems, files);
    OutputFile& file = files.open_output(order_.path, order_.overwrite, "export");
    dem::add_all(scene.dems, files);
    const bool is_solid = order_.kind == kSolid;
    output::MeshFileOptions options{.generator = fmt::format("Relevo {}", RELEVO_VERSION),
                                    .is_stl = is_solid};
    options.mesh.error_m = order_.error_m;
    options.mesh.solid = is_solid;
    options.mesh.on_share = [this](double share) { tell(share); };
    options.mesh.max_triangles = scene.dem.memory.posts * 4 / mesh::kBytesATriangle;
    const dem::Holes holes = scene.holes == dem::Holes::Mark ? dem::Holes::Fill : scene.holes;
    const output::MeshFile made = output::write_mesh(
        file,
        output::read_ground(dem::Source::open(scene.dems, scene.dem), scene.dem,
                            {.holes = holes, .exaggeration = scene.exaggeration, .remedy = ""}),
        options);
    if (is_cancelled_) throw Cancelled();
    files.finish_outputs();
    return tr_format("{}: mesh saved in {}, {} triangles, worst error {:.2g} m",
                     printable(order_.path), folder_of(order_.path), made.mesh.surface.triangles(),
                     made.mesh.worst_m);
}

}  // namespace relevo::viewer
