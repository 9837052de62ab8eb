#include "dem/sparse.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <vector>

#include "dem/gdal.h"

namespace relevo::dem {
namespace {

constexpr int kMaxCells = 256;  // each way
constexpr std::int64_t kManyPosts = std::int64_t{1} << 28;
/// Posts in a byte: what is stored more densely than this is not compressed heights.
constexpr double kDense = 16;
constexpr int kManySources = 64;  // GDAL compares a window with each of them

bool knows(GDALDatasetH dataset) {
    const std::string_view driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset));
    if (driver == "GTiff") return true;
    if (driver != "VRT") return false;
    char** const files = GDALGetFileList(dataset);
    const int count = CSLCount(files);
    CSLDestroy(files);
    return count <= kManySources;
}

}  // namespace

SparseMap::SparseMap(int columns, int rows)
    : columns_(columns),
      rows_(rows),
      stored_(std::min(columns, kMaxCells), std::min(rows, kMaxCells), std::uint8_t{1}) {}

int SparseMap::first_post(int cell, int cells, int posts) const {
    return static_cast<int>(std::int64_t{posts} * cell / cells);
}

int SparseMap::cell_of(int post, int cells, int posts) const {
    // The last cell that begins at the post or before it.
    return static_cast<int>(((std::int64_t{post} + 1) * cells - 1) / posts);
}

std::optional<SparseMap> SparseMap::of(GDALDatasetH dataset, GDALRasterBandH band,
                                       GDALRasterBandH mask, GDALRasterBandH alpha,
                                       std::uint64_t file_bytes) {
    const int columns = GDALGetRasterBandXSize(band), rows = GDALGetRasterBandYSize(band);
    const double posts = double(columns) * rows;
    if (posts < static_cast<double>(kManyPosts) ||
        posts < kDense * static_cast<double>(file_bytes) || !knows(dataset))
        return std::nullopt;
    SparseMap map(columns, rows);
    const auto empty_in = [](GDALRasterBandH one, const Window& w) {
        return !one || GDALGetDataCoverageStatus(one, w.column, w.row, w.columns, w.rows,
                                                 GDAL_DATA_COVERAGE_STATUS_DATA,
                                                 nullptr) == GDAL_DATA_COVERAGE_STATUS_EMPTY;
    };
    std::vector<Window> open{{0, 0, map.stored_.width(), map.stored_.height()}};
    while (!open.empty()) {
        const Window cells = open.back();
        open.pop_back();
        const int left = map.first_post(cells.column, map.stored_.width(), columns);
        const int top = map.first_post(cells.row, map.stored_.height(), rows);
        const Window posts_of{
            left, top,
            map.first_post(cells.column + cells.columns, map.stored_.width(), columns) - left,
            map.first_post(cells.row + cells.rows, map.stored_.height(), rows) - top};
        if (empty_in(band, posts_of) && empty_in(mask, posts_of) && empty_in(alpha, posts_of)) {
            for (int row = cells.row; row < cells.row + cells.rows; ++row)
                for (int column = cells.column; column < cells.column + cells.columns; ++column)
                    map.stored_.at(column, row) = 0;
        } else if (cells.columns > 1 || cells.rows > 1) {
            Window first = cells, second = cells;
            if (cells.columns >= cells.rows) {
                first.columns /= 2;
                second.column += first.columns;
                second.columns -= first.columns;
            } else {
                first.rows /= 2;
                second.row += first.rows;
                second.rows -= first.rows;
            }
            open.push_back(first);
            open.push_back(second);
        }
    }
    return map.empty_post() ? std::optional(map) : std::nullopt;
}

bool SparseMap::is_empty(const Window& window) const {
    return empty_rows(window) >= window.rows;
}

int SparseMap::empty_rows(const Window& window) const {
    const int first_column = cell_of(window.column, stored_.width(), columns_);
    const int last_column = cell_of(window.column + window.columns - 1, stored_.width(), columns_);
    int row = cell_of(window.row, stored_.height(), rows_);
    const auto is_stored = [&](int at) {
        const auto cells = stored_.row(at);
        return std::any_of(cells.begin() + first_column, cells.begin() + last_column + 1,
                           [](std::uint8_t one) { return one != 0; });
    };
    while (row < stored_.height() &&
           first_post(row, stored_.height(), rows_) < std::int64_t{window.row} + window.rows &&
           !is_stored(row))
        ++row;
    return std::clamp(first_post(row, stored_.height(), rows_) - window.row, 0, window.rows);
}

double SparseMap::stored_share() const {
    return std::accumulate(stored_.begin(), stored_.end(), 0.0) /
           static_cast<double>(stored_.size());
}

std::optional<glm::ivec2> SparseMap::empty_post() const {
    const auto found = std::ranges::find(stored_, std::uint8_t{0});
    if (found == stored_.end()) return std::nullopt;
    const auto index = static_cast<int>(found - stored_.begin());
    return glm::ivec2(first_post(index % stored_.width(), stored_.width(), columns_),
                      first_post(index / stored_.width(), stored_.height(), rows_));
}

}  // namespace relevo::dem
