#include "light/sun_hours.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "base/wide_loops.h"
#include "light/horizons.h"
#include "light/irradiation.h"
#include "light/quick_math.h"
#include "light/sky.h"
#include "sun/position.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kDay_s = 86400, kHour_s = 3600;
constexpr float kOpen_m = 1e6F;            // margin where nothing of the DEM lies towards the sun
constexpr double kLow_rad = radians(1.5);  // a sun under that is near the horizon
constexpr int kFiner = 3;                  // as many steps there as one elsewhere
constexpr double kPeriodTolerance_rad = radians(0.1);  // of suns that are put together anyway
/// Between the azimuths of suns that are taken to stand in one direction, at most: three of them,
/// where they are 3 minutes apart.
constexpr double kOnePath_rad = radians(0.8);

/// Moments of a time, each with the sun.
struct Moments {
    std::vector<double> at_s;  // from the beginning
    std::vector<SunOverDem> suns;
    /// Half way from each to the next, and how far off the sun is then.
    std::vector<SunOverDem> middles{};
    std::vector<double> distances_au{};
};

SunOverDem sun_over(const sun::PositionTable& table, sun::Instant utc,
                    const sun::Observer& observer) {
    const glm::dvec3 direction = table.direction(utc, observer);
    return {sun::azimuth_of(direction), sun::elevation_of(direction), 0};
}

/// @param finer  of a step, where the sun is near the horizon of a plain: how far off what hides it
///     lies changes there with every minute, and margins are not linear
Moments moments(const DemSky& dem, sun::Instant begin, double length_s, double step_s, int finer) {
    const geo::Geodetic place = dem.grid().center();
    const double lowest_rad = dem.lowest_sun_rad();
    const sun::PositionTable table(begin, begin + length_s);
    const sun::Observer observer(place);
    const auto sun_at = [&](double at_s) { return sun_over(table, begin + at_s, observer); };
    const auto is_low = [&](const SunOverDem& sun) {
        return sun.elevation_rad > lowest_rad && sun.elevation_rad < kLow_rad;
    };
    Moments moments{{0}, {sun_at(0)}};
    const auto steps = static_cast<int>(std::ceil(length_s / step_s - 1e-9));
    for (int k = 1; k <= steps; ++k) {
        const double from_s = moments.at_s.back(), to_s = std::min(k * step_s, length_s);
        const int parts = is_low(moments.suns.back()) || is_low(sun_at(to_s)) ? finer : 1;
        for (int part = 1; part <= parts; ++part) {
            const double before_s = moments.at_s.back();
            moments.at_s.push_back(part == parts ? to_s : from_s + (to_s - from_s) * part / parts);
            moments.suns.push_back(sun_at(moments.at_s.back()));
            const double middle_s = (before_s + moments.at_s.back()) / 2;
            moments.middles.push_back(sun_at(middle_s));
            moments.distances_au.push_back(
                glm::length(table.vector_au(begin + middle_s, observer)));
        }
    }
    return moments;
}

// --- A few days: a sweep for every sun

/// What is known of the posts of a block so far, from the first of some suns on.
struct PostLight {
    TileValues margin_m;  // lit where no sun's sweep has looked
    TileValues lit_h, scratch;
    TileValues began_m, first_h, last_h, spells;  // with spells: margins at the first sun, ...
    std::optional<GroundForBeams> beams;

    /// Begins with other posts.
    void begin(const SweepWindow& window, bool along_columns, bool with_spells) {
        margin_m.cover(window, 1, along_columns);
        for (TileValues* const each : {&lit_h, &scratch})
            each->cover(window, 0, along_columns);
        const SweepWindow other = with_spells ? window : SweepWindow{};
        for (TileValues* const each : {&began_m, &spells})
            each->cover(other, 0, along_columns);
        for (TileValues* const each : {&first_h, &last_h})
            each->cover(other, kNaN, along_columns);
    }

    void turn(bool along_columns) {
        for (TileValues* const each : {&margin_m, &scratch})
            each->turn(along_columns);
        turn_figures(along_columns);
    }
    /// But for what serves the sweeps alone.
    void turn_figures(bool along_columns) {
        for (TileValues* const each : {&lit_h, &began_m, &first_h, &last_h, &spells})
            each->turn(along_columns);
        if (spells.window().columns > 0) margin_m.turn(along_columns);
        if (beams) beams->turn(along_columns);
    }
};

/// From one moment to the next.
struct Step {
    double from_h, hours;
};

/// Margins now; a hole has none.
void measure(const SweepRun& run, float* margin_m) {
    for (int i = 0; i < run.count; ++i)
        margin_m[i] = std::min(run.height_m[i] - run.found[i], kOpen_m);
}

/// A moment: when the one before it was, how long ago, and edges of shadows.
struct LightAt {
    float from_h, hours;
    const float* edge_m;
};

/// Posts next to each other at moments one after the other, and what is known of them from the
/// moment before.
///
/// Margins are linear between two moments. Where light comes, the time of that is taken away from
/// the post's hours, and where it goes, it is added, so that hours are touched only where there is
/// a post at which it does either.
struct Light {
    std::span<const LightAt> moments;
    const float* height_m;
    float *margin_m, *lit_h;
};

[[gnu::always_inline]] inline void add_light_of_one(const Light& light, int i) {
    float before = light.margin_m[i];
    for (const LightAt& at : light.moments) {
        const float open = light.height_m[i] - at.edge_m[i];
        const float now = open > kOpen_m ? kOpen_m : open;
        if ((before >= 0) != (now >= 0)) {
            const float when_h = at.from_h + at.hours * (before / (before - now));
            light.lit_h[i] += now >= 0 ? -when_h : when_h;
        }
        before = now;
    }
    light.margin_m[i] = before;
}

constexpr int kPosts = 16;  // at once
using Numbers [[gnu::vector_size(kPosts * sizeof(float))]] = float;

[[gnu::always_inline]] inline void add_light_of_some(const Light& light, int i) {
    Numbers height, before;
    std::memcpy(&height, light.height_m + i, sizeof height);
    std::memcpy(&before, light.margin_m + i, sizeof before);
    auto changes = before != before;
    changes = changes ^ changes;
    for (const LightAt& at : light.moments) {
        Numbers edge;
        std::memcpy(&edge, at.edge_m + i, sizeof edge);
        Numbers now = height - edge;
        now = now > kOpen_m ? Numbers{} + kOpen_m : now;
        changes |= (before >= 0) ^ (now >= 0);
        before = now;
    }
    bool any = false;
    for (int k = 0; k < kPosts; ++k)
        any |= changes[k] != 0;
    if (any)
        for (int k = 0; k < kPosts; ++k)
            add_light_of_one(light, i + k);
    else
        std::memcpy(light.margin_m + i, &before, sizeof before);
}

[[gnu::always_inline]] inline void add_light_to_all(const Light& light, int count) {
    int i = 0;
    for (; i + kPosts <= count; i += kPosts)
        add_light_of_some(light, i);
    for (; i < count; ++i)
        add_light_of_one(light, i);
}

