#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/held_notices.h"
#include "base/srgb.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/exaggeration_argument.h"
#include "cli/export.h"
#include "cli/scene_arguments.h"
#include "dem/files_of.h"
#include "dem/north_up.h"
#include "geo/local_frame.h"
#include "output/exported_ground.h"
#include "session/scene_times.h"
#include "session/session.h"
#include "web/page.h"
#include "web/page_data.h"

namespace relevo::cli {
namespace {

constexpr double kMegabyte = 1e6;
constexpr double kMostSide = 2048;       // posts of a page, and pixels of its colour
constexpr double kEnlarged = 2;          // pixels of its colour for a post, at most
constexpr double kShareOfHeights = 0.7;  // of a page, at least where they need it
constexpr double kDescription_bytes = 20e3;
constexpr glm::ivec2 kStill_px{1200, 630};  // as previews of links are

struct WebArguments : ResultArguments {
    SceneArguments scene;
    ExaggerationArgument exaggeration;
    std::string device = "auto";
    double megabytes = 2.5;
    bool folder = false;
};

scene::Scene scene_of(const WebArguments& arguments) {
    scene::Scene scene = arguments.scene.scene();
    arguments.exaggeration.apply_to(scene, !arguments.scene.file.empty());
    const auto refuse = [](bool given, const char* option) {
        if (given) bad_usage(fmt::format("{}: a web page has a plain camera; remove it", option));
    };
    refuse(scene.ortho, "--ortho");
    refuse(scene.view.panorama != scene::Panorama::None, "--panorama");
    refuse(scene.view.stereo != scene::Stereo::None, "--stereo");
    refuse(scene.transparent, "--transparent");
    refuse(scene.overlay.has_value(), "--overlay");
    if (arguments.scene.file.empty() && arguments.scene.size.empty()) {
        scene.width_px = kStill_px.x;
        scene.height_px = kStill_px.y;
    }
    return scene;
}

/// Columns and rows of a DEM with north up, or fewer in the same ratio.
glm::ivec2 posts_of(const dem::Grid& grid, double most_a_side) {
    glm::dvec2 posts(grid.columns(), grid.rows());
    if (dem::north_up_of(grid.affine()).swap) std::swap(posts.x, posts.y);
    const double share = std::min(1.0, most_a_side / std::max(posts.x, posts.y));
    return glm::max(glm::ivec2(2), glm::ivec2(glm::round(share * posts)));
}

/// The ground of a scene as a map of all cells, without light.
image::Image8 colour_of(const session::Session& seen, const scene::Scene& shown,
                        const WebArguments& arguments, FilesInUse& files) {
    scene::Scene scene = shown;
    const glm::dvec2 posts(posts_of(seen.dem()->source->grid(), kMostSide));
    const glm::ivec2 size(posts * std::min(kEnlarged, kMostSide / std::max(posts.x, posts.y)));
    scene.width_px = size.x;
    scene.height_px = size.y;
    scene.ortho = true;
    scene.view = {};
    scene.stamps = {.legend = false};
    session::Session map(scene,
                         {.device = arguments.device,
                          .dem = seen.dem(),
                          .radiance = true,
                          .format = session::PictureFormat{.layers = {session::DataLayer::Albedo}}},
                         files);
    const image::Picture picture = map.make_picture();
    image::Image8 colour(scene.width_px, scene.height_px, 3);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < picture.layers.at(c).values.size(); ++i) {
            const double light = std::clamp<double>(picture.layers[c].values[i], 0, 1);
            colour.values[3 * i + c] =
                static_cast<std::uint8_t>(std::lround(255 * srgb_of_linear(light)));
        }
    return colour;
}

web::Look look_of(const session::Session& session) {
    const scene::Camera& camera = session.camera();
    const geo::LocalFrame& frame = session.ground().frame;
    const geo::Geodetic eye = frame.to_geodetic(camera.eye_m);
    const geo::Axes axes = frame.axes(eye.lat_rad, eye.lon_rad);
    const double east = glm::dot(camera.forward, axes.east);
    const double north = glm::dot(camera.forward, axes.north);
    const double up = std::clamp(glm::dot(camera.forward, axes.up), -1.0, 1.0);
    return {.eye = eye,
            .heading_deg = std::fmod(degrees(std::atan2(east, north)) + 360, 360),
            .pitch_deg = degrees(std::asin(up)),
            .fov_deg = degrees(camera.fov_y_rad)};
}

std::vector<std::string> credits_of(const session::Session& session, const scene::Scene& scene) {
    std::vector<std::string> credits;
    if (!scene.stamps.attribution_text.empty()) credits.push_back(scene.stamps.attribution_text);
    if (!session.climate_text().empty())
        credits.emplace_back("Ground colour: NASA (MODIS), NOAA, CHELSA, ERA5 (Copernicus)");
    credits.emplace_back(kGenerator);
    return credits;
}

/// What the page shows on its heights.
web::Content content_of(const WebArguments& arguments, const scene::Scene& given,
                        FilesInUse& files) {
    scene::Scene bare = given;
    bare.stamps = {.legend = given.stamps.legend};
    session::Session session(bare, {.device = arguments.device, .format = session::PictureFormat{}},
                             files);
    web::Content content;
    content.still = std::get<image::Image8>(session.make_picture().pixels);
    if (!session.shows_ground())
        failed("export web: the first view shows only sky; turn the camera");
    scene::Scene shown = session.scene();
    shown.time = {sun::to_iso(session.time()), "", given.time.zone};
    session::SceneTimes times;
    times.use(shown, session.dem());
    content.title =
        !given.stamps.title_text.empty()
            ? given.stamps.title_text
            : printable(std::filesystem::path(session.dem()->field.about.path).stem().string());
    content.generator = kGenerator;
    content.credits = credits_of(session, given);
    content.exaggeration = shown.exaggeration;
    content.exposure_ev = shown.exposure_ev;
    content.look = look_of(session);
    content.utc = session.time();
    content.zone = times.of(shown).zone;
    geo::Geodetic middle = session.dem()->source->grid().center();
    const dem::Statistics& heights = session.dem()->to_draw().about.statistics;
    middle.height_m = (heights.min_m + heights.max_m) / 2;
    content.refraction = session.refraction(middle);
    content.colour = colour_of(session, shown, arguments, files);
    return content;
}

/// As many posts as fit into so many bytes: all, or means.
web::PageGround ground_within(const dem::Source& source, const scene::Scene& scene,
                              double most_bytes) {
    constexpr double kClose = 0.95, kLeastSide = 16;
    const auto around = web::GroundAround::of(scene.dems, scene.dem, source.grid());
    const auto read = [&](double side) {
        return output::read_ground(source, scene.dem,
                                   {scene.holes, 1, posts_of(source.grid(), side), {}})
            .field;
    };
    dem::Heightfield ground = read(kMostSide);
    std::optional<web::FarHorizons> far;
    if (around) far = around->horizons(ground);
    const double most_side = std::max(ground.grid.columns(), ground.grid.rows());
    double side = most_side, share = most_bytes / web::bytes_of(ground);
    for (int tries = 0;; ++tries) {
        if (share < 1 || tries > 0) {
            side = std::min(most_side, side * std::sqrt(share) * 0.99);
            ground = read(side);
        }
        web::PageGround page = web::page_ground(ground, far ? &*far : nullptr);
        share = most_bytes / page.bytes();
        const bool is_close = side == most_side || share < 1 / kClose || tries >= 3;
        if (share >= 1 && is_close) return page;
        if (share < 1 && side < kLeastSide)  // what is left are horizons of the ground around
            bad_input("export web: --megabytes: leaves no room for heights; expected more");
    }
}

glm::ivec2 posts_of(const web::PageGround& ground) {
    return {ground.grid.columns(), ground.grid.rows()};
}

/// "means of 3600 x 3600 posts"; empty for a page with all posts of a DEM.
std::string means_text(const web::PageGround& ground, const dem::Grid& grid) {
    const glm::ivec2 all = posts_of(grid, kInfinity);
    return all == posts_of(ground) ? "" : fmt::format("means of {} x {} posts", all.x, all.y);
}

void print(const web::PageGround& ground, const dem::Grid& grid, std::size_t bytes) {
    const std::string means = means_text(ground, grid);
    fmt::print("posts       {} x {}{}\n", posts_of(ground).x, posts_of(ground).y,
               means.empty() ? "" : ", " + means);
    fmt::print("heights     within {:.2g} m of these\nsize        {:.2f} MB\n",
               ground.height_error_m, static_cast<double>(bytes) / kMegabyte);
}

/// Files of a web page: one, or three of a folder.
struct Outputs {
    OutputFile& page;
    OutputFile* data = nullptr;
    OutputFile* preview = nullptr;
};

constexpr const char *kDataName = "data.rlvw", *kPreviewName = "preview.jpg";

Outputs open_outputs(const WebArguments& arguments, FilesInUse& files) {
    const auto open = [&](const std::filesystem::path& path) -> OutputFile& {
        return files.open_output(path, arguments.overwrite, "-o");
    };
    if (!arguments.folder) return {open(arguments.path)};
    const std::filesystem::path folder = arguments.path;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        bad_input(
            fmt::format("-o: {}: cannot be made, {}", printable(arguments.path), error.message()));
    return {open(folder / "index.html"), &open(folder / kDataName), &open(folder / kPreviewName)};
}

/// @returns bytes of all files
std::size_t write(const Outputs& outputs, const web::Content& content,
                  const std::vector<std::byte>& data) {
    const std::string page = outputs.data ? web::page(content.title, {kDataName, kPreviewName})
                                          : web::page(content.title, data);
    outputs.page.write(page);
    if (!outputs.data) return page.size();
    const std::vector<std::byte> preview = web::still_jpeg(content);
    outputs.data->write(data);
    outputs.preview->write(preview);
    return page.size() + data.size() + preview.size();
}

void export_web(const WebArguments& arguments) {
    log::HeldNotices notices;
    if (!arguments.folder) arguments.check_ending();
    const scene::Scene scene = scene_of(arguments);
    FilesInUse files;
    if (!arguments.scene.file.empty()) files.add_input(arguments.scene.file, "the scene");
    if (!scene.weather_file.empty()) files.add_input(scene.weather_file, "the weather");
    dem::add_named(scene.dems, files);
    const dem::Source source = dem::Source::open(scene.dems, scene.dem);
    web::check_grid(source.grid());
    const Outputs outputs = open_outputs(arguments, files);
    dem::add_all(scene.dems, files);
    const double most_bytes = web::room_for_data(arguments.megabytes * kMegabyte);
    web::Content content = content_of(arguments, scene, files);
    const web::PageGround ground =
        ground_within(source, scene,
                      most_bytes - std::min(web::bytes_of(content) + kDescription_bytes,
                                            (1 - kShareOfHeights) * most_bytes));
    if (const std::string means = means_text(ground, source.grid()); !means.empty())
        content.credits.push_back("Heights: " + means);
    const std::size_t bytes = write(
        outputs, content, web::page_data(ground, content, static_cast<std::size_t>(most_bytes)));
    files.finish_outputs();
    notices.release();
    print(ground, source.grid(), bytes);
}

}  // namespace

void add_export_web(Verb export_verb) {
    const auto arguments = std::make_shared<WebArguments>();
    arguments->endings = {"html"};
    const Verb verb = export_verb.add_verb(
        "web", "Web page that shows the DEM with its light, offline, in a browser");
    arguments->exaggeration.add_to(verb);
    arguments->scene.add_to(verb);
    verb.add_option("-o,--output", arguments->path, "Web page to write, html").required();
    verb.add_flag("--overwrite", arguments->overwrite, "Replace an existing file");
    verb.add_option("--megabytes", arguments->megabytes,
                    "Most of a web page, 10^6 bytes; larger DEMs become means (2.5)")
        .check(in_range(0.3, 100));
    verb.add_flag("--folder", arguments->folder,
                  "-o names a folder for a server: index.html, its data, and a preview for links");
    verb.add_option("--device", arguments->device,
                    "GL device: auto, an index, software, or a part of its name");
    verb.callback([arguments] { export_web(*arguments); });
}

}  // namespace relevo::cli
