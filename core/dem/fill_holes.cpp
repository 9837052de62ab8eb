#include "dem/fill_holes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/vec2.hpp>

#include "base/error.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/grid.h"
#include "dem/membrane.h"
#include "dem/runs.h"

namespace relevo::dem {
namespace {

constexpr int kAround = 8;         // posts beside a hole that its heights are made of
constexpr int kNotch = 8;          // an edge is at least so many times as long as a notch in it
constexpr float kLevel_m = 1e-3f;  // that heights around water may differ
constexpr int kThin_posts = 3;     // ground is at least so wide

struct Hole {
    int west = std::numeric_limits<int>::max(), north = west, east = -1, south = -1;
    std::int64_t posts = 0;
    float lowest_m = std::numeric_limits<float>::infinity(), highest_m = -lowest_m;  // around it

    void add(const Run& run, const Array2d<float>& height_m) {
        west = std::min(west, run.first);
        east = std::max(east, run.last);
        north = std::min(north, run.row);
        south = std::max(south, run.row);
        posts += run.last - run.first + 1;
        for (int row = std::max(run.row - 1, 0);
             row <= std::min(run.row + 1, height_m.height() - 1); ++row) {
            const int aside = row == run.row ? 1 : 0;
            for (int column = std::max(run.first - aside, 0);
                 column <= std::min(run.last + aside, height_m.width() - 1); ++column) {
                const float h = height_m.at(column, row);
                if (h < lowest_m) lowest_m = h;
                if (h > highest_m) highest_m = h;
            }
        }
    }
    bool is_level() const { return highest_m - lowest_m <= kLevel_m; }
    bool is_enclosed(int columns, int rows) const {
        return posts > 0 && west > 0 && north > 0 && east < columns - 1 && south < rows - 1;
    }
    bool is_small() const {
        return east - west < kSmallHole_posts && south - north < kSmallHole_posts;
    }
    bool is_notch(int columns, int rows) const {
        const bool in_side = west == 0 || east == columns - 1;
        if (in_side == (north == 0 || south == rows - 1)) return false;
        const int length = in_side ? rows : columns;
        return is_small() && kNotch * (1 + (in_side ? south - north : east - west)) <= length;
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
            if (!hole.is_enclosed(columns, rows) || hole.is_small() || hole.is_level()) continue;
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
    const std::string dropped = dropped_posts == 0
                                    ? ""
                                    : fmt::format(", without {} {} of narrow ground", dropped_posts,
                                                  dropped_posts == 1 ? "post" : "posts");
    return fmt::format("voids: {:.3g} % of the DEM, {}{}",
                       share(filled_posts + covered_posts + cut_posts), fmt::join(parts, ", "),
                       dropped);
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

/// The posts that are in no square of kThin_posts posts a side that all have heights.
std::vector<glm::ivec2> thin_ground(const Array2d<float>& height_m) {
    const int columns = height_m.width(), rows = height_m.height();
    Array2d<std::uint8_t> wide(columns, rows, 0);
    std::vector<int> down(static_cast<std::size_t>(columns), 0);  // heights above each other
    for (int row = 0; row < rows; ++row) {
        int across = 0;
        for (int column = 0; column < columns; ++column) {
            int& here = down[static_cast<std::size_t>(column)];
            here = std::isnan(height_m.at(column, row)) ? 0 : here + 1;
            across = here < kThin_posts ? 0 : across + 1;
            if (across < kThin_posts) continue;
            for (int up = 0; up < kThin_posts; ++up)
                std::fill_n(&wide.at(column - kThin_posts + 1, row - up), kThin_posts, 1);
        }
    }
    std::vector<glm::ivec2> thin;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (!wide.at(column, row) && !std::isnan(height_m.at(column, row)))
                thin.emplace_back(column, row);
    return thin;
}

class Filling {
  public:
    Filling(const Array2d<float>& height_m, FilledHoles& result)
        : given_m_(height_m), result_(result) {}

    const Array2d<float>& heights() const {
        return result_.height_m.empty() ? given_m_ : result_.height_m;
    }

    /// Drops thin ground, unless it is much of the DEM.
    void drop_thin_ground() {
        const std::vector<glm::ivec2> thin = thin_ground(heights());
        if (thin.empty() || 10 * std::ssize(thin) > result_.posts - result_.cut_posts) return;
        begin();
        around_m_ = given_m_;
        for (const glm::ivec2& post : thin) {
            const bool was_void = std::isnan(given_m_.at(post.x, post.y));
            if (was_void) result_.filled.at(post.x, post.y) = 0;
            result_.filled_posts -= was_void;
            result_.cut_posts += was_void;
            result_.dropped_posts += !was_void;
            for (Array2d<float>* heights_m : {&result_.height_m, &around_m_})
                heights_m->at(post.x, post.y) = std::numeric_limits<float>::quiet_NaN();
        }
    }

    void fill(bool wide_too) {
        const Array2d<float>& around_m = around_m_.empty() ? given_m_ : around_m_;
        const int columns = given_m_.width(), rows = given_m_.height();
        Runs runs = runs_of_holes(heights());
        std::vector<Hole> found(static_cast<std::size_t>(runs.size()));
        std::vector<std::vector<Run>> runs_of(found.size());
        for (int i = 0; i < runs.size(); ++i) {
            const auto root = static_cast<std::size_t>(runs.root(i));
            found[root].add(runs.at(i), heights());
            runs_of[root].push_back(runs.at(i));
        }
        Cover cover(around_m, found);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const Hole& hole = found[i];
            if (!hole.is_enclosed(columns, rows) && !hole.is_notch(columns, rows)) continue;
            const bool small = hole.is_small();
            if (hole.is_level()) {
                take(runs_of[i], kFilled, [&](int, int) { return hole.lowest_m; });
            } else if (small) {
                const Window w = hole.window(columns, rows);
                const Array2d<float> own = filled_window(around_m, w);
                take(runs_of[i], kFilled,
                     [&](int column, int row) { return own.at(column - w.column, row - w.row); });
                result_.worked_posts += std::ssize(own);
            } else if (wide_too) {
                const Window w = cover.window(hole);
                const Array2d<float>& own = cover.heights(w);
                take(runs_of[i], kCovered,
                     [&](int column, int row) { return own.at(column - w.column, row - w.row); });
            }
        }
        result_.worked_posts += cover.worked_posts();
    }

  private:
    void begin() {
        if (result_.height_m.empty()) result_.height_m = given_m_;
    }

    template <typename HeightAt>
    void take(const std::vector<Run>& runs, std::uint8_t as, const HeightAt& height_at) {
        begin();
        if (result_.filled.empty())
            result_.filled = Array2d<std::uint8_t>(given_m_.width(), given_m_.height(), 0);
        for (const Run& run : runs)
            for (int column = run.first; column <= run.last; ++column) {
                result_.height_m.at(column, run.row) = height_at(column, run.row);
                result_.filled.at(column, run.row) = as;
                if (!std::isnan(given_m_.at(column, run.row))) continue;  // dropped
                ++(as == kFilled ? result_.filled_posts : result_.covered_posts);
                --result_.cut_posts;
            }
    }

    const Array2d<float>& given_m_;
    Array2d<float> around_m_;  // given without what was dropped; empty: nothing was
    FilledHoles& result_;
};

}  // namespace

FilledHoles fill_small_holes(const Array2d<float>& height_m, Holes holes, ThinGround thin) {
    FilledHoles result;
    result.posts = std::ssize(height_m);
    result.cut_posts =
        std::count_if(height_m.begin(), height_m.end(), [](float h) { return std::isnan(h); });
    Filling filling(height_m, result);
    const bool fills = holes != Holes::Cut && result.cut_posts > 0;
    if (fills) prepare_gdal();
    if (fills) filling.fill(/*wide_too=*/false);
    if (result.cut_posts > 0 && thin == ThinGround::Dropped) filling.drop_thin_ground();
    if (result.cut_posts > 0 && fills) filling.fill(/*wide_too=*/true);
    return result;
}

}  // namespace relevo::dem