#if defined(__x86_64__)
/// As add_light_of_some(), which no compiler makes as fast.
[[gnu::target("avx512f")]] void add_light_512(const Light& light, int count) {
    const __m512 zero = _mm512_setzero_ps(), most = _mm512_set1_ps(kOpen_m);
    const LightAt *const first = light.moments.data(), *const end = first + light.moments.size();
    int i = 0;
    for (; i + kPosts <= count; i += kPosts) {
        const __m512 height = _mm512_loadu_ps(light.height_m + i);
        __m512 before = _mm512_loadu_ps(light.margin_m + i);
        __mmask16 was_lit = _mm512_cmp_ps_mask(before, zero, _CMP_GE_OQ);
        for (const LightAt* at = first; at < end; ++at) {
            const __m512 open = _mm512_sub_ps(height, _mm512_loadu_ps(at->edge_m + i));
            const __m512 now =
                _mm512_mask_mov_ps(open, _mm512_cmp_ps_mask(open, most, _CMP_GT_OQ), most);
            const __mmask16 is_lit = _mm512_cmp_ps_mask(now, zero, _CMP_GE_OQ);
            if (was_lit != is_lit) {
                const __m512 part = _mm512_div_ps(before, _mm512_sub_ps(before, now));
                const __m512 when_h = _mm512_add_ps(_mm512_set1_ps(at->from_h),
                                                    _mm512_mul_ps(_mm512_set1_ps(at->hours), part));
                __m512 lit_h = _mm512_loadu_ps(light.lit_h + i);
                lit_h = _mm512_mask_sub_ps(lit_h, static_cast<__mmask16>(is_lit & ~was_lit), lit_h,
                                           when_h);
                lit_h = _mm512_mask_add_ps(lit_h, static_cast<__mmask16>(was_lit & ~is_lit), lit_h,
                                           when_h);
                _mm512_storeu_ps(light.lit_h + i, lit_h);
            }
            before = now;
            was_lit = is_lit;
        }
        _mm512_storeu_ps(light.margin_m + i, before);
    }
    for (; i < count; ++i)
        add_light_of_one(light, i);
}
[[gnu::target("avx2")]] void add_light_256(const Light& light, int count) {
    add_light_to_all(light, count);
}
#endif

/// All ways have the same bits.
void add_light(const Light& light, int count) {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return add_light_512(light, count);
    if (__builtin_cpu_supports("avx2")) return add_light_256(light, count);
#endif
    add_light_to_all(light, count);
}

/// Posts that are lit at the last moment: what they have had of it so far.
RELEVO_WIDE_LOOPS void add_lit(float at_h, const float* margin_m, std::size_t count, float* lit_h) {
    for (std::size_t i = 0; i < count; ++i)
        lit_h[i] += margin_m[i] >= 0 ? at_h : 0;
}

/// Sums of figures, in whole ticks.
RELEVO_WIDE_LOOPS void add_ticks(const float* from, float ticks, int count, std::int32_t* to) {
    for (int i = 0; i < count; ++i) {
        const float sum = from[i] == from[i] ? from[i] : 0;  // a hole may have any
        to[i] += static_cast<std::int32_t>(sum * ticks + std::copysign(0.5F, sum));
    }
}

/// Where light comes or goes between two moments. Call before add_light().
void add_spells(const SweepRun& run, const Step& step, PostLight& posts) {
    const float* const margin_m = posts.margin_m.of(run);
    float *const first_h = posts.first_h.of(run), *const last_h = posts.last_h.of(run),
                 *const spells = posts.spells.of(run);
    for (int i = 0; i < run.count; ++i) {
        const float before = margin_m[i];
        const float now = std::min(run.height_m[i] - run.found[i], kOpen_m);
        if ((before >= 0) == (now >= 0)) continue;
        const auto when =
            static_cast<float>(step.from_h + step.hours * before / (double{before} - now));
        if (now >= 0) {
            if (std::isnan(first_h[i])) first_h[i] = when;
            ++spells[i];
        } else {
            last_h[i] = when;
        }
    }
}

/// The first moment, or the last one: posts that are lit then.
void add_end(const SweepRun& run, double at_h, bool is_first, PostLight& posts) {
    const float* const margin_m = posts.margin_m.of(run);
    float* const at = (is_first ? posts.first_h : posts.last_h).of(run);
    float* const spells = posts.spells.of(run);
    for (int i = 0; i < run.count; ++i) {
        if (!(margin_m[i] >= 0)) continue;
        at[i] = static_cast<float>(at_h);
        spells[i] += is_first;
    }
}

/// Suns one after the other, whose light is summed up together: those of one series are swept
/// alike. The last one is the first of the next series, unless night is between.
struct Series {
    std::size_t first, last;
    /// The last one, where it is not swept as its own way would have it but as the others.
    std::shared_ptr<const SunSky> turned = nullptr;
    /// Suns from one on, up to the next path's, that are taken to stand in one direction, each as
    /// high as it does: their rays are looked up once.
    struct Path {
        std::size_t first, end;
        SunSky sky;
    };
    std::vector<Path> paths{};
};

/// The sums of all series, which come in any order and from several threads: whole numbers, so that
/// the order changes no bit.
class Totals {
  public:
    /// @param result  whose figures are not there yet
    Totals(const SweepWindow& part, const std::vector<double>& at_h, SunHours& result)
        : part_(part), at_h_(at_h), result_(result), lit_(part.columns, part.rows, 0) {
        if (result.beam_kwh.size() > 0) beam_ = Array2d<std::int32_t>(part.columns, part.rows, 0);
        if (result.spells.size() == 0) return;
        for (float& spells : result.spells)
            spells = 0;
        for (auto* const each : {&ended_, &began_})
            each->resize(at_h.size());
    }

    void add(const Series& series, PostLight& posts) {
        posts.turn_figures(false);
        const bool spells = !began_.empty();
        if (spells) {
            const std::lock_guard lock(bits_mutex_);
            for (std::vector<std::uint8_t>* const bits :
                 {&began_[series.first], &ended_[series.last]})
                bits->resize(bytes_of_row() * static_cast<std::size_t>(part_.rows), 0);
        }
        each_chunk(posts.lit_h.window(), [&](int row, int column, int count) {
            const int from = column - posts.lit_h.window().column;
            add_whole(posts.lit_h.row(row) + from, kTicksOfHour, lit_, row, column, count);
            if (posts.beams)
                add_whole(posts.beams->beam_wh.row(row) + from, kTicksOfWh, beam_, row, column,
                          count);
            if (!spells) return;
            add_spells(posts, from, row, column, count);
            set_bits(posts.began_m.row(row) + from, began_[series.first], row, column, count);
            set_bits(posts.margin_m.row(row) + from, ended_[series.last], row, column, count);
        });
    }

    /// To be called once all is added.
    void finish() {
        for (std::size_t i = 0; i < lit_.size(); ++i)
            result_.hours.data()[i] = static_cast<float>(lit_.data()[i]) / kTicksOfHour;
        for (std::size_t i = 0; i < beam_.size(); ++i)
            result_.beam_kwh.data()[i] = static_cast<float>(beam_.data()[i]) / kTicksOfWh;
        for (std::size_t k = 0; k < began_.size(); ++k)
            if (!began_[k].empty() && !ended_[k].empty()) join(k);
    }

  private:
    static constexpr float kTicksOfHour = 1 << 24;  // 4 days are 1.6e9
    static constexpr float kTicksOfWh = 1 << 13;    // 4 days are less than 1e9

