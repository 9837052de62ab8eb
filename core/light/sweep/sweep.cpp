#include "light/sweep/sweep.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/parallel_for.h"
#include "light/sweep/horizon_strip.h"
#include "light/sweep/lines.h"
#include "light/sweep/runs.h"
#include "light/sweep/shadow_strip.h"
#include "light/sweep/shadow_tables.h"

namespace relevo::light {
namespace {

constexpr double kSteepest = 1e4;  // tangent: 0.006 degrees from the zenith
constexpr int kReadRows = 256;     // that are read together

Window transposed(const Window& w) {
    return {w.row, w.column, w.rows, w.columns};
}
glm::dvec2 transposed(const glm::dvec2& v) {
    return {v.y, v.x};
}

/// A ray as it goes over a sheet.
Ray on_sheet(Ray ray, const Orientation& sheet) {
    glm::dvec2* const all[] = {&ray.reference, &ray.first, &ray.second, &ray.third};
    if (sheet.transposed)
        for (glm::dvec2* const each : all)
            *each = transposed(*each);
    if (!sheet.mirrored) return ray;
    ray.reference.y = sheet.rows - 1 - ray.reference.y;
    for (glm::dvec2* const each : {&ray.first, &ray.second, &ray.third})
        each->y = -each->y;
    return ray;
}

SweepSun on_sheet(SweepSun sun, const Orientation& sheet) {
    // About a post, so that one line goes through posts.
    const glm::dvec2 post =
        glm::dvec2(std::round(sun.ray.reference.x), std::round(sun.ray.reference.y));
    sun.tangent = sun.tangent_at(post.x, post.y);
    sun.ray.reference = post;
    sun.ray = on_sheet(sun.ray, sheet);
    if (sheet.transposed) sun.tangent_per_post = transposed(sun.tangent_per_post);
    if (sheet.mirrored) sun.tangent_per_post.y = -sun.tangent_per_post.y;
    return sun;
}

/// The first column on a ray or after it, for each row of a window; none where it turns back.
std::optional<std::vector<int>> first_columns(const Ray& ray, const Window& window) {
    std::vector<int> first;
    first.reserve(static_cast<std::size_t>(window.rows));
    for (const double distance_m : ray.distances_m(window.row, window.end_row())) {
        const double column = ray.reference.x + ray.way(distance_m).x;
        if (std::isnan(column)) return std::nullopt;
        first.push_back(static_cast<int>(
            std::ceil(std::clamp(column, double(window.column), double(window.end_column())))));
    }
    return first;
}

/// Of each row of a window on a sheet; none where rays turn back.
std::optional<std::vector<ColumnRange>> column_ranges(const Window& window,
                                                      const std::optional<Ray>& after,
                                                      const std::optional<Ray>& before) {
    std::vector<ColumnRange> ranges(static_cast<std::size_t>(window.rows),
                                    {window.column, window.end_column()});
    const auto set = [&](const std::optional<Ray>& ray, int ColumnRange::*end) {
        if (!ray) return true;
        const std::optional<std::vector<int>> first = first_columns(*ray, window);
        for (std::size_t i = 0; first && i < ranges.size(); ++i)
            ranges[i].*end = (*first)[i];
        return first.has_value();
    };
    if (!set(after, &ColumnRange::begin) || !set(before, &ColumnRange::end)) return std::nullopt;
    return ranges;
}

/// A sun of a tangent that floats express.
SweepSun bounded(SweepSun sun) {
    if (std::abs(sun.tangent) < kSteepest) return sun;
    sun.tangent = std::copysign(kSteepest, sun.tangent);
    sun.tangent_per_post = {0, 0};
    return sun;
}

void check_reaches(const SweepLines& lines, const SheetPosts& posts) {
    for (int row = posts.window.row; row < lines.begin(); ++row)
        if (!posts.at(row).is_empty())
            throw std::logic_error("sweep: the ray of a tile turns back within its posts");
}

/// Strips of lines, as many for every thread.
int width_of_strips(int lines, int most) {
    const int threads = std::min(thread_count(), std::max(1, lines / (4 * kVectorFloats)));
    const int least = (lines + most - 1) / most;
    const int strips = (least + threads - 1) / threads * threads;
    // With the line beside they are whole vectors.
    return std::min(most, in_vectors((lines + strips - 1) / strips + 1) - 1);
}

}  // namespace

/// What a sweep is asked for, on the sheet that it goes over.
struct Sweep::Job {
    Orientation orientation;
    Sheet sheet;  // without heights where these are read
    SweepSun sun;
    SheetPosts posts;
};

Sweep::Sweep(const float* height_m, int columns, int rows, std::ptrdiff_t stride)
    : height_m_(height_m),
      columns_(columns),
      rows_(rows),
      stride_(stride),
      lowest_m_(std::numeric_limits<float>::infinity()),
      highest_m_(-lowest_m_) {
    assert(columns > 0 && rows > 0);
    std::mutex mutex;
    parallel_for(0, rows, 64, [&](int first, int last) {
        float lowest_m = std::numeric_limits<float>::infinity(), highest_m = -lowest_m;
        for (int row = first; row < last; ++row)
            for (const float* h = height_m + row * stride; h < height_m + row * stride + columns;
                 ++h) {
                lowest_m = *h < lowest_m ? *h : lowest_m;
                highest_m = *h > highest_m ? *h : highest_m;
            }
        const std::lock_guard lock(mutex);
        lowest_m_ = std::min(lowest_m_, lowest_m);
        highest_m_ = std::max(highest_m_, highest_m);
    });
}

Sweep::Sweep(Read read, int columns, int rows, float lowest_m, float highest_m)
    : read_(std::move(read)),
      columns_(columns),
      rows_(rows),
      lowest_m_(lowest_m),
      highest_m_(highest_m) {
    assert(columns > 0 && rows > 0);
}

const float* Sweep::transposed() const {
    std::call_once(once_, [&] {
        transposed_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        constexpr int kBand = 64;
        parallel_for(0, (rows_ + kBand - 1) / kBand, 4, [&](int first, int last) {
            const int row = first * kBand;
            transpose(height_m_ + row * stride_, stride_, std::min(rows_, last * kBand) - row,
                      columns_, transposed_.data() + row, rows_);
        });
    });
    return transposed_.data();
}

/// A job without heights.
Sweep::Job Sweep::geometry(const SweepSun& sun, const TilePosts& posts) const {
    assert(common(posts.window, {0, 0, columns_, rows_}) == posts.window);
    Job job;
    job.orientation.transposed = sun.ray.along_columns;
    const bool turned = job.orientation.transposed;
    job.sheet =
        turned ? Sheet{nullptr, rows_, rows_, columns_} : Sheet{nullptr, stride_, columns_, rows_};
    job.orientation.rows = job.sheet.rows;
    job.orientation.mirrored = (turned ? sun.ray.first.x : sun.ray.first.y) > 0;
    job.sun = on_sheet(sun, job.orientation);
    job.posts.window = turned ? light::transposed(posts.window) : posts.window;
    if (job.orientation.mirrored)
        job.posts.window.row = job.sheet.rows - job.posts.window.end_row();
    const auto ray = [&](const std::optional<Ray>& of) {
        return of ? std::optional(on_sheet(*of, job.orientation)) : std::nullopt;
    };
    if (posts.after || posts.before)
        job.posts.ranges =
            column_ranges(job.posts.window, ray(posts.after), ray(posts.before)).value();
    return job;
}

Sweep::Job Sweep::job_for(const SweepSun& sun, const TilePosts& posts) const {
    Job job = geometry(sun, posts);
    if (read_) return job;
    job.sheet.first_m = job.orientation.transposed ? transposed() : height_m_;
    if (job.orientation.mirrored) {
        job.sheet.first_m += (job.sheet.rows - 1) * job.sheet.stride;
        job.sheet.stride = -job.sheet.stride;
    }
    return job;
}

/// Reads rows and columns of a sheet, so that it has them where it looks for them.
void Sweep::read(const Job& job, const Window& window, Sheet& sheet,
                 std::vector<float>& buffer) const {
    const auto [transposed, mirrored, sheet_rows] = job.orientation;
    const int line = mirrored ? sheet_rows - window.end_row() : window.row;
    const Window lines{window.column, line, window.columns, window.rows};
    Heights found{};
    if (transposed) {
        std::vector<float> columns;
        const Heights turned = read_(light::transposed(lines), columns);
        buffer.resize(static_cast<std::size_t>(window.columns) *
                      static_cast<std::size_t>(window.rows));
        transpose(turned.first_m, turned.stride, window.columns, window.rows, buffer.data(),
                  window.columns);
        found = {buffer.data(), window.columns};
    } else {
        found = read_(lines, buffer);
    }
    sheet = job.sheet;
    sheet.stride = mirrored ? -found.stride : found.stride;
    sheet.first_m = found.first_m + (mirrored ? (window.rows - 1) * found.stride : 0) -
                    (window.row * sheet.stride + window.column);
}

/// Has strips of lines go from the first row that matters to the last that is wanted. A strip says
/// how it samples ground (kSampling) and how many lines it takes at most (kMostLines); it is told
/// of every row by advance_to(), and asked for the posts of those that are wanted by find().
/// @param make  a strip of some lines, from one on
template <typename Strip, typename Make>
void Sweep::sweep_strips(const Job& job, double most_fall_m, const Make& make,
                         const Use& use) const {
    SweepLines lines(job.sheet, job.sun, job.posts, Strip::kSampling, most_fall_m);
    check_reaches(lines, job.posts);
    const int count = lines.lines().end - lines.lines().begin;
    if (count <= 0) return;
    const int width = width_of_strips(count, Strip::kMostLines);
    const int pitch = GroundRows::pitch(lines, width + 1);
    lines.find_crossings(pitch, GroundRows::kept(lines));
    parallel_for(0, (count + width - 1) / width, 1, [&](int begin, int end) {
        std::vector<float> buffer;
        Runs runs(job.orientation, use);
        for (int k = begin; k < end; ++k) {
            const int line = lines.lines().begin + k * width;
            Strip strip = make(lines, line, width);
            Sheet sheet = job.sheet;
            for (int row = lines.begin(); row < lines.end(); ++row) {
                if (read_ && (row - lines.begin()) % kReadRows == 0) {
                    const int last = std::min(row + kReadRows, lines.end());
                    ColumnRange columns{job.sheet.columns, 0};
                    for (int at = row; at < last; ++at) {
                        const int column = lines.row(at).ground_column + line;
                        columns = {std::min(columns.begin, column),
                                   std::max(columns.end, column + pitch)};
                    }
                    const Window wanted =
                        common({0, row, job.sheet.columns, last - row},
                               {columns.begin, row, columns.end - columns.begin, last - row});
                    if (!wanted.is_empty()) read(job, wanted, sheet, buffer);
                }
                strip.advance_to(row, sheet);
                if (row < job.posts.window.row) continue;
                const ColumnRange posts = job.posts.at(row);
                const int column = lines.row(row).column;
                const int from = std::max(line, posts.begin - column),
                          to = std::min(line + width, posts.end - column);
                if (from < to) runs.add(row, column + from, to - from, strip.find(row, from, to));
            }
            runs.finish();
        }
    });
}

double Sweep::most_fall_m(float floor_m) const {
    return std::max(0.0, double{highest_m_} - (floor_m > kNoFloor_m ? floor_m : lowest_m_));
}

void Sweep::each_shadow(const SweepSun& sun, const TilePosts& posts, float floor_m,
                        const Use& use) const {
    sweep_strips<ShadowStrip>(
        job_for(bounded(sun), posts), most_fall_m(floor_m),
        [&](const SweepLines& lines, int line, int count) {
            return ShadowStrip(lines, line, count, lowest_m_, floor_m);
        },
        use);
}

ShadowTables Sweep::shadow_tables(const SweepSun& sun, const TilePosts& posts,
                                  float floor_m) const {
    const Job job = geometry(bounded(sun), posts);
    SweepLines lines(job.sheet, job.sun, job.posts, ShadowStrip::kSampling, most_fall_m(floor_m));
    check_reaches(lines, job.posts);
    ShadowTables tables;
    tables.orientation = job.orientation;
    tables.columns = job.sheet.columns;
    tables.floor_m = floor_m;
    tables.fill(lines, job.posts, lowest_m_);
    return tables;
}

void Sweep::each_horizon(const Ray& ray, double curvature, double reach_m, const TilePosts& posts,
                         const Use& use) const {
    // Some windows have more ground beyond reach_m than others, all of it under this tangent: no
    // ray so low is looked at, so that figures are the same for every window.
    const double relief_m = std::max(0.0, double{highest_m_} - lowest_m_);
    const double across_m = reach_m * std::hypot(ray.first.x, ray.first.y);
    const double least = across_m > std::hypot(columns_, rows_)
                             ? -std::numeric_limits<double>::infinity()
                             : relief_m / reach_m - curvature * reach_m / 2;
    // What a ray of tangent 1 falls by is how far it goes.
    sweep_strips<HorizonStrip>(
        job_for({ray, 1, {0, 0}}, posts), reach_m,
        [&](const SweepLines& lines, int line, int count) {
            return HorizonStrip(lines, line, count, curvature, least);
        },
        use);
}

std::optional<std::pair<int, int>> range_of(const TilePosts& posts, int line, bool along_columns) {
    const Window w = along_columns ? transposed(posts.window) : posts.window;
    const auto first_on = [&](const std::optional<Ray>& of, int otherwise) {
        if (!of) return double(otherwise);
        const Ray ray = on_sheet(*of, {along_columns, false, 0});
        return std::ceil(std::clamp(ray.reference.x + ray.way(ray.distance_m(line)).x,
                                    double(w.column), double(w.end_column())));
    };
    const double begin = first_on(posts.after, w.column),
                 end = first_on(posts.before, w.end_column());
    if (!(begin <= end)) return std::nullopt;  // nor numbers
    return std::pair(static_cast<int>(begin), static_cast<int>(end));
}

}  // namespace relevo::light
