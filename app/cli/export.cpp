#include "cli/export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/held_notices.h"
#include "cli/commands.h"
#include "dem/source.h"

namespace relevo::cli {

void ExportArguments::add_to(Verb verb, const std::vector<std::string>& endings_of_verb) {
    endings = endings_of_verb;
    dem.add_to(verb);
    verb.add_option("-o,--output", path, fmt::format("Result, {}", fmt::join(endings, ", ")))
        .required();
    verb.add_flag("--overwrite", overwrite, "Replace an existing file");
    exaggeration.add_to(verb, scene::option("--exaggerate"));
    holes.add_to(verb, scene::option("--holes"));
}

scene::Scene ExportArguments::scene() const {
    scene::Scene scene;
    holes.apply_to(scene);
    exaggeration.apply_to(scene);
    return scene;
}

void ExportArguments::open(FilesInUse& files, bool scale_file) {
    check_ending();
    if (scene().holes == dem::Holes::Mark)
        bad_usage("--holes: mark paints pictures, expected fill or cut");
    dem.add_named(files);
    file_ = &files.open_output(path, overwrite, "-o");
    if (scale_file) scale_file_ = &files.open_output(path + ".json", overwrite, "-o");
    dem.add_all(files);
}

output::ExportedGround ExportArguments::read(const std::optional<glm::ivec2>& size,
                                             const std::string& remedy) const {
    const log::HeldNotices notices;
    const dem::LoadOptions how = dem.options();
    const scene::Scene shown = scene();
    return output::read_ground(dem::Source::open(dem.paths, how), how,
                               {shown.holes, shown.exaggeration, size, remedy});
}

void add_export(Verb app) {
    const Verb verb =
        app.add_verb("export", "Heightmaps, normal maps, meshes and web pages for other programs");
    verb.require_verb(1);
    add_export_heightmap(verb);
    add_export_normals(verb);
    add_export_mesh(verb);
    add_export_web(verb);
}

}  // namespace relevo::cli