    /// Calls `use` with rows of posts, which no other thread looks at meanwhile.
    template <typename Use>
    void each_chunk(const SweepWindow& w, const Use& use) {
        constexpr int kRows = 64, kColumns = 256;
        const int end_row = w.row + w.rows, end = w.column + w.columns;
        for (int row = w.row, next_row = 0; row < end_row; row = next_row) {
            const int down = (row - part_.row) / kRows;
            next_row = std::min(end_row, part_.row + (down + 1) * kRows);
            for (int column = w.column, next = 0; column < end; column = next) {
                const int across = (column - part_.column) / kColumns;
                next = std::min(end, part_.column + (across + 1) * kColumns);
                const std::lock_guard lock(
                    mutexes_[static_cast<std::size_t>(down * 7 + across) % mutexes_.size()]);
                for (int at = row; at < next_row; ++at)
                    use(at, column, next - column);
            }
        }
    }

    void add_whole(const float* from, float ticks, Array2d<std::int32_t>& sums, int row, int column,
                   int count) const {
        add_ticks(from, ticks, count, &sums.at(column - part_.column, row - part_.row));
    }

    void add_spells(const PostLight& posts, int from, int row, int column, int count) const {
        const float *const first_h = posts.first_h.row(row) + from,
                           *const last_h = posts.last_h.row(row) + from,
                           *const spells = posts.spells.row(row) + from;
        for (int i = 0; i < count; ++i) {
            const int x = column - part_.column + i, y = row - part_.row;
            note(first_h[i], last_h[i], spells[i], x, y);
        }
    }

    void note(float first_h, float last_h, float spells, int x, int y) const {
        float &first = result_.first_h.at(x, y), &last = result_.last_h.at(x, y);
        if (!(first <= first_h) && first_h == first_h) first = first_h;
        if (!(last >= last_h) && last_h == last_h) last = last_h;
        result_.spells.at(x, y) += spells;
    }

    std::size_t bytes_of_row() const { return static_cast<std::size_t>(part_.columns + 7) / 8; }

    void set_bits(const float* margin_m, std::vector<std::uint8_t>& bits, int row, int column,
                  int count) const {
        std::uint8_t* const to =
            bits.data() + bytes_of_row() * static_cast<std::size_t>(row - part_.row);
        for (int i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(column - part_.column + i);
            if (margin_m[i] >= 0) to[at / 8] |= static_cast<std::uint8_t>(1U << at % 8);
        }
    }

    /// Posts that a series leaves lit and the next one finds in the shade at the same moment, or
    /// the other way: the two divide the DEM otherwise, or go over it another way.
    void join(std::size_t k) {
        const auto when_h = static_cast<float>(at_h_[k]);
        for (int y = 0; y < part_.rows; ++y)
            for (std::size_t byte = 0; byte < bytes_of_row(); ++byte) {
                const std::size_t i = bytes_of_row() * static_cast<std::size_t>(y) + byte;
                const unsigned differ = began_[k][i] ^ ended_[k][i];
                for (unsigned left = differ; left != 0; left &= left - 1) {
                    const int bit = __builtin_ctz(left), x = static_cast<int>(8 * byte) + bit;
                    if (began_[k][i] >> bit & 1U)
                        note(when_h, kNaN, 1, x, y);
                    else
                        note(kNaN, when_h, 0, x, y);
                }
            }
    }

    SweepWindow part_;
    const std::vector<double>& at_h_;
    SunHours& result_;
    Array2d<std::int32_t> lit_, beam_;
    std::array<std::mutex, 61> mutexes_;
    std::mutex bits_mutex_;
    /// With spells, of moments at which a series ends, or begins: a bit for each lit post.
    std::vector<std::vector<std::uint8_t>> ended_, began_;
};

class FewDays {
  public:
    FewDays(const DemSky& dem, const Sweep& sweep, const Moments& moments,
            const SunHoursOptions& options, const SweepWindow& part)
        : dem_(dem),
          sweep_(sweep),
          moments_(moments),
          spells_(options.spells),
          irradiation_(options.irradiation),
          part_(part) {
        for (const SunOverDem& sun : moments.suns)
            skies_.emplace_back(dem, sun);
        for (const SunSky& sky : skies_)
            night_.push_back(sky.is_night());
        for (const double at_s : moments.at_s)
            at_h_.push_back(at_s / kHour_s);
    }

    void light(SunHours& result, const std::function<void(double)>& done) const {
        std::optional<GroundForBeams> ground;
        if (irradiation_) ground.emplace(dem_, part_);
        const std::vector<Series> all_of_them = all_series();
        const Windows windows = all_windows(all_of_them);
        const std::vector<Work> works = shuffled(all_works(all_of_them, windows, result));
        double all = 0;
        for (const Work& work : works)
            all += work.cost;
        if (done) done(0);
        Totals totals(part_, at_h_, result);
        std::mutex mutex;
        std::atomic<std::size_t> next = 0;
        std::atomic<bool> stopped = false;
        parallel_for(0, thread_count(), 1, [&](int, int) {
            PostLight posts;  // one after the other: memory that is new takes time
            for (std::size_t i = next++; i < works.size() && !stopped; i = next++) {
                light_part(works[i], ground, posts, totals);
                const std::lock_guard lock(mutex);
                if (!done || stopped) continue;
                try {
                    done(works[i].cost / all);
                } catch (...) {
                    stopped = true;
                    throw;
                }
            }
        });
        totals.finish();
    }

  private:
    static constexpr std::size_t kTogether = 32;  // steps from sun to sun
    static constexpr int kWidest = 2048;          // posts across which suns are swept together
    /// How far off suns of one direction may be anywhere for what they share besides.
    static constexpr double kShared_rad = radians(0.02);

    /// Suns over a part of a window that is theirs.
    struct Work {
        Series series;
        const BandedWindow* window;
        SweepWindow part;
        double cost;  // in sweeps over all of a post's rays, more or less
    };

    /// One of the suns of a series over a tile.
    struct TileSun {
        std::size_t k;
        TileEdges edges;
        std::optional<SunBeam> beam;  // since the moment before
    };
    /// Those of a path, or of a moment, over a window or a band of it.
    struct PathSuns {
        std::size_t path;
        std::size_t band;
        std::vector<TileSun> suns;
        bool together;  // swept so
    };
    using Windows = std::vector<std::vector<BandedWindow>>;  // of each series

    std::vector<Series> all_series() const {
        std::vector<Series> all;
        const auto is_day = [&](std::size_t k) { return k < night_.size() && !night_[k]; };
        for (std::size_t k = 0; k < skies_.size(); ++k) {
            if (night_[k]) continue;
            std::size_t last = k;
            while (is_day(last + 1) && last - k < kTogether &&
                   skies_[last].goes_like(skies_[last + 1]))
                ++last;
            all.push_back({k, last});
            if (is_day(last + 1) && last - k < kTogether) {
                const std::optional<SunSky> next = skies_[last + 1].going_like(skies_[last]);
                if (next || last == k) all.back().last = ++last;
                if (next) all.back().turned = std::make_shared<const SunSky>(*next);
            }
            if (is_day(last + 1))
                k = last - 1;
            else
                k = last;
        }
        for (Series& series : all)
            add_paths(series);
        return all;
    }

