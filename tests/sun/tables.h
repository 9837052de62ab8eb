#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geo/geodetic.h"
#include "sun/position.h"
#include "sun/time.h"
#include "support/support.h"

namespace relevo::sun {

/// One row of a table of positions or events, its columns by name.
class Row {
  public:
    Row(const test::Csv& csv, std::size_t row) : csv_(&csv), row_(row) {}

    bool has(std::string_view column) const;  ///< the column exists and is not empty here
    const std::string& text(std::string_view column) const;
    double number(std::string_view column) const;
    std::string whole() const;

    geo::Geodetic place() const;  ///< lat_deg, lon_deg, height_m (0 if there is none)
    Instant time() const;         ///< column "time", as it stands
    bool in_years() const;        ///< column "time" is of 1900-2100
    /// With the row's own TT-UT1 or UT1-UTC where it has one, and the pole at its conventional
    /// place, so that the ephemeris and the rotation of the Earth are tested separately.
    Epoch epoch() const;

  private:
    const test::Csv* csv_;
    std::size_t row_;
};

/// "2026-06-21T18:30:15.2", without a zone, read as UTC.
Instant instant_of(std::string_view text);

/// A test that runs twice over tables of the same form: the published rows in tests/data/sun, and
/// the larger tables outside the project, where they are.
class SunTables : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override;
    /// @returns its rows; fails the test if there is none
    std::vector<Row> rows(std::string_view file);

    std::filesystem::path dir_;
    test::Csv csv_;
};

/// Rows of a table that is only outside the project; skips the test if it is not there.
#define OUTSIDE_ROWS(variable, csv, file)                                                    \
    SKIP_WITHOUT_TEST_DATA(variable##_dir);                                                  \
    const ::relevo::test::Csv csv = ::relevo::test::read_csv(variable##_dir / "sun" / file); \
    const std::vector<::relevo::sun::Row> variable = ::relevo::sun::rows_of(csv);            \
    ASSERT_FALSE(variable.empty())

std::vector<Row> rows_of(const test::Csv& csv);

/// Collects the errors of a table, each against the limit, and prints the figures at the end.
class Accuracy {
  public:
    Accuracy(std::string title, std::string unit, double limit);
    ~Accuracy();
    void add(double error, const Row& row);

  private:
    std::string title_, unit_;
    double limit_;
    std::vector<double> errors_;
};

/// Angle on the sky between two directions given as azimuth and elevation (or right ascension and
/// declination) in degrees [arcsec].
double separation_arcsec(double a_lon_deg, double a_lat_deg, double b_lon_deg, double b_lat_deg);

/// How fast the sun rises (or, negative, sets) then [arcsec/s].
double rate_arcsec_s(Instant t, const geo::Geodetic& place);

/// a - b as an angle within half a turn [deg].
double angle_between_deg(double a_deg, double b_deg);

}  // namespace relevo::sun
