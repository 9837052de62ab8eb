#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "base/files_in_use.h"
#include "base/output_file.h"
#include "image/image.h"
#include "output/georeference.h"
#include "session/session.h"

namespace relevo::session {

/// Where a session's picture lies; nullopt unless it is a map (scene::Scene::ortho).
std::optional<output::Georeference> georeference_of(const Session& session);

/// The files beside a scene's picture that say where it lies: output::georeference_files() of a
/// map, else none.
std::vector<std::filesystem::path> files_beside(const scene::Scene& scene,
                                                const std::filesystem::path& picture);

/// Warns of files that georeference another picture of this name, if the scene's is no map.
void warn_of_files_beside(const scene::Scene& scene, const std::filesystem::path& picture);

/// What the file of a picture has besides its pixels.
struct FileParts {
    std::optional<output::Georeference> where;       ///< of a map
    std::shared_ptr<const chart::PaperSheet> paper;  ///< of a pdf
};
FileParts file_parts_of(const Session& session);

/// Writes a picture to a file, all of it but finish().
/// @throws Error as image::write(), output::write_geotiff() and chart::write_pdf()
void write_picture(OutputFile& file, const image::Picture& picture, const image::Metadata& metadata,
                   const image::Encoding& encoding, const FileParts& parts);

/// Writes a session's picture to a file, all of it but finish().
/// @param picture  of Session::make_picture(); nullopt: it is too large for memory (needs_bands())
///     and is drawn here, band by band
/// @throws Error as write_picture() and Session::make_bands()
void write_picture(Session& session, const std::optional<image::Picture>& picture, OutputFile& file,
                   const image::Metadata& metadata, const image::Encoding& encoding);

/// Writes the files of files_beside(), all but finish(). @param beside  the same, open
void write_beside(const std::vector<OutputFile*>& beside, const output::Georeference& where);

}  // namespace relevo::session