    void add_paths(Series& series) const {
        for (std::size_t k = series.first; k <= series.last;) {
            const bool is_turned = k == series.last && series.turned;
            std::size_t end = k + 1, levels = skies_[k].levels();
            std::optional<SunSky> middle;
            while (!is_turned && end <= series.last && !(end == series.last && series.turned)) {
                const SunOverDem &first = moments_.suns[k], &last = moments_.suns[end];
                levels += skies_[end].levels();
                const double way_rad =
                    std::remainder(last.azimuth_rad - first.azimuth_rad, 2 * kPi);
                if (levels > Sweep::Blocks::kMostLevels || std::abs(way_rad) > kOnePath_rad) break;
                const SunSky between(dem_, {first.azimuth_rad + way_rad / 2,
                                            (first.elevation_rad + last.elevation_rad) / 2, 0});
                if (!between.goes_like(skies_[series.first])) break;
                middle.emplace(between);
                ++end;
            }
            series.paths.push_back({k, end, middle ? *middle : sky_of(series, k)});
            k = end;
        }
    }

    const SunSky& sky_of(const Series& series, std::size_t k) const {
        return k == series.last && series.turned ? *series.turned : skies_[k];
    }

    /// Parts of a window, no wider across the way of sweeps than they are to be.
    static std::vector<SweepWindow> parts_of(const SweepWindow& window, bool along_columns) {
        const int size = along_columns ? window.rows : window.columns;
        const int count = (size + kWidest - 1) / kWidest;
        std::vector<SweepWindow> parts;
        for (int i = 0; i < count; ++i) {
            const int from = static_cast<int>(std::int64_t{size} * i / count),
                      to = static_cast<int>(std::int64_t{size} * (i + 1) / count);
            parts.push_back(
                along_columns
                    ? SweepWindow{window.column, window.row + from, window.columns, to - from}
                    : SweepWindow{window.column + from, window.row, to - from, window.rows});
        }
        return parts;
    }

