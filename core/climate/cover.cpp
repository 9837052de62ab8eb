#include "climate/cover.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/units.h"

// Steps of one day meet as many of the known places and tree lines as the five days of kSteps: 162
// of 176, and 248 m in the mean (data/README.md).
namespace relevo::climate {
namespace {

constexpr double kLapse_k_km = 6.5, kSummerLapse_k_km = 0.7, kMoistLapse_k_km = 1;
constexpr double kSeasonFrom_c = 0.9, kTrees_days = 94, kTrees_c = 6.4, kWarmest_days = 210;
constexpr double kPlants_days = 45, kPlants_c = 3.2;
constexpr double kHalfSnow_c = 1, kSnowWidth_k = 1.5;
constexpr double kMeltSnow_mm_k = 3.5, kMeltIce_mm_k = 6;  // a day
constexpr double kSublimation_mm = 0.5, kMoistYear_mm = 600;
constexpr double kIceSnow = 2.2, kColdDesert_deg = -60;  // south of which snow only falls
constexpr double kMappedIce_mm = -1500;
constexpr double kLowest_m = -500, kHighest_m = 9000;

constexpr std::array<int, 12> kMonthDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

/// A function in steps of 1/32 over an interval, constant beyond: a year at a height takes three
/// hundred exponentials otherwise.
class Table {
  public:
    template <typename Function>
    Table(double low, double high, const Function& function) : low_(low) {
        for (double x = low; x <= high; x += kStep)
            values_.push_back(static_cast<float>(function(x)));
    }
    double operator()(double x) const {
        const double at =
            std::clamp((x - low_) / kStep, 0.0, static_cast<double>(values_.size()) - 1.001);
        const auto i = static_cast<std::size_t>(at);
        return values_[i] + (at - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
    }

  private:
    static constexpr double kStep = 1.0 / 32;
    double low_;
    std::vector<float> values_;
};

/// Share of what falls that is snow.
double snow_of(double temperature_c) {
    static const Table table(-12, 12, [](double x) { return 1 / (1 + std::exp(x)); });
    return table((temperature_c - kHalfSnow_c) / kSnowWidth_k);
}

/// ln(1 + exp(x)).
double softplus(double x) {
    static const Table table(-12, 12, [](double v) { return std::log1p(std::exp(v)); });
    return x > 12 ? x : table(x);
}

/// exp(x) of what is not above 0.
double decay(double x) {
    static const Table table(-12, 0.1, [](double v) { return std::exp(v); });
    return table(x);
}

double sum_of(const Months& months) {
    return std::accumulate(months.begin(), months.end(), 0.0);
}

double mean_of(const Months& months) {
    return sum_of(months) / 12;
}

/// Lowest height where a condition that holds from some height on does.
template <typename Condition>
std::optional<double> lowest(const Condition& holds) {
    double below = kLowest_m, above = kHighest_m;
    if (!holds(above)) return std::nullopt;
    if (holds(below)) return below;
    while (above - below > 1) {
        const double middle = (below + above) / 2;
        (holds(middle) ? above : below) = middle;
    }
    return above;
}

}  // namespace

const char* name_of(Cover cover) {
    constexpr std::array kNames{"ice", "snow", "rock", "desert", "steppe", "grass", "forest"};
    return kNames[static_cast<std::size_t>(cover)];
}

int day_of_year(int month, int day) {
    const int before = std::accumulate(kMonthDays.begin(), kMonthDays.begin() + (month - 1), 0);
    return std::min(before + day - 1, 364);
}

Months CoverColumn::lapse_k_km(double lat_deg) {
    const double share = std::clamp((std::abs(lat_deg) - 20) / 25, 0.0, 1.0);
    Months lapse;
    for (std::size_t month = 0; month < 12; ++month) {
        const double summer = std::cos(2 * kPi * (static_cast<double>(month) - 6.5) / 12);
        lapse[month] =
            kLapse_k_km + kSummerLapse_k_km * share * std::copysign(1.0, lat_deg) * summer;
    }
    return lapse;
}

CoverColumn::CoverColumn(const Normals& normals)
    : normals_(normals),
      lapse_k_km_(lapse_k_km(normals.lat_deg)),
      upper_lapse_k_km_(lapse_k_km_),
      year_mm_(sum_of(normals.rain_mm)) {
    const double warm = std::clamp((mean_c(normals.relief_m) - 10) / 15, 0.0, 1.0);
    for (double& lapse : upper_lapse_k_km_)
        lapse -= kMoistLapse_k_km * warm;
    Months daily_mm;
    for (std::size_t month = 0; month < 12; ++month)
        daily_mm[month] = normals.rain_mm[month] / kMonthDays[month];
    rain_mm_ = steps_of(daily_mm);
    for (float& step : rain_mm_)
        step *= static_cast<float>(kStep_days);
    const double summer_mm =
        std::accumulate(normals.rain_mm.begin() + 3, normals.rain_mm.begin() + 9, 0.0);
    const double share = summer_mm / std::max(year_mm_, 1e-6);
    summer_share_ = normals.lat_deg >= 0 ? share : 1 - share;
    const auto [coldest, warmest] =
        std::minmax_element(normals.sea_level_c.begin(), normals.sea_level_c.end());
    spread_k_ = 0.576 * std::clamp(1 + 0.05 * (*warmest - *coldest), 1.5, 4.0);
    dry_air_mm_day_ = kSublimation_mm * std::max(0.0, 1 - year_mm_ / kMoistYear_mm);
}

Months CoverColumn::temperature_c(double height_m) const {
    const double low_km = std::min(height_m, normals_.relief_m) / 1000;
    const double high_km = std::max(0.0, height_m - normals_.relief_m) / 1000;
    Months temperature;
    for (std::size_t month = 0; month < 12; ++month)
        temperature[month] = normals_.sea_level_c[month] - lapse_k_km_[month] * low_km -
                             upper_lapse_k_km_[month] * high_km;
    return temperature;
}

double CoverColumn::mean_c(double height_m) const {
    return mean_of(temperature_c(height_m));
}

/// Linear between the middles of the months.
Year CoverColumn::steps_of(const Months& months) const {
    // Of each step: the month whose middle lies before, and how far on the way to the next.
    struct At {
        std::size_t month;
        double share;
    };
    static const std::array<At, kSteps> kAt = [] {
        std::array<double, 12> middle{};
        double begin = 0;
        for (std::size_t m = 0; m < 12; ++m) {
            middle[m] = begin + kMonthDays[m] / 2.0;
            begin += kMonthDays[m];
        }
        std::array<At, kSteps> at{};
        for (std::size_t i = 0; i < kSteps; ++i) {
            const double day = (static_cast<double>(i) + 0.5) * kStep_days;
            std::size_t m = 11;
            for (std::size_t k = 0; k < 12; ++k)
                if (middle[k] <= day) m = k;
            if (day < middle[0]) m = 11;
            const double from = m == 11 && day < middle[0] ? middle[m] - 365 : middle[m];
            const double to = m == 11 && day >= middle[0] ? middle[0] + 365 : middle[(m + 1) % 12];
            at[i] = {m, (day - from) / (to - from)};
        }
        return at;
    }();
    Year year;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const At& at = kAt[i];
        year[i] = static_cast<float>((1 - at.share) * months[at.month] +
                                     at.share * months[(at.month + 1) % 12]);
    }
    return year;
}

double CoverColumn::dryness(double height_m) const {
    const double seasonal = summer_share_ >= 0.7 ? 280 : summer_share_ <= 0.3 ? 0 : 140;
    const double limit_mm = 20 * mean_c(height_m) + seasonal;
    return year_mm_ / std::max(limit_mm, 60.0);
}

double CoverColumn::growth(double height_m) const {
    const Year temperature = steps_of(temperature_c(height_m));
    std::array<float, kSteps> sorted = temperature;
    std::ranges::sort(sorted, std::greater<>());
    // Steps count by their share above the limit, as if warmth fell evenly from one to the next.
    double days = 0, warm_days = 0, sum = 0;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double below = i + 1 < kSteps ? sorted[i + 1] : sorted[i] - 0.1;
        const double above = i > 0 ? sorted[i - 1] : sorted[i] + 0.1;
        const double half = std::max((above - below) / 4, 1e-3);
        const double share =
            std::clamp(0.5 + (sorted[i] - kSeasonFrom_c) / (2 * half), 0.0, 1.0) * kStep_days;
        const double counted = std::min(share, kWarmest_days - warm_days);
        days += share;
        sum += counted * std::max<double>(sorted[i], kSeasonFrom_c);
        warm_days += counted;
    }
    // Below: how far from a season, so that there is no step between.
    if (days <= 0)
        return (sorted[0] - kSeasonFrom_c) / (kTrees_c - kPlants_c) -
               kPlants_days / (kTrees_days - kPlants_days);
    return std::min((sum / warm_days - kPlants_c) / (kTrees_c - kPlants_c),
                    (days - kPlants_days) / (kTrees_days - kPlants_days));
}

