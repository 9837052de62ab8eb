#include "dem/fill_holes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/grid.h"
#include "dem/membrane.h"
#include "dem/runs.h"

namespace relevo::dem {
namespace {

constexpr int kAround = 8;  // posts beside a hole that its heights are made of

struct Hole {
    int west = std::numeric_limits<int>::max(), north = west, east = -1, south = -1;
    std::int64_t posts = 0;

    void add(const Run& run) {
        west = std::min(west, run.first);
        east = std::max(east, run.last);
        north = std::min(north, run.row);
        south = std::max(south, run.row);
        posts += run.last - run.first + 1;
    }
    bool is_enclosed(int columns, int rows) const {
        return posts > 0 && west > 0 && north > 0 && east < columns - 1 && south < rows - 1;
    }
    bool is_small() const {
        return east - west < kSmallHole_posts && south - north < kSmallHole_posts;
    }
    /// With the posts around it.
    Window window(int columns, int rows) const {
        const Window wide{west - kAround, north - kAround, east - west + 1 + 2 * kAround,
                          south - north + 1 + 2 * kAround};
        return common(wide, {0, 0, columns, rows});
    }
};

/// A window with a cover over all its holes.
Array2d<float> covered_window(const Array2d<float>& height_m, const Window& w) {
    Array2d<float> heights(w.columns, w.rows);
    for (int y = 0; y < w.rows; ++y)
        for (int x = 0; x < w.columns; ++x)
            heights.at(x, y) = height_m.at(w.column + x, w.row + y);
    span_membrane(heights);
    return heights;
}

/// The cover over wide voids, made window by window. Voids may lie within each other, as rings do:
/// where their windows are several times the DEM, all of it is covered at once.
class Cover {
  public:
    Cover(const Array2d<float>& height_m, const std::vector<Hole>& holes) : height_m_(height_m) {
        constexpr double kMostTimes = 4;
        const int columns = height_m.width(), rows = height_m.height();
        double posts = 0;
        for (const Hole& hole : holes) {
            if (!hole.is_enclosed(columns, rows) || hole.is_small()) continue;
            const Window window = hole.window(columns, rows);
            posts += double{1} * window.columns * window.rows;
        }
        at_once_ = posts > kMostTimes * static_cast<double>(std::ssize(height_m));
    }

    Window window(const Hole& hole) const {
        const int columns = height_m_.width(), rows = height_m_.height();
        return at_once_ ? Window{0, 0, columns, rows} : hole.window(columns, rows);
    }
    /// Valid until the next call.
    const Array2d<float>& heights(const Window& window) {
        if (window == made_ && !heights_.empty()) return heights_;
        heights_ = covered_window(height_m_, window);
        made_ = window;
        worked_posts_ += std::ssize(heights_);
        return heights_;
    }
    std::int64_t worked_posts() const { return worked_posts_; }