    Windows all_windows(const std::vector<Series>& all) const {
        Windows windows(all.size());
        parallel_for(0, static_cast<int>(all.size()), 1, [&](int begin, int end) {
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
                std::vector<SunSky> skies;
                for (const Series::Path& path : all[i].paths)
                    skies.push_back(path.sky);
                windows[i] = divide_in_bands(skies, whole(dem_.grid()), part_);
            }
        });
        return windows;
    }

    std::vector<Work> all_works(const std::vector<Series>& all, const Windows& windows,
                                SunHours& result) const {
        std::vector<Work> works;
        for (std::size_t i = 0; i < all.size(); ++i) {
            std::size_t tiles = 0;
            for (const BandedWindow& window : windows[i]) {
                std::size_t most = 1;
                for (const SunBands& bands : window.bands)
                    most = std::max(most, bands.tiles.size());
                tiles += most;
                for (const SweepWindow& part :
                     parts_of(common(window.window, part_), skies_[all[i].first].along_columns()))
                    works.push_back({all[i], &window, part, cost_of(all[i], part)});
            }
            result.windows = std::max(result.windows, static_cast<int>(tiles));
        }
        return works;
    }

    double cost_of(const Series& series, const SweepWindow& part) const {
        double sweeps = 0;
        for (std::size_t k = series.first; k <= series.last; ++k) {
            // From there on more and more posts are lit, as is known beforehand.
            constexpr double kAll_rad = radians(25), kFew_rad = radians(63), kFew = 0.15;
            const double over_rad = moments_.suns[k].elevation_rad - kAll_rad;
            const double share =
                irradiation_ ? 1 : std::clamp(1 - over_rad / (kFew_rad - kAll_rad), kFew, 1.0);
            sweeps += share * static_cast<double>(skies_[k].levels());
        }
        return sweeps * part.columns * part.rows;
    }

    /// In an order in which whatever is done first is much like the rest, so that the time left is
    /// known soon, and what is done last is short, so that no thread waits long for another. Sums
    /// do not hang on it.
    static std::vector<Work> shuffled(const std::vector<Work>& works) {
        if (works.empty()) return {};
        constexpr double kGolden = 0.6180339887498949;
        std::size_t stride = static_cast<std::size_t>(double(works.size()) * kGolden) | 1U;
        while (std::gcd(stride, works.size()) > 1)
            stride += 2;
        std::vector<Work> mixed;
        for (std::size_t i = 0; i < works.size(); ++i)
            mixed.push_back(works[i * stride % works.size()]);
        const auto by_cost = [](const Work& a, const Work& b) { return a.cost > b.cost; };
        std::vector<Work> sorted = mixed;
        std::sort(sorted.begin(), sorted.end(), by_cost);
        const auto few =
            std::min(static_cast<std::size_t>(4 * thread_count()), (sorted.size() + 2) / 3);
        const double short_cost = sorted[sorted.size() - few].cost;
        std::sort(std::stable_partition(mixed.begin(), mixed.end(),
                                        [=](const Work& work) { return work.cost > short_cost; }),
                  mixed.end(), by_cost);
        return mixed;
    }

    TileSun tile_sun(const Series& series, std::size_t k, const SunTile& tile) const {
        TileSun sun{k, TileEdges(sky_of(series, k), tile, 0), std::nullopt};
        if (irradiation_ && k > series.first) {
            const SunSky sky(dem_, moments_.middles[k - 1]);
            sun.beam.emplace(sky, tile, ClearSky(irradiation_->linke, moments_.distances_au[k - 1]),
                             at_h_[k] - at_h_[k - 1]);
        }
        return sun;
    }

    /// Whether suns over a tile differ by the same everywhere, or nearly so; they do then.
    bool make_alike(std::vector<TileSun>& suns) const {
        const SweepSun like = suns[suns.size() / 2].edges.suns().front();
        const GridPair& at = like.reference;
        const double across = std::max(at.column, dem_.grid().columns() - at.column),
                     down = std::max(at.row, dem_.grid().rows() - at.row);
        for (const TileSun& each : suns)
            for (const SweepSun& sun : each.edges.suns()) {
                const GridPair &a = sun.tangent_a_post, &b = like.tangent_a_post;
                const double off =
                    std::abs(a.column - b.column) * across + std::abs(a.row - b.row) * down;
                if (off > kShared_rad * (1 + sun.tangent * sun.tangent)) return false;
            }
        for (TileSun& each : suns)
            each.edges.go_like(like);
        return true;
    }

    /// Those of a path over a tile.
    PathSuns path_suns(const Series& series, std::size_t path, const SunTile& tile,
                       std::size_t band) const {
        PathSuns found{path, band, {}, false};
        for (std::size_t k = series.paths[path].first; k < series.paths[path].end; ++k)
            found.suns.push_back(tile_sun(series, k, tile));
        found.together = make_alike(found.suns);
        return found;
    }

    static std::vector<Sweep::Blocks::Suns> sweeps_of(const PathSuns& path) {
        std::vector<Sweep::Blocks::Suns> sweeps;
        for (const TileSun& each : path.suns)
            for (const SweepSun& sun : each.edges.suns()) {
                if (sweeps.empty() || !path.together)
                    sweeps.push_back({sun});
                else
                    sweeps.back().more.push_back(sun.tangent - sweeps.back().sun.tangent);
            }
        return sweeps;
    }

    /// The suns of a path over a part: those of a window, or those of each band.
    Sweep::Blocks::Sun add_suns(const Work& work, std::size_t path,
                                std::vector<PathSuns>& suns) const {
        const Series::Path& of = work.series.paths[path];
        Sweep::Blocks::Sun moment;
        moment.all_posts = irradiation_ || of.first == 0 || of.end == skies_.size();
        if (work.window->bands.empty()) {
            suns.push_back(
                path_suns(work.series, path, tile_of(of.sky, work.window->window, work.part), 0));
            moment.bands.push_back({sweeps_of(suns.back())});
            return moment;
        }
        const SunBands& bands = work.window->bands[path];
        moment.bands = bands.over(work.part);
        for (std::size_t band = 0; band < bands.tiles.size(); ++band) {
            suns.push_back(path_suns(work.series, path, bands.tiles[band], band));
            moment.bands[band].suns = sweeps_of(suns.back());
        }
        return moment;
    }

    void begin(PostLight& posts, const SweepWindow& window, bool along_columns,
               const std::optional<GroundForBeams>& ground) const {
        posts.begin(window, along_columns, spells_);
        if (ground) posts.beams = ground->part(window, along_columns);
    }

    void light_part(const Work& work, const std::optional<GroundForBeams>& ground, PostLight& posts,
                    Totals& totals) const {
        std::vector<PathSuns> suns;
        std::vector<Sweep::Blocks::Sun> sweeps;
        for (std::size_t path = 0; path < work.series.paths.size(); ++path)
            sweeps.push_back(add_suns(work, path, suns));
        if (!Sweep::Blocks::go_together(sweeps))
            return light_apart(work, suns, sweeps, ground, posts, totals);
        Sweep::Blocks blocks(sweep_, sweeps, work.part, dem_.floor_m(), dem_.curvature());
        while (const std::optional<SweepWindow> block = blocks.next()) {
            begin(posts, *block, skies_[work.series.first].along_columns(), ground);
            blocks.each_dark([&](const SweepRun& run) {
                for (TileValues* const each : {&posts.margin_m, &posts.began_m})
                    if (spells_ || each == &posts.margin_m)
                        std::fill_n(each->of(run), run.count, -1.0F);
            });
            for (const PathSuns& path : suns)
                add(work.series, path, posts,
                    [&](std::size_t i, const Sweep::Blocks::UseEach& use) {
                        blocks.each_edge(path.path, path.band, i, use);
                    });
            finish(work.series, posts, totals);
        }
    }

    /// Likewise suns that do not go over the grid alike.
    void light_apart(const Work& work, const std::vector<PathSuns>& suns,
                     const std::vector<Sweep::Blocks::Sun>& sweeps,
                     const std::optional<GroundForBeams>& ground, PostLight& posts,
                     Totals& totals) const {
        begin(posts, work.part, skies_[work.series.first].along_columns(), ground);
        for (const PathSuns& path : suns) {
            posts.turn(sky_of(work.series, path.suns.front().k).along_columns());
            Sweep::Blocks::Sun alone;
            alone.bands = {sweeps[path.path].bands[path.band]};
            Sweep::Blocks blocks(sweep_, {alone}, work.part, dem_.floor_m(), dem_.curvature());
            // Block by block each sun's posts come before the next one's.
            while (blocks.next())
                add(work.series, path, posts,
                    [&](std::size_t i, const Sweep::Blocks::UseEach& use) {
                        blocks.each_edge(0, 0, i, use);
                    });
        }
        finish(work.series, posts, totals);
    }

    /// What is lit at the last sun has had light until then.
    void finish(const Series& series, PostLight& posts, Totals& totals) const {
        add_lit(static_cast<float>(at_h_[series.last] - at_h_[series.first]),
                posts.margin_m.all().data(), posts.lit_h.all().size(), posts.lit_h.all().data());
        totals.add(series, posts);
    }

    /// Suns over posts, whose edges `sweep` has for each of sweeps_of() them.
    void add(const Series& series, const PathSuns& path, PostLight& posts,
             const std::function<void(std::size_t, const Sweep::Blocks::UseEach&)>& sweep) const {
        if (path.together)
            return sweep(0, [&](const SweepRun& run, const float* const* found) {
                add_run(series, path.suns, run, found, posts);
            });
        std::size_t i = 0;
        for (const TileSun& sun : path.suns) {
            const bool two = sun.edges.suns().size() == 2;
            if (two)
                sweep(i++, [&](const SweepRun& run, const float* const*) {
                    std::copy_n(run.found, run.count, posts.scratch.of(run));
                });
            sweep(i++, [&](const SweepRun& run, const float* const*) {
                const std::array<const float*, 2> found{two ? posts.scratch.of(run) : run.found,
                                                        run.found};
                add_run(series, {&sun, 1}, run, found.data(), posts);
            });
        }
    }

    /// @param found  for each of the suns edges of those that are swept
    void add_run(const Series& series, std::span<const TileSun> suns, const SweepRun& run,
                 const float* const* found, PostLight& posts) const {
        constexpr int kRun = TileEdges::kRun;
        std::array<float, kRun * Sweep::Blocks::kMostLevels> room;
        std::array<const float*, Sweep::Blocks::kMostLevels> edges;
        for (int done = 0; done < run.count; done += kRun) {
            SweepRun part = run;
            part.first += done;
            part.count = std::min(run.count - done, kRun);
            part.height_m += done;
            const float* const* of_sun = found;
            for (std::size_t i = 0; i < suns.size(); ++i) {
                const TileEdges& of = suns[i].edges;
                part.found = of_sun[of.suns().size() - 1] + done;
                edges[i] = of.find(part, *of_sun + done, room.data() + i * kRun);
                of_sun += of.suns().size();
            }
            add_light_of(series, suns, part, edges.data(), posts);
        }
    }

    /// A series counts light from its first sun to its last.
    void add_light_of(const Series& series, std::span<const TileSun> suns, SweepRun run,
                      const float* const* edges, PostLight& posts) const {
        const double begin_h = at_h_[series.first];
        float *const margin_m = posts.margin_m.of(run), *const lit_h = posts.lit_h.of(run);
        std::array<LightAt, Sweep::Blocks::kMostLevels> moments;
        std::size_t count = 0;  // of those that are to be added
        const auto add_all = [&] {
            if (count > 0)
                add_light({{moments.data(), count}, run.height_m, margin_m, lit_h}, run.count);
            count = 0;
        };
        for (std::size_t i = 0; i < suns.size(); ++i) {
            const std::size_t k = suns[i].k;
            run.found = edges[i];
            if (k == series.first) {
                measure(run, margin_m);
                if (spells_) std::copy_n(margin_m, run.count, posts.began_m.of(run));
                if (spells_ && k == 0) add_end(run, 0, true, posts);
            } else {
                const Step step{at_h_[k - 1], at_h_[k] - at_h_[k - 1]};
                const std::optional<SunBeam>& beam = suns[i].beam;
                if (spells_ || beam) add_all();
                if (spells_) add_spells(run, step, posts);
                if (beam && beam->given.back() > 0) add_beam(run, *beam, margin_m, *posts.beams);
                moments[count++] = {static_cast<float>(step.from_h - begin_h),
                                    static_cast<float>(step.hours), run.found};
            }
            if (spells_ && k + 1 == skies_.size()) {
                add_all();
                add_end(run, at_h_[k], false, posts);
            }
        }
        add_all();
    }

    const DemSky& dem_;
    const Sweep& sweep_;
    const Moments& moments_;
    bool spells_;
    std::optional<SunHoursOptions::Irradiation> irradiation_;
    SweepWindow part_;
    std::vector<SunSky> skies_;
    std::vector<bool> night_;
    std::vector<double> at_h_;
};

