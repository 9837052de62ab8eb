#include "dem/resample.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dem/places_over.h"

namespace relevo::dem {
namespace {

bool is_in_cells(const glm::dvec2& at, const glm::ivec2& raster) {
    return at.x >= -0.5 && at.y >= -0.5 && at.x <= raster.x - 0.5 && at.y <= raster.y - 0.5;
}

/// Points from which PlacesOver interpolates between the same ones, whatever the window.
PointsOver points_around(const Window& window) {
    constexpr int kNet = PlacesOver::kNet;
    const glm::ivec2 first(window.column / kNet * kNet, window.row / kNet * kNet);
    return {.first_post = first,
            .count = glm::ivec2(window.end_column(), window.end_row()) - first};
}

class Resampler {
  public:
    Resampler(const Piece& piece, const Window& window, const ReadPosts& read, float* height_m)
        : on_(*piece.resampling),
          own_(piece.grid),
          raster_(own_.columns(), own_.rows()),
          window_(window),
          read_(read),
          height_m_(height_m),
          points_(points_around(window)) {
        if (!on_.shift) places_.emplace(on_.grid, own_, points_);
    }

    /// In halves where the raster has too many posts there.
    void read(const Window& part) const {
        constexpr std::int64_t kMostPosts = 1 << 20;
        const Window posts = posts_for(part);
        const bool is_one = part.columns == 1 && part.rows == 1;
        if (std::int64_t{posts.columns} * posts.rows > kMostPosts && !is_one) {
            Window first = part, second = part;
            if (part.columns > part.rows) {
                first.columns /= 2;
                second.column += first.columns;
                second.columns -= first.columns;
            } else {
                first.rows /= 2;
                second.row += first.rows;
                second.rows -= first.rows;
            }
            read(first);
            read(second);
            return;
        }
        std::vector<float> own(static_cast<std::size_t>(posts.columns) *
                               static_cast<std::size_t>(posts.rows));
        if (!own.empty()) read_(posts, own.data());
        for (int row = part.row; row < part.end_row(); ++row)
            for (int column = part.column; column < part.end_column(); ++column)
                height_m_[std::int64_t{row - window_.row} * window_.columns + column -
                          window_.column] =
                    tent_mean(place(column, row), on_.reach, posts, own.data(), raster_);
    }

  private:
    glm::dvec2 place(int column, int row) const {
        if (on_.shift)
            return own_.affine().inverse(on_.grid.affine()(column, row) +
                                         glm::dvec2(*on_.shift, 0));
        const glm::ivec2 first(points_.first_post);
        return (*places_)(column - first.x, row - first.y);
    }

    /// The posts that heights of a part are means of.
    Window posts_for(const Window& part) const {
        glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
        for (int row = part.row; row < part.end_row(); ++row)
            for (int column = part.column; column < part.end_column(); ++column) {
                const glm::dvec2 at = place(column, row);
                if (!is_in_cells(at, raster_)) continue;
                low = glm::min(low, at);
                high = glm::max(high, at);
            }
        if (!(low.x <= high.x)) return {};
        const glm::ivec2 first(glm::ceil(low - on_.reach)), last(glm::floor(high + on_.reach));
        return {first.x, first.y, last.x - first.x + 1, last.y - first.y + 1};
    }

    const Resampling& on_;
    const Grid& own_;
    glm::ivec2 raster_;
    Window window_;
    const ReadPosts& read_;
    float* height_m_;
    PointsOver points_;
    std::optional<PlacesOver> places_;
};

}  // namespace

float tent_mean(const glm::dvec2& at, const glm::dvec2& reach, const Window& posts,
                const float* height_m, const glm::ivec2& raster) {
    if (!is_in_cells(at, raster)) return kHole;
    const auto height = [&](int column, int row) {
        return height_m[std::int64_t{row - posts.row} * posts.columns + column - posts.column];
    };
    const glm::ivec2 nearest =
        glm::clamp(glm::ivec2(glm::floor(at + 0.5)), glm::ivec2(0), raster - 1);
    if (std::isnan(height(nearest.x, nearest.y))) return kHole;
    const glm::ivec2 first(glm::ceil(at - reach)), last(glm::floor(at + reach));
    const glm::dvec2 per_post = 1.0 / reach;
    double sum = 0, weights = 0;
    for (int row = first.y; row <= last.y; ++row) {
        const double of_row = 1 - std::abs(row - at.y) * per_post.y;
        for (int column = first.x; column <= last.x; ++column) {
            const double weight = of_row * (1 - std::abs(column - at.x) * per_post.x);
            const float h = height(column, row);
            if (!(weight > 0) || std::isnan(h)) continue;
            sum += weight * double{h};
            weights += weight;
        }
    }
    return static_cast<float>(sum / weights);
}

void resample(const Piece& piece, const Window& window, const ReadPosts& read, float* height_m) {
    Resampler(piece, window, read, height_m).read(window);
}

}  // namespace relevo::dem
