#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "path_integral.h"
#include "sky/atmosphere.h"
#include "sun/daylight.h"
#include "sun/position.h"
#include "support/sky_truth.h"

/// The path integral beside light that was measured. What is fitted and what is taken from
/// elsewhere: docs/accuracy-sky.md.
namespace relevo::skymaker {
namespace {

using sky::Air;
using sky::kWavelengths;

using Table = std::vector<std::vector<double>>;

/// Rows of numbers; what is none is skipped.
Table read_numbers(const std::filesystem::path& file, char separator = ' ') {
    std::ifstream stream(file);
    EXPECT_TRUE(stream) << file;
    Table table;
    for (std::string line; std::getline(stream, line);) {
        std::replace(line.begin(), line.end(), separator, ' ');
        std::istringstream words(line);
        std::vector<double> row;
        for (double value; words >> value;)
            row.push_back(value);
        if (row.size() > 1) table.push_back(row);
    }
    return table;
}

/// Mean of a column over the 20 nm around each wavelength.
Spectrum bands(const Table& table, std::size_t column) {
    Spectrum result{};
    for (int i = 0; i < kWavelengths; ++i) {
        double sum = 0;
        int count = 0;
        for (const auto& row : table) {
            if (std::abs(row[0] - 1e3 * sky::wavelength_um(i)) > 10) continue;
            sum += row[column];
            ++count;
        }
        result[static_cast<std::size_t>(i)] = sum / count;
    }
    return result;
}

/// Integral of a column over wavelengths [nm].
double integral_of(const Table& table, std::size_t column, double from, double to) {
    double sum = 0;
    for (std::size_t i = 1; i < table.size(); ++i)
        if (table[i - 1][0] >= from && table[i][0] <= to)
            sum +=
                0.5 * (table[i][column] + table[i - 1][column]) * (table[i][0] - table[i - 1][0]);
    return sum;
}

double root_mean_square(const std::vector<double>& errors) {
    double sum = 0;
    for (const double error : errors)
        sum += error * error;
    return std::sqrt(sum / static_cast<double>(errors.size()));
}

/// Light on a surface that is tilted towards the sun's azimuth, as shares of the sun's.
struct Light {
    Spectrum direct{}, diffuse{};
    Spectrum all() const {
        Spectrum sum = direct;
        for (std::size_t k = 0; k < kWavelengths; ++k)
            sum[k] += diffuse[k];
        return sum;
    }
};
Light light_of(const Air& air, double sun_deg, double height_m, double tilt_deg, int paths) {
    const PathIntegral integral(medium_of(air), radians(sun_deg));
    Light light;
    light.direct = integral.transmittance({height_m, radians(sun_deg), 0});
    for (double& share : light.direct)
        share *= std::sin(radians(sun_deg + tilt_deg));
    light.diffuse = mean(integral.irradiance(height_m, {.paths = paths}, radians(tilt_deg)));
    return light;
}

/// ASTM G173-03: the sun 41.81 degrees high (air mass 1.5), aerosol 0.084 at 500 nm, ozone 343.8
/// Dobson units; a surface tilted by 37 degrees over light sandy soil.
TEST(MeasuredLight, SpectraOfAstmG173) {
    SKIP_WITHOUT_TEST_DATA(folder);
    const Table table = read_numbers(folder / "sky/astm-g173.txt", '\t');
    const Spectrum outside = bands(table, 1), tilted = bands(table, 2), facing = bands(table, 3);
    const Air air{
        .angstrom_beta = 0.084 * std::pow(0.5, 1.3), .ozone_du = 343.8, .ground_albedo = 0.25};
    constexpr double kSun_deg = 41.81;
    const Spectrum through =
        PathIntegral(medium_of(air), radians(kSun_deg)).transmittance({0, radians(kSun_deg), 0});
    const Spectrum programs =
        sky::Atmosphere(air, sky::DiffuseTable()).sunlight(sky::SunRays(0), radians(kSun_deg));
    const Spectrum on_tilt = light_of(air, kSun_deg, 0, 37, 600).all();
    std::vector<double> direct, global, of_program;
    for (int i = 0; i < kWavelengths; ++i) {
        const auto k = static_cast<std::size_t>(i);
        direct.push_back(through[k] * outside[k] - facing[k]);
        of_program.push_back(programs[k] * outside[k] - facing[k]);
        global.push_back(on_tilt[k] * outside[k] - tilted[k]);
        fmt::print(
            "[ sky ] {:.0f} nm: direct {:.3f} W/m2/nm, ASTM {:.3f}; on the tilt {:.3f}, ASTM "
            "{:.3f}\n",
            1e3 * sky::wavelength_um(i), through[k] * outside[k], facing[k],
            on_tilt[k] * outside[k], tilted[k]);
    }
    fmt::print(
        "[ accuracy ] ASTM G173, 400 to 700 nm: RMSE direct {:.3f} W/m2/nm ({:.1f} %), on a "
        "tilt of 37 degrees {:.3f} ({:.1f} %)\n",
        root_mean_square(direct), 100 * root_mean_square(direct) / 1.28, root_mean_square(global),
        100 * root_mean_square(global) / 1.43);
    fmt::print("[ accuracy ] ASTM G173, the program's direct light: RMSE {:.3f} W/m2/nm\n",
               root_mean_square(of_program));
    EXPECT_LT(root_mean_square(direct), 0.05);
    EXPECT_LT(root_mean_square(of_program), 0.05);
    EXPECT_LT(root_mean_square(global), 0.11);
}

/// Global irradiance of level ground of Ithaca on 27 May 2013 (J. T. Kider and others, A Framework
/// for the Experimental Comparison of Solar and Skydome Illumination, ACM Transactions on Graphics
/// 33(6), 2014): minutes since an unstated start, clear up to minute 385.
class KidersDay {
  public:
    explicit KidersDay(const Table& table) {
        for (const auto& row : table)
            if (row[0] < kClear_min) rows_.push_back(row);
        double best = 1e9;
        for (double noon = 200; noon < 240; noon += 0.5)
            if (const double error = asymmetry(noon); error < best) {
                best = error;
                noon_min_ = noon;
            }
    }