double CoverColumn::snowfall_mm(const Year& temperature_c, std::size_t step) const {
    return rain_mm_[step] * snow_of(temperature_c[step]);
}

double CoverColumn::sublimation_mm(double temperature_c, double height_m) const {
    if (dry_air_mm_day_ <= 0) return 0;
    return kStep_days * dry_air_mm_day_ * (1 + std::max(height_m, 0.0) / 3000) *
           decay(0.08 * std::min(temperature_c, 0.0));
}

double CoverColumn::ice_balance_mm(double height_m) const {
    const Year temperature = steps_of(temperature_c(height_m));
    const double gathered = normals_.lat_deg > kColdDesert_deg ? kIceSnow : 1;
    double balance = 0;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double t = temperature[i];
        balance += gathered * snowfall_mm(temperature, i) -
                   kMeltIce_mm_k * kStep_days * spread_k_ * softplus(t / spread_k_) -
                   sublimation_mm(t, height_m);
    }
    return balance;
}

bool CoverColumn::has_ice(double height_m) const {
    const double balance = ice_balance_mm(height_m);
    return balance > 0 || (normals_.mapped_ice > 0.5 && balance > kMappedIce_mm);
}

Year CoverColumn::snow_mm(double height_m) const {
    const Year temperature = steps_of(temperature_c(height_m));
    Year gain;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double t = temperature[i];
        gain[i] =
            static_cast<float>(snowfall_mm(temperature, i) -
                               kMeltSnow_mm_k * kStep_days * spread_k_ * softplus(t / spread_k_) -
                               sublimation_mm(t, height_m));
    }
    // A year to begin with, from the warmest day, and then the year.
    const auto warmest =
        static_cast<std::size_t>(std::ranges::max_element(temperature) - temperature.begin());
    Year snow;
    float there = 0;
    for (std::size_t n = 0; n < 2 * kSteps; ++n) {
        const std::size_t i = (warmest + n) % kSteps;
        there = std::max(0.0f, there + gain[i]);
        snow[i] = there;
    }
    return snow;
}