// --- Many days: a horizon for every direction, and how long the sun stood over what height there

/// How long the sun stood higher than an elevation, while its azimuth was within some degrees.
class Direction {
  public:
    static constexpr int kEntries = 4096;
    static constexpr double kLowest_rad = radians(-6);
    static constexpr double kStep_rad = radians(96) / (kEntries - 1);

    /// @param elevation_rad  as seen
    /// @param level_wh, up_wh  of beams: along the azimuth, and from above
    void add(double azimuth_rad, double elevation_rad, double hours, double level_wh,
             double up_wh) {
        if (hours_.empty())
            for (auto* const each : {&hours_, &level_wh_, &up_wh_})
                each->resize(kEntries, 0);
        azimuth_sum_rad_ += azimuth_rad * hours;
        sum_h_ += hours;
        // An entry between two: to each its share.
        const double at =
            std::clamp((elevation_rad - kLowest_rad) / kStep_rad, 0.0, double{kEntries} - 1.001);
        const auto entry = static_cast<std::size_t>(at);
        const double part = at - static_cast<double>(entry);
        const auto put = [&](std::vector<double>& to, double sum) {
            to[entry] += sum * (1 - part);
            to[entry + 1] += sum * part;
        };
        put(hours_, hours);
        put(level_wh_, level_wh);
        put(up_wh_, up_wh);
    }

    bool empty() const { return hours_.empty(); }
    double azimuth_rad() const { return azimuth_sum_rad_ / sum_h_; }

    /// To be called once all is added.
    void sum_up() {
        over_ = summed(hours_);
        level_over_ = summed(level_wh_);
        up_over_ = summed(up_wh_);
    }
    const float* over() const { return over_.data(); }
    const float* level_over() const { return level_over_.data(); }
    const float* up_over() const { return up_over_.data(); }

  private:
    /// Half of what stands at an entry is over it.
    static std::vector<float> summed(const std::vector<double>& at) {
        double above = 0;
        std::vector<float> over(at.size());
        for (std::size_t k = at.size(); k-- > 0;) {
            over[k] = static_cast<float>(above + at[k] / 2);
            above += at[k];
        }
        return over;
    }

    double azimuth_sum_rad_ = 0, sum_h_ = 0;
    std::vector<double> hours_, level_wh_, up_wh_;
    std::vector<float> over_, level_over_, up_over_;
};

/// Of posts next to each other, where their horizons are in tables of directions.
/// @param base, a_post, first  the elevation of the tables' first entry there:
///     base + a_post * (first + done), and so on [rad]
RELEVO_WIDE_LOOPS void find_entries(const float* tangent, int count, float base, float a_post,
                                    float first, int done, float* at) {
    constexpr auto kScale = static_cast<float>(1 / Direction::kStep_rad);
    constexpr float kLast = Direction::kEntries - 1.001F;
    for (int i = 0; i < count; ++i) {
        const float t = tangent[i];
        const float elevation = std::copysign(quick_atan(std::abs(t)), t);
        const float entry =
            (elevation - base - a_post * (first + static_cast<float>(done + i))) * kScale;
        const float least = entry > 0 ? entry : 0;
        at[i] = least < kLast ? least : kLast;
    }
}

class ManyDays {
  public:
    ManyDays(const DemSky& dem, const Sweep& sweep, sun::Instant begin, double length_s,
             const SunHoursOptions& options, const SweepWindow& part)
        : dem_(dem),
          sweep_(sweep),
          begin_(begin),
          length_s_(length_s),
          table_(begin, begin + length_s),
          irradiation_(options.irradiation),
          part_(part) {}

    void light(SunHours& result, const std::function<void(double)>& done) const {
        for (const SweepWindow& block : blocks())
            if (const SweepWindow part = common(block, part_); part.columns > 0 && part.rows > 0) {
                const double share = double(part.columns) * part.rows / part_.columns / part_.rows;
                light_block(block, part, result, [&](double of_block) {
                    if (done) done(share * of_block);
                });
            }
    }

  private:
    static constexpr std::size_t kDirections = 180;
    /// For the air of the lowest post, and of the highest one.
    using Directions = std::array<std::array<Direction, kDirections>, 2>;
    /// For each entry how long the sun was over it, in the air of both.
    using BothLevels = std::vector<std::array<float, 2>>;

    /// Parts of the DEM over which the sun is at its azimuth in the middle within what directions
    /// are apart.
    std::vector<SweepWindow> blocks() const {
        constexpr double kBlock_m = 200e3;
        const dem::Grid& grid = dem_.grid();
        const glm::dvec2& spacing_m = dem_.spacing_m();
        const int columns = std::max(1, static_cast<int>(kBlock_m / spacing_m.x)),
                  rows = std::max(1, static_cast<int>(kBlock_m / spacing_m.y));
        std::vector<SweepWindow> blocks;
        for (int row = 0; row < grid.rows(); row += rows)
            for (int column = 0; column < grid.columns(); column += columns)
                blocks.push_back({column, row, std::min(columns, grid.columns() - column),
                                  std::min(rows, grid.rows() - row)});
        return blocks;
    }

    void light_block(const SweepWindow& block, const SweepWindow& part, SunHours& result,
                     const std::function<void(double)>& done) const {
        const geo::Geodetic middle = dem_.grid().place(block.column + (block.columns - 1) / 2.0,
                                                       block.row + (block.rows - 1) / 2.0);
        Directions directions = directions_over(middle);
        const double all = static_cast<double>(
            std::count_if(directions[0].begin(), directions[0].end(),
                          [](const Direction& direction) { return !direction.empty(); }));
        TileValues lit_h(part, 0);
        std::optional<GroundForBeams> beams;
        if (irradiation_) beams.emplace(dem_, part);
        for (std::size_t k = 0; k < kDirections; ++k) {
            Direction& low = directions[0][k];
            if (low.empty()) continue;
            low.sum_up();
            directions[1][k].sum_up();
            const SunSky sky(dem_, middle, {low.azimuth_rad(), 0, 0});
            lit_h.turn(sky.along_columns());
            if (beams) beams->turn(sky.along_columns());
            const std::vector<SweepWindow> windows =
                divide({sky}, block, part, kPeriodTolerance_rad);
            result.windows = std::max(result.windows, static_cast<int>(windows.size()));
            each_window(windows, [&](const SweepWindow& window) {
                add(sky, tile_of(sky, window, part), low, directions[1][k], lit_h, beams);
            });
            done(1 / all);
        }
        lit_h.put(result.hours, part_);
        if (beams) beams->beam_wh.put(result.beam_kwh, part_);
    }

