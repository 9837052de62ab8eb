#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/export.h"
#include "mesh/write.h"
#include "output/export_text.h"
#include "output/terrain_mesh.h"

namespace relevo::cli {
namespace {

constexpr double kWidth_mm = 150;  // of a model that nothing else is said of

struct ExportMeshArguments {
    ExportArguments shared;
    double error_m = 1;
    bool flat = false;
    std::string base, scale;
    std::optional<double> width_mm;
};

/// The N of "1:N". @throws Error (Usage)
double parse_scale(const std::string& text) {
    const auto number = text.starts_with("1:") ? parse_number(text.substr(2)) : std::nullopt;
    if (!number || !(*number > 0))
        bad_usage(fmt::format("--scale: expected 1:N such as 1:25000 but got {}", text));
    return *number;
}

/// The height of --base; none: auto. @throws Error (Usage)
std::optional<double> parse_base(const std::string& text) {
    const std::optional<double> height_m = parse_number(text);
    if (!height_m && text != "auto")
        bad_usage(fmt::format("--base: expected a height in metres or auto but got {}", text));
    return height_m;
}

void check(const ExportMeshArguments& arguments) {
    const bool sized = arguments.width_mm || !arguments.scale.empty();
    if (!arguments.scale.empty()) parse_scale(arguments.scale);
    if (!arguments.base.empty()) parse_base(arguments.base);
    if (sized && arguments.shared.ending() != "stl")
        bad_usage("--scale and --width-mm need a .stl; .glb is in metres of the ground");
    if (arguments.width_mm && !arguments.scale.empty())
        bad_usage("--scale and --width-mm exclude each other; use one");
}

struct Box {
    glm::dvec3 low, high;
    glm::dvec3 size() const { return high - low; }
};

Box box_of(const mesh::Surface& surface) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& position : surface.position_m) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    return {low, high};
}

/// Of the model, for a metre on the ground.
double mm_per_m(const ExportMeshArguments& arguments, const Box& box) {
    if (!arguments.scale.empty()) return 1000 / parse_scale(arguments.scale);
    return arguments.width_mm.value_or(kWidth_mm) / std::max(box.size().x, box.size().y);
}

void print(const output::TerrainMesh& mesh, const output::GroundFrame& frame, double error_m,
           const Box& box) {
    const glm::dvec3 size = box.size();
    fmt::print("triangles   {}, {} of them ground, for {} posts\n", mesh.surface.triangles(),
               mesh.ground_triangles, mesh.posts);
    fmt::print("error       worst {:.4g} m, mean {:.4g} m, allowed {:g} m\n", mesh.worst_m,
               mesh.mean_m, error_m);
    fmt::print("size        {:.1f} m east, {:.1f} m north, {:.1f} m up, {}\n", size.x, size.y,
               size.z, frame.is_flat() ? "flat, in the plane of the CRS" : "on the round Earth");
    if (mesh.base_m)
        fmt::print("solid       base at {:g} m, {:.6g} m3\n", *mesh.base_m,
                   mesh::volume_m3(mesh.surface));
    if (mesh.lone_posts + mesh.cut_posts > 0)
        fmt::print("excluded    {} posts next to voids\n", mesh.lone_posts + mesh.cut_posts);
}

void write(ExportMeshArguments& arguments) {
    check(arguments);
    FilesInUse files;
    arguments.shared.open(files, /*scale_file=*/false);
    output::ExportedGround ground = arguments.shared.read(std::nullopt, "");
    output::TerrainMeshOptions options;
    options.name = ground.field.about.path;
    options.error_m = arguments.error_m;
    options.solid = !arguments.base.empty();
    if (options.solid) options.base_m = parse_base(arguments.base);
    if (options.base_m) *options.base_m *= ground.exaggeration;
    options.max_triangles = arguments.shared.dem.options().memory.posts * 4 / mesh::kBytesATriangle;
    const output::GroundFrame frame(ground.field.grid, arguments.flat || options.solid);
    const output::TerrainMesh mesh =
        output::terrain_mesh(std::move(ground.field.height_m), ground.field.grid, frame, options);
    const Box box = box_of(mesh.surface);
    const std::string name =
        printable(std::filesystem::path(ground.field.about.path).stem().string());
    const bool is_stl = arguments.shared.ending() == "stl";
    const double scale = mm_per_m(arguments, box);
    if (is_stl)
        mesh::write_stl(arguments.shared.file(), mesh.surface,
                        fmt::format("{}: {}, 1:{:.6g}, mm", kGenerator, name, 1000 / scale), scale);
    else
        mesh::write_glb(arguments.shared.file(), mesh.surface,
                        {kGenerator, name,
                         output::mesh_json(ground, kGenerator, frame, mesh, arguments.error_m)});
    files.finish_outputs();
    print(mesh, frame, arguments.error_m, box);
    if (is_stl) {
        const glm::dvec3 size_mm = scale * box.size();
        fmt::print("model       1:{:.0f}, {:.1f} x {:.1f} x {:.1f} mm\n", 1000 / scale, size_mm.x,
                   size_mm.y, size_mm.z);
    }
}

}  // namespace

void add_export_mesh(Verb export_verb) {
    const auto arguments = std::make_shared<ExportMeshArguments>();
    const Verb verb = export_verb.add_verb(
        "mesh", "Triangles within a stated error: glTF, and solids for printing");
    arguments->shared.add_to(verb, {"glb", "stl"});
    verb.add_option("--error", arguments->error_m,
                    "No post is farther above or below the mesh, metres (1)")
        .check(in_range(0.001, 10000.0));
    verb.add_flag("--flat", arguments->flat,
                  "Plane of the DEM's CRS instead of the round Earth about the DEM's centre");
    verb.add_option("--base", arguments->base,
                    "Solid with walls and a flat bottom at a height in metres, or auto; implies "
                    "--flat");
    verb.add_option("--scale", arguments->scale, "Of a .stl, in millimetres: 1:25000");
    verb.add_option("--width-mm", arguments->width_mm,
                    "Longer side of a .stl, millimetres; default: 150")
        .check(in_range(1.0, 100000.0));
    verb.callback([arguments] { write(*arguments); });
}

}  // namespace relevo::cli
