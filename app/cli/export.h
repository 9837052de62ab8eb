#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "cli/shared.h"
#include "cli/verb.h"
#include "output/exported_ground.h"

/// What the verbs under `relevo export` share.
namespace relevo::cli {

/// DEM..., -o, --overwrite, --holes, --exaggerate.
struct ExportArguments : ResultArguments {
    DemArguments dem;
    OptionArguments holes, exaggeration;

    void add_to(Verb verb, const std::vector<std::string>& endings_of_verb);
    /// Opens the result, before any work is done.
    /// @param scale_file  whether a JSON file with the scale is opened too
    /// @throws Error (Usage) for an unknown ending and --holes mark, and as FilesInUse
    void open(FilesInUse& files, bool scale_file);
    /// @param size    as output::ExportOptions
    /// @param remedy  as output::ExportOptions
    /// @throws Error as output::read_ground()
    output::ExportedGround read(const std::optional<glm::ivec2>& size,
                                const std::string& remedy) const;

    OutputFile& file() const { return *file_; }
    OutputFile& scale_file() const { return *scale_file_; }

  private:
    scene::Scene scene() const;

    OutputFile* file_ = nullptr;  // of the FilesInUse
    OutputFile* scale_file_ = nullptr;
};

/// "Relevo 0.1.0"
inline constexpr const char* kGenerator = "Relevo " RELEVO_VERSION;

void add_export_heightmap(Verb export_verb);
void add_export_normals(Verb export_verb);
void add_export_mesh(Verb export_verb);
void add_export_web(Verb export_verb);

}  // namespace relevo::cli
