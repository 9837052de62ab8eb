#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files_in_use.h"
#include "cli/sun_options.h"
#include "dem/places.h"

/// A verb under `relevo sun` for every point of a file.
namespace relevo::cli {

/// --points and --points-crs, where --at may be left out for them.
struct PointsArguments {
    std::string path, crs;

    /// @param verb  that has --at
    void add_to(Verb verb);
    /// They are asked for, instead of --at. @throws Error (Usage) where neither is
    bool given() const;
    /// Reads the file, which no output may replace. To be called before the DEM is opened: a DEM
    /// from the net opens the net to all that GDAL reads.
    /// @throws Error (Usage) for a drawing as result, (BadInput) as dem::read_points
    std::vector<dem::NamedPlace> read(FilesInUse& files, const OutputArguments& output) const;

  private:
    Option at_;
};

/// What a verb has to say of one point, in the forms that it has for --at; each is made only where
/// it is asked for, on the thread that made this.
struct PointForms {
    std::function<std::vector<std::string>()> rows;  ///< of its CSV, without line ends
    std::function<nlohmann::ordered_json()> json;
    light::Doubt doubt;
};

/// What a verb does for many points.
struct PointsJob {
    std::string columns;               ///< of its CSV
    std::vector<std::string> remarks;  ///< on top of it
    /// Called on several threads. An Error (BadInput) is that point's own.
    std::function<PointForms(const dem::NamedPlace&)> forms;
};

/// One record for each point, in the order of the file: an array of JSON, or CSV whose rows begin
/// with `name,at_lat_deg,at_lon_deg` and end with `error`; on all processors, written as it comes.
/// CSV on standard output where no form is asked for.
/// @param zone_by_place  days or times are counted by the clocks of each point, which is said
/// @throws Error (BadInput) once all is written, where points have no figures
void deliver_points(const PointsArguments& arguments, const std::vector<dem::NamedPlace>& points,
                    const PointsJob& job, const OutputArguments& output, const OpenResults& results,
                    bool zone_by_place);

}  // namespace relevo::cli
