#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "geo/geodetic.h"
#include "light/plane/plane_light.h"
#include "light/point/doubt.h"
#include "sun/zone.h"

/// What `relevo sun plane` says of one place, in each of its forms.
namespace relevo::cli {

struct PlaneTable {
    geo::Geodetic place;
    light::Plane plane;
    sun::Zone zone;
    std::string assumption;          ///< of the zone; empty where none was made
    std::optional<light::SumBy> by;  ///< none: a row for each hour
    bool typical = false;            ///< months of different years
    std::vector<light::PlaneHour> hours;
    /// What the figures mean: key of the JSON and text.
    std::vector<std::pair<std::string, std::string>> remarks;
    light::Doubt doubt;
};

/// Names of the columns, with commas.
std::string plane_columns(const std::optional<light::SumBy>& by);
/// Rows of CSV, without line ends. Numbers have eight digits.
std::vector<std::string> plane_rows(const PlaneTable& table);
std::string plane_csv(const PlaneTable& table);
nlohmann::ordered_json plane_json(const PlaneTable& table);

}  // namespace relevo::cli