double CoverColumn::snow_share(double height_m, double day) const {
    return snow_share(snow_on(snow_mm(height_m), day));
}

double snow_on(const Year& snow_mm, double day) {
    const double at = day / kStep_days - 1;  // of a step's end
    const double below = std::floor(at);
    const auto wrapped = [](double step) {
        return static_cast<std::size_t>(static_cast<int>(step) + kSteps) % kSteps;
    };
    const double first = snow_mm[wrapped(below)], second = snow_mm[wrapped(below + 1)];
    return first + (at - below) * (second - first);
}

double CoverColumn::green(double height_m, double day) const {
    constexpr double kFrom_c = 2, kFull_c = 10, kDry = 0.3, kMoist = 1;
    constexpr std::size_t kBefore = 12;  // steps: sixty days
    const Year temperature = steps_of(temperature_c(height_m));
    const auto now = static_cast<std::size_t>(day / kStep_days) % kSteps;
    // Leaves follow the warmth of weeks, not that of the day.
    constexpr std::size_t kWeeks = 4;
    double rain_mm = 0, warmth_c = 0, weeks_c = 0;
    for (std::size_t i = 0; i < kBefore; ++i) {
        const std::size_t step = (now + kSteps - i) % kSteps;
        rain_mm += rain_mm_[step];
        warmth_c += temperature[step] / kBefore;
        if (i < kWeeks) weeks_c += temperature[step] / kWeeks;
    }
    const double year_mm = rain_mm * kSteps / kBefore;
    const double limit_mm = std::max(20 * std::max(warmth_c, 0.0) + 140, 60.0);
    const auto ramp = [](double from, double to, double x) {
        const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    return ramp(kFrom_c, kFull_c, weeks_c) * ramp(kDry, kMoist, year_mm / limit_mm);
}

Cover CoverColumn::cover(double height_m, double day) const {
    if (has_ice(height_m)) return Cover::Ice;
    if (snow_share(height_m, day) > kSnowy) return Cover::Snow;
    const double warmth = growth(height_m), rain = dryness(height_m);
    if (warmth < kPlants) return Cover::Rock;
    if (rain < kSteppe) return Cover::Desert;
    if (rain < kGrass) return Cover::Steppe;
    return rain >= kForest && warmth >= kTrees ? Cover::Forest : Cover::Grass;
}

std::optional<double> CoverColumn::tree_line_m() const {
    return lowest([&](double height_m) { return growth(height_m) < kTrees; });
}

std::optional<double> CoverColumn::ice_line_m() const {
    return lowest([&](double height_m) { return ice_balance_mm(height_m) > 0; });
}

std::optional<double> CoverColumn::snow_line_m(double day) const {
    return lowest([&](double height_m) { return snow_share(height_m, day) > kSnowy; });
}

}  // namespace relevo::climate
