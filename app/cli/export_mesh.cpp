#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/export.h"
#include "output/mesh_file.h"

namespace relevo::cli {
namespace {

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

void print(const output::MeshFile& file, double error_m) {
    const output::TerrainMesh& mesh = file.mesh;
    const glm::dvec3& size = file.size_m;
    fmt::print("triangles   {}, {} of them ground, for {} posts\n", mesh.surface.triangles(),
               mesh.ground_triangles, mesh.posts);
    fmt::print("error       worst {:.4g} m, mean {:.4g} m, allowed {:g} m\n", mesh.worst_m,
               mesh.mean_m, error_m);
    fmt::print("size        {:.1f} m east, {:.1f} m north, {:.1f} m up, {}\n", size.x, size.y,
               size.z, file.is_flat ? "flat, in the plane of the CRS" : "on the round Earth");
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
    output::MeshFileOptions options{.generator = kGenerator,
                                    .is_stl = arguments.shared.ending() == "stl"};
    output::TerrainMeshOptions& mesh = options.mesh;
    mesh.error_m = arguments.error_m;
    mesh.flat = arguments.flat;
    mesh.solid = !arguments.base.empty();
    if (mesh.solid) mesh.base_m = parse_base(arguments.base);
    if (mesh.base_m) *mesh.base_m *= ground.exaggeration;
    mesh.max_triangles = arguments.shared.dem.options().memory.posts * 4 / mesh::kBytesATriangle;
    if (!arguments.scale.empty()) options.mm_per_m = 1000 / parse_scale(arguments.scale);
    if (arguments.width_mm) options.width_mm = *arguments.width_mm;
    const output::MeshFile file =
        output::write_mesh(arguments.shared.file(), std::move(ground), options);
    files.finish_outputs();
    print(file, arguments.error_m);
    if (options.is_stl) {
        const glm::dvec3 size_mm = file.mm_per_m * file.size_m;
        fmt::print("model       1:{:.0f}, {:.1f} x {:.1f} x {:.1f} mm\n", 1000 / file.mm_per_m,
                   size_mm.x, size_mm.y, size_mm.z);
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
