#include "viewer/export_choice.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "scene/name_template.h"
#include "scene/panorama.h"
#include "scene/sheet.h"
#include "scene/stereo.h"
#include "session/picture_file.h"
#include "session/record.h"
#include "viewer/document.h"

namespace relevo::viewer {
namespace {

/// The picture's part of an order.
void set_picture(ExportOrder& order, const ExportChoice& choice, const scene::Stamps& stamps) {
    const ExportKind& kind = choice.of();
    scene::Scene& scene = order.scene;
    scene.width_px = choice.size_px.x;
    scene.height_px = choice.size_px.y;
    scene.samples = choice.samples;
    scene.transparent = choice.is_transparent && choice.can_be_transparent() && !kind.is_sheet;
    scene.stamps = stamps;
    if (stamps.attribution_text.empty()) scene.stamps.attribution = false;
    scene.stamps.margin = kind.is_sheet || (stamps.margin && kind.has_lens());
    scene.ortho = kind.is_ortho;
    scene.view.panorama = kind.panorama;
    scene.view.stereo = kind.stereo;
    scene.resolution = 0;  // the choice has a size
    scene.sheet = choice.sheet();
    scene::check_panorama(scene);
    scene::check_stereo(scene);
    scene::check_sheet(scene, order.path);
    if (kind.is_sheet) return;  // its file has the pixels that its paper asks for
    order.encoding.bits = choice.file_format().bits;
    if (choice.file_format().has_quality) order.encoding.quality = choice.quality;
    image::check_encoding(
        order.path, order.encoding,
        {.width_px = choice.size_px.x, .height_px = choice.size_px.y, .alpha = scene.transparent});
}

}  // namespace

void ExportChoice::set_kind(int index) {
    kind = index;
    if (!of().is_picture() || of().is_sheet) return;
    size_px = of().size_px;
    if (of().is_ortho)
        format = kTiff;
    else if (format == kTiff)
        format = kPng;
}

scene::Sheet ExportChoice::sheet() const {
    if (!of().is_sheet) return {};
    return {.paper = lower(kExportPapers[static_cast<std::size_t>(paper)]), .scale = map_scale};
}

double ExportChoice::aspect() const {
    // Side by side each eye has half of the width.
    const bool is_pair = of().stereo == Stereo::Parallel;
    return static_cast<double>(size_px.x) / (is_pair ? 2 * size_px.y : size_px.y);
}

bool ExportUse::is_of(const ExportChoice& choice) const {
    return choice.kind == kind && size_px.x > 0 && choice.size_px == size_px &&
           choice.format == format && choice.samples == samples;
}

void ExportUse::apply_to(ExportChoice& choice, scene::Stamps& stamps, glm::ivec2 window_px) const {
    choice.kind = kind;
    choice.size_px = size_px.x > 0 ? size_px : window_px;
    choice.format = format;
    choice.samples = samples;
    stamps.margin = stamps.title = stamps.scale = stamps.north = is_stamped;
    stamps.attribution = is_stamped && !stamps.attribution_text.empty();
}

std::string path_in(const std::string& folder, const std::string& name) {
    const char* const home = std::getenv("HOME");
    const bool is_home = home && (folder == "~" || folder.starts_with("~/"));
    return std::filesystem::path(is_home ? home + folder.substr(1) : folder) / name;
}

ExportOrder order_of(const ExportChoice& choice, const scene::Stamps& stamps,
                     const scene::Scene& scene, sun::Instant utc, const sun::Zone& zone) {
    const ExportKind& kind = choice.of();
    const std::string dem = std::filesystem::path(scene.dems.front()).stem().string();
    const std::string stem = scene::NameTemplate(choice.name, {})
                                 .name({.number = 1, .dem = dem, .utc = utc, .zone = zone});
    if (stem.empty() || stem.ends_with('/')) bad_input(tr("the name is empty"));
    const char* const ending = kind.ending[0] ? kind.ending : choice.file_format().ending;
    ExportOrder order{.scene = scene,
                      .path = path_in(choice.folder, stem + "." + ending),
                      .kind = choice.kind,
                      .error_m = choice.error_m};
    const std::filesystem::path folder = std::filesystem::path(order.path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
        bad_input(tr_format("{}: there is no such folder", printable(folder.string())));
    if (kind.is_picture()) set_picture(order, choice, stamps);
    return order;
}

std::vector<std::string> files_of(const ExportOrder& order) {
    std::vector<std::string> files{order.path};
    if (!order.is_picture()) return files;
    if (session::scene_in(order.path, order.scene) == session::SceneIn::Sidecar)
        files.push_back(session::sidecar_of(order.path));
    for (const std::filesystem::path& beside : session::files_beside(order.scene, order.path))
        files.push_back(beside);
    return files;
}

std::string command_of(const ExportOrder& order) {
    if (!order.is_picture())
        return mesh_command(order.scene, order.path, order.error_m, order.kind == kSolid);
    std::string command = capture_command(order.scene, order.path);
    if (order.encoding.bits != 8) command += fmt::format(" --bits {}", order.encoding.bits);
    if (order.encoding.quality) command += fmt::format(" --quality {}", *order.encoding.quality);
    return command;
}

}  // namespace relevo::viewer