  private:
    const Array2d<float>& height_m_;
    bool at_once_ = false;
    Window made_;
    Array2d<float> heights_;
    std::int64_t worked_posts_ = 0;
};

/// A window with all its holes filled. @returns empty where GDAL has no memory
Array2d<float> filled_window(const Array2d<float>& height_m, const Window& w) {
    Array2d<float> heights(w.columns, w.rows);
    Array2d<std::uint8_t> valid(w.columns, w.rows);
    for (int y = 0; y < w.rows; ++y)
        for (int x = 0; x < w.columns; ++x) {
            const float h = height_m.at(w.column + x, w.row + y);
            valid.at(x, y) = std::isnan(h) ? 0 : 255;
            heights.at(x, y) = std::isnan(h) ? 0 : h;
        }
    const auto raster = [&](GDALDataType type, void* texels) {
        const GDALDatasetH dataset =
            GDALCreate(GDALGetDriverByName("MEM"), "", w.columns, w.rows, 1, type, nullptr);
        if (dataset && GDALRasterIO(GDALGetRasterBand(dataset, 1), GF_Write, 0, 0, w.columns,
                                    w.rows, texels, w.columns, w.rows, type, 0, 0) != CE_None)
            failed("voids: GDAL refuses a raster in memory");
        return dataset;
    };
    const GDALDatasetH to = raster(GDT_Float32, heights.data());
    const GDALDatasetH mask = raster(GDT_Byte, valid.data());
    constexpr int kSmoothed = 2;
    // By itself it makes three files on the disk for each void.
    GdalStrings in_memory;
    in_memory.set("TEMP_FILE_DRIVER", "MEM");
    const bool done =
        to && mask &&
        GDALFillNodata(GDALGetRasterBand(to, 1), GDALGetRasterBand(mask, 1), kSmallHole_posts, 0,
                       kSmoothed, in_memory.list(), nullptr, nullptr) == CE_None &&
        GDALRasterIO(GDALGetRasterBand(to, 1), GF_Read, 0, 0, w.columns, w.rows, heights.data(),
                     w.columns, w.rows, GDT_Float32, 0, 0) == CE_None;
    if (to) GDALClose(to);
    if (mask) GDALClose(mask);
    if (!done) failed("voids: GDAL cannot fill a void");
    return heights;
}

}  // namespace

std::string FilledHoles::text(Holes holes) const {
    if (filled_posts + covered_posts + cut_posts == 0) return "";
    const auto share = [&](std::int64_t some) {
        return 100 * static_cast<double>(some) / static_cast<double>(posts);
    };
    const bool several = (filled_posts > 0) + (covered_posts > 0) + (cut_posts > 0) > 1;
    const auto share_of = [&](std::int64_t some) {
        return several ? fmt::format("{:.3g} % ", share(some)) : std::string();
    };
    std::vector<std::string> parts;
    if (filled_posts > 0)
        parts.push_back(share_of(filled_posts) + "drawn filled" +
                        (holes == Holes::Mark ? " and painted" : " (--holes mark shows them)"));
    if (covered_posts > 0)
        parts.push_back(fmt::format("{}covered in grey{} (wider than {} posts)",
                                    share_of(covered_posts),
                                    holes == Holes::Mark ? " and painted" : "", kSmallHole_posts));
    if (cut_posts > 0)
        parts.push_back(share_of(cut_posts) + "cut out" +
                        (holes == Holes::Cut ? "" : " (at the edge)"));
    return fmt::format("voids: {:.3g} % of the DEM, {}",
                       share(filled_posts + covered_posts + cut_posts), fmt::join(parts, ", "));
}

namespace {

Runs runs_of_holes(const Array2d<float>& height_m) {
    Runs runs(height_m.height());
    for (int row = 0; row < height_m.height(); ++row) {
        runs.begin_row();
        const float* const h = height_m.row(row).data();
        for (int column = 0; column < height_m.width(); ++column) {
            if (!std::isnan(h[column])) continue;
            const int first = column;
            while (column + 1 < height_m.width() && std::isnan(h[column + 1]))
                ++column;
            runs.add(row, first, column, [](int) { return true; });
        }
    }
    return runs;
}

}  // namespace

FilledHoles fill_small_holes(const Array2d<float>& height_m, Holes holes) {
    const int columns = height_m.width(), rows = height_m.height();
    FilledHoles result;
    result.posts = std::ssize(height_m);
    Runs runs = runs_of_holes(height_m);
    std::vector<Hole> found(static_cast<std::size_t>(runs.size()));
    for (int i = 0; i < runs.size(); ++i) {
        found[static_cast<std::size_t>(runs.root(i))].add(runs.at(i));
        result.cut_posts += runs.at(i).last - runs.at(i).first + 1;
    }
    if (holes == Holes::Cut) return result;
    prepare_gdal();
    std::vector<std::vector<Run>> runs_of(found.size());
    for (int i = 0; i < runs.size(); ++i)
        if (found[static_cast<std::size_t>(runs.root(i))].is_enclosed(columns, rows))
            runs_of[static_cast<std::size_t>(runs.root(i))].push_back(runs.at(i));
    Cover cover(height_m, found);
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (runs_of[i].empty()) continue;
        const Hole& hole = found[i];
        if (result.filled.empty()) {
            result.height_m = height_m;
            result.filled = Array2d<std::uint8_t>(columns, rows, 0);
        }
        const bool small = hole.is_small();
        const Window window = small ? hole.window(columns, rows) : cover.window(hole);
        Array2d<float> own;
        if (small) own = filled_window(height_m, window);
        const Array2d<float>& filled = small ? own : cover.heights(window);
        for (const Run& run : runs_of[i])
            for (int column = run.first; column <= run.last; ++column) {
                result.height_m.at(column, run.row) =
                    filled.at(column - window.column, run.row - window.row);
                result.filled.at(column, run.row) = small ? kFilled : kCovered;
            }
        if (small) result.worked_posts += std::ssize(own);
        (small ? result.filled_posts : result.covered_posts) += hole.posts;
        result.cut_posts -= hole.posts;
    }
    result.worked_posts += cover.worked_posts();
    return result;
}

}  // namespace relevo::dem
