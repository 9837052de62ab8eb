#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dem/source.h"
#include "image/image.h"
#include "viewer/crs_suggestions.h"
#include "viewer/latest_work.h"

namespace relevo::viewer {

struct PreviewWanted {
    std::vector<std::string> files;
    dem::LoadOptions options;
    int side_px = 0;    ///< of the longer side of the picture
    RecentDem other{};  ///< as suggest_crs()
};

/// A DEM as the options have it read.
struct Preview {
    PreviewWanted of;
    image::Image8 picture;  ///< shaded relief, RGBA, north up; empty: `error`
    std::string text;       ///< size, place, heights, assumptions, in lines
    std::string error;
    std::vector<CrsSuggestion> suggestions{};  ///< where a CRS is all that it lacks
};

/// Reads a DEM and shades it. @param wanted  files that exist
std::shared_ptr<const Preview> preview_of(const PreviewWanted& wanted);

/// The same on a thread of its own.
class PreviewWork : public LatestWork<PreviewWanted, Preview> {
  public:
    /// @param on_change  called on that thread
    explicit PreviewWork(std::function<void()> on_change);
    ~PreviewWork() override { end(); }

  protected:
    void work_out(const PreviewWanted* wanted) override;
};

}  // namespace relevo::viewer
