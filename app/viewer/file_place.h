#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dem/grid.h"
#include "session/session.h"
#include "viewer/file_kind.h"
#include "viewer/latest_work.h"

namespace relevo::viewer {

/// Where on a DEM what a file holds lies.
struct FilePlace {
    int parts = 0;                        ///< places, vertices of lines, or corners of an image
    std::vector<geo::Geodetic> on_dem{};  ///< those on the DEM, at height 0
    geo::Geodetic middle() const;         ///< of those. @pre not empty
};

/// @param kind  Places, Lines or Overlay
/// @throws Error (BadInput) as the reader of such a file
FilePlace place_of_file(FileKind kind, const std::string& path, const dem::Grid& dem);

/// "9 of 12 places are on the DEM, around 3.4 km SSW of the DEM's middle", "outside the DEM".
std::string words_of(const FilePlace& place, FileKind kind, const dem::Grid& dem);

/// Files of layers on a DEM.
struct LayerFiles {
    std::shared_ptr<const session::LoadedDem> dem;
    std::vector<std::pair<FileKind, std::string>> files;

    bool operator==(const LayerFiles&) const = default;
};
struct FilesOutside {
    LayerFiles of;
    std::set<std::string> files{};  ///< of which nothing is on the DEM
};

/// Finds files that do not lie on the DEM, on a thread of its own.
class OutsideWork : public LatestWork<LayerFiles, FilesOutside> {
  public:
    /// @param on_change  called on that thread
    explicit OutsideWork(std::function<void()> on_change);
    ~OutsideWork() override { end(); }

  private:
    void work_out(const LayerFiles* wanted) override;
};

}  // namespace relevo::viewer
