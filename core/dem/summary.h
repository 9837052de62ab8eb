#pragma once

#include <string>
#include <vector>

#include "dem/heightfield.h"
#include "dem/source.h"
#include "dem/spikes.h"

namespace relevo::dem {

/// What `relevo info` says about a DEM.
struct Summary {
    std::string path;
    std::vector<std::string> files;  ///< more than one: they are joined
    TileReport tiles;                ///< of indexes
    std::string driver;              ///< GDAL's short name
    std::string data_type;           ///< "Int16"
    int columns = 0;
    int rows = 0;
    std::string crs;       ///< what `--crs` takes to mean the same: a code, else WKT
    std::string crs_name;  ///< for people
    geo::Geodetic center;
    std::string utm;              ///< geo::utm_text() of the centre
    std::string mgrs;             ///< geo::mgrs_text() of the centre
    glm::dvec2 extent_m{};        ///< Grid::extent_m(): east, north
    glm::dvec2 sides_m{};         ///< Grid::sides_m(): along rows, along columns
    double row_azimuth_rad = 0;   ///< Grid::row_azimuth_rad()
    glm::dvec2 post_spacing_m{};  ///< Grid::post_spacing_m(): x, y
    float min_m = 0;
    float max_m = 0;
    double nodata_share = 0;  ///< posts without a height, 0 to 1
    std::optional<double> nodata;
    std::string nodata_text;            ///< in as many digits as the file's type has
    std::vector<std::string> holes_by;  ///< Description::holes_by
    int alpha_band = 0;                 ///< Description::alpha_band
    std::int64_t outliers = 0;
    Spikes spikes;
    std::optional<geo::Geodetic> worst_spike;  ///< where, with its height
    std::string unit;                          ///< of the heights in the file: "m", "ft", "us-ft"
    std::string unit_source;                   ///< "option", "band", "vertical crs", "assumed"
    std::string vertical_datum;
    int band = 1;
    int bands = 1;
    std::vector<std::string> assumptions;
};

/// Of all posts of a DEM, whatever part of them memory holds. Says what looks wrong with log::info.
/// @param max_posts  that memory has room for
/// @throws Error (BadInput) where the file is damaged, and where not one post has a height
Summary summarize(const Source& source, std::int64_t max_posts);

/// Of the posts of a field.
Summary summarize(const Heightfield& field);

/// The object of `relevo info --json`, two blanks a level, no line end after it. Keys
/// (docs/cli.md): path, files (the first hundred), file_count, tiles {count, missing,
/// missing_names, broken, broken_names, differing, differing_names, stepped, stepped_names},
/// driver, data_type, size [columns, rows], crs, crs_name, center {lat_deg, lon_deg}, utm, mgrs,
/// extent_m [east, north], side_m [x, y], row_azimuth_deg, post_spacing_m [x, y], elevation_m {min,
/// max}, nodata_share, nodata, nodata_text, holes_by [text], outliers, spikes {count, limit_m,
/// worst}, unit, unit_source, vertical_datum, band, bands, assumptions [text]. Unknown ones are
/// null.
std::string to_json(const Summary& summary);

/// The same in lines for people, a line end after each.
std::string to_text(const Summary& summary);

}  // namespace relevo::dem
