#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/sun_options.h"
#include "cli/sun_points.h"

/// What verbs of days at a place share: `sun day`, `sun eclipses`, `moon day`, and the horizons.
namespace relevo::cli {

/// DEM..., --at or --points, --date or a range, what rising means, and -o.
struct DayArguments {
    TerrainArguments terrain;
    PlaceArguments place;
    PointsArguments points;
    DaysArguments days;
    LightArguments light;
    OutputArguments output;

    /// All of them, with an optional DEM. `light.body` is to be set before.
    /// @param endings  of -o
    void add_to(Verb verb, const std::vector<std::string>& endings);
    report::View view() const { return terrain.view(place.eye_height_m, light.view()); }
};

/// What a verb has to say of the days at one place, in each of its forms.
struct DayForms {
    PointForms point;  ///< as of one of many points, too
    std::function<std::string()> csv;
    std::function<void()> print;
    std::function<chart::Drawing()> drawing = {};  ///< null if the verb draws nothing
};

/// Forms of a result of core/report.
/// @param terrain  whether there is a DEM
template <typename Result>
DayForms forms_of(const std::shared_ptr<const Result>& result, bool terrain,
                  std::vector<std::string> (*rows)(const Result&, bool holes),
                  std::string (*csv)(const Result&), void (*print)(const Result&)) {
    return {.point = {.rows = [=] { return rows(*result, terrain); },
                      .json = [=] { return nlohmann::ordered_json::parse(json_of(*result)); },
                      .doubt = result->doubt},
            .csv = [=] { return csv(*result); },
            .print = [=] { print(*result); }};
}

struct DayFigure {
    /// Columns of CSV for many points. @param terrain  whether there is a DEM
    std::function<std::string(bool terrain)> columns;
    std::vector<std::string> remarks;  ///< above the columns
    /// @param posts  null without a DEM; lives as long as the result
    std::function<DayForms(const report::Days&, const geo::PlaceText&, const dem::Posts* posts)>
        forms;
};

/// Computes a figure for --at or for all of --points, and delivers it.
void run_days(const DayArguments& arguments, const DayFigure& figure);

}  // namespace relevo::cli