    double noon_min() const { return noon_min_; }
    const Table& rows() const { return rows_; }

  private:
    static constexpr double kClear_min = 385;

    double at(double minute) const {
        const auto next = std::lower_bound(
            rows_.begin(), rows_.end(), minute,
            [](const std::vector<double>& row, double value) { return row[0] < value; });
        if (next == rows_.begin()) return rows_.front()[1];
        if (next == rows_.end()) return rows_.back()[1];
        const auto& a = *(next - 1);
        const auto& b = *next;
        return a[1] + (b[1] - a[1]) * (minute - a[0]) / (b[0] - a[0]);
    }
    /// Median difference between minutes as long before a noon as after.
    double asymmetry(double noon) const {
        std::vector<double> differences;
        for (double apart = 20; apart < kClear_min - noon && apart <= noon; ++apart)
            differences.push_back(std::abs(at(noon - apart) - at(noon + apart)));
        std::sort(differences.begin(), differences.end());
        return differences[differences.size() / 2];
    }

    Table rows_;
    double noon_min_ = 0;
};

/// The polynomial through values at nodes (Lagrange's).
template <std::size_t N>
double through(const std::array<double, N>& nodes, const std::array<double, N>& values, double x) {
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
        double term = values[i];
        for (std::size_t j = 0; j < N; ++j)
            if (j != i) term *= (x - nodes[j]) / (nodes[i] - nodes[j]);
        sum += term;
    }
    return sum;
}

/// Irradiance of level ground by aerosol and by the sine of the sun's elevation [W/m2].
class ClearDay {
  public:
    static constexpr std::array<double, 3> kBetas{0.03, 0.1, 0.2};

    /// @param scale  from 400-700 nm to all wavelengths, and by the sun's distance
    ClearDay(double height_m, double scale) {
        for (std::size_t b = 0; b < kBetas.size(); ++b) {
            for (std::size_t i = 0; i < kSines.size(); ++i) {
                const Air air{.angstrom_beta = kBetas[b], .ground_albedo = 0.2};
                const double sun_deg = degrees(std::asin(kSines[i]));
                const Spectrum light = light_of(air, sun_deg, height_m, 0, 300).all();
                for (std::size_t k = 0; k < kWavelengths; ++k) {
                    const double width_nm = k == 0 || k + 1 == kWavelengths ? 10 : 20;
                    watts_[b][i] += scale * width_nm * light[k] * sky::solar_irradiance()[k];
                }
            }
        }
    }
    double at(double beta, double sine) const {
        std::array<double, kBetas.size()> values{};
        for (std::size_t b = 0; b < kBetas.size(); ++b)
            values[b] = through(kSines, watts_[b], sine);
        return through(kBetas, values, beta);
    }

