#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "film/film.h"
#include "scene/job.h"
#include "session/scene_times.h"

namespace relevo::session {

struct FilmOptions {
    std::string device = "auto";  ///< as gl::Context
    bool overwrite = false;
    bool allow_blank = false;  ///< also writes a film none of whose frames shows ground
    film::Settings settings;
    std::string comment;  ///< that the file carries
    /// Called with the number of frames that are drawn. What it throws ends the film, of which then
    /// no file is left.
    std::function<void(std::size_t)> drawn = [](std::size_t) {};
};

/// What became of a film.
struct FilmReport {
    std::size_t blank = 0;                 ///< frames that show no ground of the DEM
    std::size_t first_blank = 0;           ///< from 1
    std::vector<std::string> stamp_notes;  ///< on stamps that the first frame omits
};

/// Draws shots as the frames of one film, which is encoded on a thread of its own while the next
/// frames are drawn. The file appears complete or not at all.
/// @param shots  settled, at least one, all of one size and one output
/// @throws Error as Session's constructor and film::Film, and (Failed) for a frame that cannot be
///     drawn, with its number, and if no frame shows ground
FilmReport draw_film(const std::vector<scene::Shot>& shots, const FilmOptions& options,
                     SceneTimes& times, FilesInUse& files);

}  // namespace relevo::session
