#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "dem/grid.h"
#include "dem/unit.h"

namespace relevo::dem {

/// What the heights of a raster are like.
struct Statistics {
    float min_m = 0;         ///< the lowest valid height
    float max_m = 0;         ///< the highest valid height
    std::int64_t valid = 0;  ///< posts with a height; the rest are holes
    std::int64_t holes = 0;  ///< posts without
    std::int64_t outliers =
        0;  ///< heights that no place of the Earth has: below -11500, above 9000

    double nodata_share() const {
        return static_cast<double>(holes) / static_cast<double>(valid + holes);
    }
    /// Those of other posts besides.
    Statistics& operator+=(const Statistics& others);
    friend bool operator==(const Statistics&, const Statistics&) = default;
};

/// Whether some place of the Earth has a height: -11500 to 9000 m.
bool is_of_the_earth(double height_m);

/// Lowest, highest, holes (NaN) and outliers of a field; the range is 0 to 0 where nothing is
/// valid.
Statistics statistics(const Array2d<float>& height_m);
Statistics statistics(const Array2d<float>& height_m, const Window& window);

/// Of so many posts of one height, NaN for holes.
Statistics statistics(float height_m, std::int64_t posts);

/// The height in a cell of four posts, NaN where a hole takes part.
/// @param first_m  the first of them, the others beside it and `stride` further
/// @param u, v     0 to 1, along a row and from row to row
double bilinear_m(const float* first_m, std::ptrdiff_t stride, double u, double v);

/// Where the unit of the heights was found.
enum class UnitSource { Option, Band, VerticalCrs, Encoding, Assumed };

/// Tiles that are alike in something: how many, and the first few by name.
struct NamedTiles {
    std::int64_t count = 0;
    std::vector<std::string> first;

    void add(const std::string& name, std::size_t most) {
        if (first.size() < most) first.push_back(name);
        ++count;
    }
    /// "3 (a, b, c)", "4 (a, b, c, ...)"
    std::string text() const;
};

/// The tiles of indexes, as far as heights of them have been read.
struct TileReport {
    std::int64_t tiles = 0;   ///< of all indexes; 0: the DEM has none
    std::int64_t opened = 0;  ///< of them, with no fault
    NamedTiles missing;       ///< there is no such file; they are voids
    NamedTiles broken;     ///< "name (why)": they cannot be read, or not all of them; voids there
    NamedTiles differing;  ///< "name (in what)": unlike the tile that was opened first
    /// "name (by up to 12 m)": some of their heights are more than 1 m off those of a tile below
    NamedTiles stepped;

    bool has_voids() const { return missing.count + broken.count > 0; }
    bool has_faults() const { return has_voids() || differing.count + stepped.count > 0; }
};

/// What was read and what was assumed.
struct Description {
    std::string path;                ///< as it was given; of several files "a.tif and 3 more"
    std::vector<std::string> files;  ///< all of them, as they were given
    std::string driver;              ///< GDAL's short name: "GTiff", "SRTMHGT", "USGSDEM"
    std::string data_type;  ///< GDAL's name of what a cell is stored as: "Int16", "Float32"
    int band = 1;           ///< from 1
    int bands = 1;          ///< that the file has

    Unit unit;  ///< of the heights in the file, after scale and offset
    UnitSource unit_source = UnitSource::Assumed;
    bool has_several_units = false;  ///< of files that are joined; `unit` is that of the finest
    double scale = 1;                ///< height = (stored * scale + offset) in `unit`
    double offset = 0;               ///< in `unit`
    std::optional<double> nodata;    ///< the stored value that marks a hole, declared or given

    /// What marks holes besides NaN: "nodata" (declared), "option", "found" (undeclared),
    /// "encoding", "mask", "alpha".
    std::vector<std::string> holes_by;
    int alpha_band = 0;  ///< from 1, of that "alpha"

    /// `nodata` in as many digits as the file's type has: "-3.4028235e+38"; empty where none.
    std::string nodata_text() const;

    std::string joined;  ///< surroundings.h: how heights became the site's; empty: they are as read

    std::string vertical_datum;  ///< what heights are above, as the file says; empty: it does not

    /// Whole sentences, for people: every choice that the file did not make itself.
    std::vector<std::string> assumptions;
    /// Those among them that are guesses, which Source::open says with log::info.
    std::vector<std::string> guesses;
    /// Those that are probably mistakes, which Source::open says with log::warning.
    std::vector<std::string> warnings;

    TileReport tiles;       ///< Source::tiles() once the heights were loaded
    Statistics statistics;  ///< of the heights that were loaded; all zero before
};

/// Heights at the posts of a grid.
struct Heightfield {
    Array2d<float> height_m;  ///< metres, NaN for holes; row 0 is the first row of the file
    Grid grid;                ///< as many columns and rows
    Description about;
    int reduction = 1;  ///< posts of the file that a post here is the mean of, each way

    /// The height between posts, bilinear [m]; NaN outside of the grid and where a hole takes part.
    double height_at(double column, double row) const;

    /// The place of a post with its height, NaN at a hole. Heights are placed as ellipsoidal ones,
    /// whatever they are above.
    geo::Geodetic place(int column, int row) const;
};

}  // namespace relevo::dem