    Directions directions_over(const geo::Geodetic& middle) const {
        Directions directions;
        const sun::Observer observer(middle);
        const double step_s = length_s_ > 40 * kDay_s ? 120 : 60;
        const auto steps = static_cast<std::int64_t>(std::ceil(length_s_ / step_s - 1e-9));
        struct Sample {
            double azimuth_rad, elevation_rad, hours;
            std::array<double, 2> apparent_rad, beam_wh;
        };
        const auto sample_at = [&](std::int64_t i) {
            const double from_s = static_cast<double>(i) * step_s;
            const double until_s = std::min(from_s + step_s, length_s_);
            const glm::dvec3 towards_au =
                table_.vector_au(begin_ + (from_s + until_s) / 2, observer);
            Sample sun{sun::azimuth_of(towards_au),
                       sun::elevation_of(towards_au),
                       (until_s - from_s) / kHour_s,
                       {},
                       {}};
            if (sun.elevation_rad < Direction::kLowest_rad) return sun;
            for (std::size_t level = 0; level < 2; ++level) {
                sun.apparent_rad[level] = dem_.apparent_rad(sun.elevation_rad, level);
                if (irradiation_)
                    sun.beam_wh[level] =
                        sun.hours * ClearSky(irradiation_->linke, glm::length(towards_au))
                                        .beam(sun.elevation_rad, level_m(level));
            }
            return sun;
        };
        constexpr int kTogether = 1 << 14;
        std::vector<Sample> samples;
        for (std::int64_t done = 0; done < steps; done += kTogether) {
            samples.resize(
                static_cast<std::size_t>(std::min<std::int64_t>(kTogether, steps - done)));
            parallel_for(0, static_cast<int>(samples.size()), 256, [&](int first, int last) {
                for (int i = first; i < last; ++i)
                    samples[static_cast<std::size_t>(i)] = sample_at(done + i);
            });
            for (const Sample& sun : samples) {
                if (sun.elevation_rad < Direction::kLowest_rad) continue;
                const auto k =
                    std::min(kDirections - 1,
                             static_cast<std::size_t>(sun.azimuth_rad / (2 * kPi) * kDirections));
                for (std::size_t level = 0; level < 2; ++level)
                    directions[level][k].add(sun.azimuth_rad, sun.apparent_rad[level], sun.hours,
                                             sun.beam_wh[level] * std::cos(sun.elevation_rad),
                                             sun.beam_wh[level] * std::sin(sun.elevation_rad));
            }
        }
        return directions;
    }

    /// Of the lowest post and of the highest one, or a metre over that.
    double level_m(std::size_t level) const {
        return dem_.level_height_m(0) + (level == 0 ? 0 : std::max(1.0, dem_.relief_m()));
    }

    void add(const SunSky& sky, const SunTile& tile, const Direction& low, const Direction& high,
             TileValues& lit_h, std::optional<GroundForBeams>& beams) const {
        // The sun is as much higher at a post than in the middle of the block as the ground turns
        // towards it.
        const GridPair& at = tile.path.reference;
        const double lift_rad = sky.elevation_rad(at.column, at.row);
        const GridPair more{
            (sky.elevation_rad(at.column + 1, at.row) - sky.elevation_rad(at.column - 1, at.row)) /
                2,
            (sky.elevation_rad(at.column, at.row + 1) - sky.elevation_rad(at.column, at.row - 1)) /
                2};
        const double low_m = dem_.level_height_m(0);
        const double span_m = std::max(1.0, dem_.level_height_m(1) - low_m);
        BothLevels over(Direction::kEntries);
        for (std::size_t k = 0; k < over.size(); ++k)
            over[k] = {low.over()[k], high.over()[k]};
        each_horizon(sky, sweep_, tile, [&](const SweepRun& run) {
            // From the reference on, so that bits do not hang on where a run begins.
            const double aside = run.along_column ? more.column * (run.line - at.column)
                                                  : more.row * (run.line - at.row);
            const double a_post = run.along_column ? more.row : more.column;
            const double from = run.first - (run.along_column ? at.row : at.column);
            look_up(run, lift_rad + aside, a_post, from, over, low_m, span_m, lit_h.of(run));
            if (beams) look_up_beams(run, lift_rad + aside, a_post, from, low, high, *beams);
        });
    }

    /// @param lift, lift_a_post  of the sun over where it stands in the middle [rad]
    /// @param from               where the run begins, posts from the middle on
    static void look_up(const SweepRun& run, double lift, double lift_a_post, double from,
                        const BothLevels& over, double low_m, double span_m, float* lit_h) {
        const auto bottom_m = static_cast<float>(low_m), scale_m = static_cast<float>(1 / span_m);
        each_entry(run, lift, lift_a_post, from, [&](int i, std::size_t entry, float part) {
            const auto& [low, high] = over[entry];
            const auto& [next_low, next_high] = over[entry + 1];
            const float in_low = low + part * (next_low - low),
                        in_high = high + part * (next_high - high);
            lit_h[i] += in_low + (run.height_m[i] - bottom_m) * scale_m * (in_high - in_low);
        });
    }

    /// Likewise the beams' sums, onto the ground as it is inclined; what comes from behind it is
    /// none.
    static void look_up_beams(const SweepRun& run, double lift, double lift_a_post, double from,
                              const Direction& low, const Direction& high, GroundForBeams& ground) {
        const auto a_post = static_cast<float>(lift_a_post), first = static_cast<float>(from),
                   base = static_cast<float>(lift),
                   sin_azimuth = static_cast<float>(std::sin(low.azimuth_rad())),
                   cos_azimuth = static_cast<float>(std::cos(low.azimuth_rad()));
        const float *const east = ground.east.of(run), *const north = ground.north.of(run),
                           *const air = ground.air.of(run);
        float* const beam = ground.beam_wh.of(run);
        each_entry(run, lift, lift_a_post, from, [&](int i, std::size_t entry, float part) {
            const auto sum = [&](const float* in_low, const float* in_high) {
                const float l = in_low[entry] + part * (in_low[entry + 1] - in_low[entry]);
                const float h = in_high[entry] + part * (in_high[entry + 1] - in_high[entry]);
                return l + air[i] * (h - l);
            };
            const float level = sum(low.level_over(), high.level_over()),
                        up = sum(low.up_over(), high.up_over());
            const float e = east[i], n = north[i];
            // The sun stands higher there by the lift.
            const float lifted = base + a_post * (first + static_cast<float>(i));
            const float onto =
                (up + lifted * level) - (e * sin_azimuth + n * cos_azimuth) * (level - lifted * up);
            const float gain = onto / std::sqrt(1 + e * e + n * n);
            beam[i] += gain > 0 ? gain : 0;
        });
    }

    /// Calls `use` with every post, the entry of a direction's table that its horizon is at, and
    /// how far that is on to the next one.
    template <typename Use>
    static void each_entry(const SweepRun& run, double lift, double lift_a_post, double from,
                           const Use& use) {
        constexpr int kSome = 256;
        std::array<float, kSome> at;
        for (int done = 0; done < run.count; done += kSome) {
            const int some = std::min(run.count - done, kSome);
            find_entries(run.found + done, some, static_cast<float>(lift + Direction::kLowest_rad),
                         static_cast<float>(lift_a_post), static_cast<float>(from), done,
                         at.data());
            for (int i = 0; i < some; ++i) {
                const float entry = at[static_cast<std::size_t>(i)];
                const auto whole = static_cast<int>(entry);
                use(done + i, static_cast<std::size_t>(whole), entry - static_cast<float>(whole));
            }
        }
    }

    const DemSky& dem_;
    const Sweep& sweep_;
    sun::Instant begin_;
    double length_s_;
    sun::PositionTable table_;
    std::optional<SunHoursOptions::Irradiation> irradiation_;
    SweepWindow part_;
};