  private:
    static constexpr std::array<double, 4> kSines{0.45, 0.65, 0.8, 0.95};
    std::array<std::array<double, kSines.size()>, kBetas.size()> watts_{};
};

/// Level irradiance from 400 to 700 nm of the program's default air [W/m2].
double programs_irradiance(double height_m, double sun_sine) {
    static const sky::Atmosphere kAir;
    static const sky::SunRays kRays(height_m);
    const Spectrum direct = kAir.sunlight(kRays, std::asin(sun_sine)),
                   diffuse = kAir.sky_irradiance(height_m, sun_sine);
    double sum = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        const double width_nm = k == 0 || k + 1 == kWavelengths ? 10 : 20;
        sum += width_nm * sky::solar_irradiance()[k] * (sun_sine * direct[k] + diffuse[k]);
    }
    return sum;
}

TEST(MeasuredLight, IrradianceOfAClearDayInIthaca) {
    SKIP_WITHOUT_TEST_DATA(folder);
    const KidersDay day(read_numbers(folder / "sky/kider_2013-05-27_ghi.txt"));
    const Table astm = read_numbers(folder / "sky/astm-g173.txt", '\t');
    const double broadband = integral_of(astm, 2, 280, 4000) / integral_of(astm, 2, 400, 700);
    const sun::Geocentric sun =
        sun::geocentric(sun::Epoch::at(sun::Instant::from_unix_us(1369674000'000000)));  // 17 UTC
    const ClearDay clear(300, broadband / std::pow(sun.distance_au, 2));
    const double lat = radians(42.44);
    std::vector<double> sines, measured;
    for (const auto& row : day.rows()) {
        const double hour = radians((row[0] - day.noon_min()) / 4);
        sines.push_back(std::sin(lat) * std::sin(sun.declination_rad) +
                        std::cos(lat) * std::cos(sun.declination_rad) * std::cos(hour));
        measured.push_back(row[1]);
    }
    const auto errors_of = [&](double beta, double times) {
        std::vector<double> errors(sines.size());
        for (std::size_t i = 0; i < sines.size(); ++i)
            errors[i] = times * clear.at(beta, sines[i]) - measured[i];
        return errors;
    };
    double best = 1e9, best_beta = 0;
    for (double beta = 0.02; beta < 0.255; beta += 0.01)
        if (const double error = root_mean_square(errors_of(beta, 1)); error < best) {
            best = error;
            best_beta = beta;
        }
    // With the aerosol of Relevo's own air the share of the infrared is fitted instead: water
    // vapour, which that day's is unknown, takes part of it.
    double both = 0, squares = 0;
    for (std::size_t i = 0; i < sines.size(); ++i) {
        both += clear.at(0.04, sines[i]) * measured[i];
        squares += std::pow(clear.at(0.04, sines[i]), 2);
    }
    const double infrared = both / squares, error = root_mean_square(errors_of(0.04, infrared));
    fmt::print(
        "[ accuracy ] Ithaca, 27 May 2013: {} values, true noon at minute {:.1f}; all light "
        "{:.3f} of that from 400 to 700 nm and beta {:.2f} (fitted): RMSE {:.1f} W/m2 of "
        "1000; {:.3f} (fitted) and beta 0.04: RMSE {:.1f}\n",
        sines.size(), day.noon_min(), broadband, best_beta, best, infrared * broadband, error);
    double scaled = 0, of_program = 0;
    std::vector<double> program;
    for (const double sine : sines)
        program.push_back(programs_irradiance(300, sine));
    for (std::size_t i = 0; i < sines.size(); ++i) {
        scaled += program[i] * measured[i];
        of_program += program[i] * program[i];
    }
    std::vector<double> differences;
    for (std::size_t i = 0; i < sines.size(); ++i)
        differences.push_back(scaled / of_program * program[i] - measured[i]);
    fmt::print(
        "[ accuracy ] Ithaca, the program's default air: all light {:.3f} of that from 400 to 700 "
        "nm (fitted): RMSE {:.1f} W/m2\n",
        scaled / of_program * std::pow(sun.distance_au, 2), root_mean_square(differences));
    EXPECT_LT(root_mean_square(differences), 20);
    EXPECT_NEAR(day.noon_min(), 217, 2);
    EXPECT_LT(best, 20);
    EXPECT_LT(error, 20);
    EXPECT_NEAR(infrared, 1, 0.06);
}

/// P. Balakrishnan, Equatorial skies, 2019: spectra of level ground under clear skies, Singapore.
/// Their scale is unknown, so shapes are compared. A cloud may have stood before the sun: how much
/// of the direct light is there is fitted, as is the aerosol.
struct Shape {
    double error = 1e9, beta = 0, direct = 0;
    std::array<double, kWavelengths> errors{};
};
Shape fit_shape(const Spectrum& measured, const Spectrum& outside, double sun_deg) {
    const auto mean_of = [](const Spectrum& s) {
        double sum = 0;
        for (const double value : s)
            sum += value / kWavelengths;
        return sum;
    };
    Shape best;
    for (const double beta : {0.03, 0.1, 0.2, 0.4}) {
        const Air air{.angstrom_beta = beta, .ozone_du = 255, .ground_albedo = 0.15};
        const Light light = light_of(air, sun_deg, 0, 0, 200);
        for (double direct = 0; direct <= 1.01; direct += 0.1) {
            Spectrum model{};
            for (std::size_t k = 0; k < kWavelengths; ++k)
                model[k] = outside[k] * (direct * light.direct[k] + light.diffuse[k]);
            Shape shape{0, beta, direct, {}};
            for (std::size_t k = 0; k < kWavelengths; ++k)
                shape.errors[k] = model[k] / mean_of(model) / (measured[k] / mean_of(measured)) - 1;
            shape.error = root_mean_square({shape.errors.begin(), shape.errors.end()});
            if (shape.error < best.error) best = shape;
        }
    }
    return best;
}

TEST(MeasuredLight, SpectraOfClearSkiesOverSingapore) {
    SKIP_WITHOUT_TEST_DATA(folder);
    struct Case {
        const char* name;
        std::int64_t unix_s;
    };
    const Spectrum outside = bands(read_numbers(folder / "sky/astm-g173.txt", '\t'), 1);
    for (const Case& c : {Case{"13Feb18-1122-CS-6861K", 1518492120},     // 03:22 UTC
                          Case{"24May18-1239-CS-6452K", 1527136740},     // 04:39 UTC
                          Case{"28Jul18-1511-CS-5811K", 1532761860}}) {  // 07:11 UTC
        const Spectrum measured =
            bands(read_numbers(folder / fmt::format("sky/singapore_{}.csv", c.name), ','), 1);
        const double sun_deg = degrees(sun::position(sun::Instant::from_unix_us(c.unix_s * 1000000),
                                                     {radians(1.34), radians(103.96), 20})
                                           .elevation_rad);
        const Shape shape = fit_shape(measured, outside, sun_deg);
        fmt::print(
            "[ accuracy ] Singapore {}, sun {:.1f} degrees, shape of 400 to 700 nm, fitted "
            "beta {:.2f} and {:.0f} % of the direct light: RMSE {:.1f} %\n",
            c.name, sun_deg, shape.beta, 100 * shape.direct, 100 * shape.error);
        std::string text = "[ sky ]";
        for (std::size_t k = 0; k < kWavelengths; ++k)
            text += fmt::format(" {}: {:+.1f} %", 400 + 20 * k, 100 * shape.errors[k]);
        fmt::print("{}\n", text);
        EXPECT_LT(shape.error, 0.08) << c.name;
    }
}

/// Illuminance of level ground at dusk: P. K. Seidelmann (ed.), Explanatory Supplement to the
/// Astronomical Almanac, 1992, p. 491, a fit to measurements. Days differ by a factor of two.
TEST(MeasuredLight, IlluminanceOfDusk) {
    const std::vector<std::pair<double, double>> published{
        {-2, 189.4}, {-4, 29.93}, {-6, 3.412}, {-8, 0.3481}};
    double largest = 1;
    for (const test::SkyRow& row : test::sky_truth("sky_truth_level.csv")) {
        if (row.air != "clean" || row.height_m != 0) continue;
        for (const auto& [sun_deg, lux] : published) {
            if (row.sun_deg != sun_deg) continue;
            const double ratio = sun::kSolarIlluminance_lux * row.luminance / lux;
            fmt::print("[ sky ] sun {:.0f} degrees: {:.4g} lux, published {:.4g}: {:.2f} of it\n",
                       sun_deg, lux * ratio, lux, ratio);
            largest = std::max({largest, ratio, 1 / ratio});
        }
    }
    fmt::print(
        "[ accuracy ] illuminance of dusk, -2 to -8 degrees: within a factor of {:.2f} of the "
        "Explanatory Supplement's\n",
        largest);
    EXPECT_GT(largest, 1);
    EXPECT_LT(largest, 1.4);
}

}  // namespace
}  // namespace relevo::skymaker
