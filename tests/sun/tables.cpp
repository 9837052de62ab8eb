#include "sun/tables.h"

#include <cmath>

#include "base/text.h"
#include "base/units.h"

namespace relevo::sun {

bool Row::has(std::string_view column) const {
    for (std::size_t i = 0; i < csv_->header.size(); ++i)
        if (csv_->header[i] == column) return !csv_->rows[row_].at(i).empty();
    return false;
}

const std::string& Row::text(std::string_view column) const {
    return csv_->rows[row_].at(csv_->column(column));
}

double Row::number(std::string_view column) const {
    const auto value = parse_number(text(column));
    if (!value) bad_input("no number in column " + std::string(column) + ": " + whole());
    return *value;
}

std::string Row::whole() const {
    std::string line;
    for (const std::string& field : csv_->rows[row_])
        line += (line.empty() ? "" : ",") + field;
    return line;
}

geo::Geodetic Row::place() const {
    return {radians(number("lat_deg")), radians(number("lon_deg")),
            has("height_m") ? number("height_m") : 0.0};
}

Instant instant_of(std::string_view text) {
    const auto field = [&](std::size_t at, std::size_t length) {
        return *parse_number(text.substr(at, length));
    };
    CivilTime civil;
    civil.date = {static_cast<int>(field(0, 4)), static_cast<int>(field(5, 2)),
                  static_cast<int>(field(8, 2))};
    civil.hour = static_cast<int>(field(11, 2));
    civil.minute = static_cast<int>(field(14, 2));
    return Instant::from_utc(civil) + (text.size() > 17 ? field(17, text.size() - 17) : 0.0);
}

Instant Row::time() const {
    return instant_of(text("time"));
}

bool Row::in_years() const {
    const int year = time().utc().date.year;
    return year >= kFirstYear && year <= kLastYear;
}

Epoch Row::epoch() const {
    const Instant t = time();
    const EarthOrientation earth = EarthRotation::built_in().at(t);
    if (text("scale") == "UTC")
        return Epoch::from_utc(t, has("dut1_s") ? number("dut1_s") : earth.ut1_minus_utc_s);
    for (const char* column : {"delta_t_s", "delta_t_s_assumed"})
        if (has(column)) return Epoch::from_ut1(t, number(column));
    return Epoch::from_ut1(t, earth.tt_minus_utc_s);
}

std::vector<Row> rows_of(const test::Csv& csv) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < csv.rows.size(); ++i)
        rows.emplace_back(csv, i);
    return rows;
}

void SunTables::SetUp() {
    if (GetParam() == "published") {
        dir_ = test::source_dir() / "tests" / "data" / "sun";
    } else {
        SKIP_WITHOUT_TEST_DATA(outside);
        dir_ = outside / "sun";
    }
}

std::vector<Row> SunTables::rows(std::string_view file) {
    csv_ = test::read_csv(dir_ / file);
    EXPECT_FALSE(csv_.rows.empty()) << file;
    return rows_of(csv_);
}

Accuracy::Accuracy(std::string title, std::string unit, double limit)
    : title_(std::move(title)), unit_(std::move(unit)), limit_(limit) {}

Accuracy::~Accuracy() {
    EXPECT_FALSE(errors_.empty()) << title_;
    test::print_accuracy(title_, errors_, unit_, limit_);
}

void Accuracy::add(double error, const Row& row) {
    errors_.push_back(std::abs(error));
    EXPECT_LE(std::abs(error), limit_) << title_ << " [" << unit_ << "]: " << row.whole();
}

double rate_arcsec_s(Instant t, const geo::Geodetic& place) {
    return (position(t + 1, place).elevation_rad - position(t - 1, place).elevation_rad) / 2 /
           kArcsecond_rad;
}

double angle_between_deg(double a_deg, double b_deg) {
    return std::remainder(a_deg - b_deg, 360.0);
}

double separation_arcsec(double a_lon_deg, double a_lat_deg, double b_lon_deg, double b_lat_deg) {
    // Haversine: good to the last digit for small angles, near the zenith, too.
    const double lat = std::sin(radians(a_lat_deg - b_lat_deg) / 2);
    const double lon = std::sin(radians(angle_between_deg(a_lon_deg, b_lon_deg)) / 2);
    const double h =
        lat * lat + std::cos(radians(a_lat_deg)) * std::cos(radians(b_lat_deg)) * lon * lon;
    return 2 * std::asin(std::sqrt(h)) / kArcsecond_rad;
}

}  // namespace relevo::sun