/// Hours over a level horizon, from one sun to the next.
class LevelHours {
  public:
    void add(double at_s, double apparent_rad) {
        const double over = std::max(before_rad_, 0.0) + std::max(apparent_rad, 0.0);
        const double all = std::abs(before_rad_) + std::abs(apparent_rad);
        if (over > 0 && at_s > at_s_) hours_ += (at_s - at_s_) / kHour_s * over / all;
        at_s_ = at_s, before_rad_ = apparent_rad;
    }
    double hours() const { return hours_; }

  private:
    double hours_ = 0, at_s_ = 0, before_rad_ = 0;
};

/// In the middle of the DEM, and the most anywhere.
void add_level_hours(const DemSky& dem, const Moments& moments, SunHours& result) {
    const geo::Geodetic center = dem.grid().center();
    const geo::Axes axes = dem.frame().axes(center.lat_rad, center.lon_rad);
    LevelHours middle;
    std::array<LevelHours, 9> at_marks;
    for (std::size_t k = 0; k < moments.suns.size(); ++k) {
        const SunOverDem& sun = moments.suns[k];
        middle.add(moments.at_s[k], dem.apparent_rad(sun.elevation_rad, 0));
        const double c = std::cos(sun.elevation_rad);
        const glm::dvec3 direction = c * std::sin(sun.azimuth_rad) * axes.east +
                                     c * std::cos(sun.azimuth_rad) * axes.north +
                                     std::sin(sun.elevation_rad) * axes.up;
        for (std::size_t i = 0; i < at_marks.size(); ++i) {
            const geo::Geodetic& place = dem.marks()[i];
            const glm::dvec3 up = dem.frame().axes(place.lat_rad, place.lon_rad).up;
            const double elevation_rad = std::asin(std::clamp(glm::dot(direction, up), -1.0, 1.0));
            at_marks[i].add(moments.at_s[k], dem.apparent_rad(elevation_rad, 0));
        }
    }
    result.level_hours = result.most_level_hours = middle.hours();
    for (const LevelHours& at : at_marks)
        result.most_level_hours = std::max(result.most_level_hours, at.hours());
}

void check(sun::Instant begin, sun::Instant end, const SunHoursOptions& options) {
    if (!(end > begin))
        bad_input(fmt::format("sun hours: from {} to {}: expected an end after the beginning",
                              sun::to_iso(begin), sun::to_iso(end)));
    if (!(options.step_s >= 1 && options.step_s <= kHour_s))
        bad_input(
            fmt::format("sun hours: step {:.10g} s: expected 1 s to an hour", options.step_s));
    if (options.spells && end - begin > SunHoursOptions::kMostDays * kDay_s)
        bad_input(
            fmt::format("sun hours: {:.1f} days: first and last light are known of {} days at most",
                        (end - begin) / kDay_s, SunHoursOptions::kMostDays));
    sun::check_year(begin);
    sun::check_year(end);
}

/// Holes, and the mean of the others.
void sum_up(const PartHeights& heights, const SweepWindow& part, SunHours& result) {
    std::int64_t posts = 0;
    for (int row = 0; row < result.hours.height(); ++row)
        for (int column = 0; column < result.hours.width(); ++column) {
            float& hours = result.hours.at(column, row);
            if (std::isnan(heights.at(part.column + column, part.row + row))) {
                hours = kNaN;
                if (result.spells.size() > 0)
                    for (Array2d<float>* const each :
                         {&result.spells, &result.first_h, &result.last_h})
                        each->at(column, row) = kNaN;
                ++result.holes;
                continue;
            }
            hours = std::max(hours, 0.0F);  // sums of comings and goings end near 0
            result.mean_hours += double{hours};
            ++posts;
        }
    result.mean_hours /= static_cast<double>(posts);
}

/// Light of the sky and of the ground around, and what is said of irradiation.
void add_sky(const DemSky& dem, sun::Instant begin, double length_s, const SunHoursOptions& options,
             SunHours& result) {
    const SweepWindow part = window_of(options.part, dem.grid());
    const SkyView view = sky_view(dem.posts(), {.directions = options.irradiation->sky_directions,
                                                .refraction = options.refraction,
                                                .level = false,
                                                .part = options.part,
                                                .done = {}});
    const double step_s = length_s > 40 * kDay_s ? 600 : 60;
    const OpenSky open(dem, sun::PositionTable(begin, begin + length_s), begin, length_s, step_s,
                       options.irradiation->linke);
    const PartHeights heights(dem.posts(), part);
    const double albedo = options.irradiation->albedo;
    parallel_for(0, part.rows, 16, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            for (int column = 0; column < part.columns; ++column) {
                const OpenSky::Energy energy = open.at(part.column + column, part.row + row);
                const double height_m = heights.at(part.column + column, part.row + row);
                const double level_wh =
                    energy.beam_low_wh +
                    air_left(dem, height_m) * (energy.beam_high_wh - energy.beam_low_wh);
                const double share = view.share.at(column, row);  // NaN in holes
                result.diffuse_kwh.at(column, row) =
                    static_cast<float>(energy.diffuse_wh * share / 1000);
                result.reflected_kwh.at(column, row) = static_cast<float>(
                    albedo * (level_wh + energy.diffuse_wh) * (1 - share) / 1000);
                float& beam = result.beam_kwh.at(column, row);
                beam = std::isnan(share) ? kNaN : beam / 1000;
            }
    });
}

}  // namespace

SunHours sun_hours(const dem::Posts& posts, sun::Instant begin, sun::Instant end,
                   const SunHoursOptions& options) {
    check(begin, end, options);
    const dem::Grid& grid = posts.grid();
    const DemSky dem(posts, {.refraction = options.refraction, .air = options.air});
    const Sweep sweep = sweep_over(posts);
    const double length_s = end - begin;
    const bool few = length_s <= SunHoursOptions::kMostDays * kDay_s;
    const Moments times =
        moments(dem, begin, length_s, few ? options.step_s : 600, few ? kFiner : 1);
    SunHours result;
    const SweepWindow part = window_of(options.part, grid);
    result.hours = Array2d<float>(part.columns, part.rows, 0);
    if (options.spells)
        for (Array2d<float>* const each : {&result.first_h, &result.last_h, &result.spells})
            *each = Array2d<float>(part.columns, part.rows, kNaN);
    if (options.irradiation)
        for (Array2d<float>* const each :
             {&result.beam_kwh, &result.diffuse_kwh, &result.reflected_kwh})
            *each = Array2d<float>(part.columns, part.rows);
    if (few)
        FewDays(dem, sweep, times, options, part).light(result, options.done);
    else
        ManyDays(dem, sweep, begin, length_s, options, part).light(result, options.done);
    sum_up(PartHeights(posts, part), part, result);
    if (options.irradiation) add_sky(dem, begin, length_s, options, result);
    add_level_hours(dem, times, result);
    result.definition = fmt::format(
        "hours that the centre of the sun stands over the terrain, at the height of the ground, "
        "{}; ground of the DEM alone shades, on the WGS 84 ellipsoid with terrestrial refraction k "
        "= {:.4g}{}; no clouds",
        few ? fmt::format("from suns {:.10g} s apart, {:.10g} s near the horizon, in directions "
                          "within {:.2g} degrees of theirs",
                          options.step_s, options.step_s / kFiner, degrees(kOnePath_rad) / 2)
            : "from horizons in directions 2 degrees apart",
        options.refraction, kBeyondTheDem);
    return result;
}

}  // namespace relevo::light
