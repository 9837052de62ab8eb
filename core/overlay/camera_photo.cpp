#include "overlay/camera_photo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"

namespace relevo::overlay {
namespace {

/// The Exif fields of a file, as GDAL has them: numbers in parentheses, "(46) (33) (12.5)".
class Exif {
  public:
    explicit Exif(void* dataset) : dataset_(dataset) {}

    std::string text(const char* field) const {
        const std::string name = std::string("EXIF_") + field;
        const char* const value = GDALGetMetadataItem(dataset_, name.c_str(), nullptr);
        return std::string(trimmed(value ? value : ""));
    }
    std::vector<double> numbers(const char* field) const {
        std::string bare = text(field);
        std::ranges::replace(bare, ')', '(');
        std::vector<double> values;
        for (const std::string& part : split(bare, '(')) {
            const std::string_view word = trimmed(part);
            if (word.empty()) continue;
            const std::optional<double> value = parse_number(word);
            if (!value) return {};
            values.push_back(*value);
        }
        return values;
    }
    std::optional<double> number(const char* field) const {
        const std::vector<double> values = numbers(field);
        return values.size() == 1 && std::isfinite(values.front()) ? std::optional(values.front())
                                                                   : std::nullopt;
    }

  private:
    void* dataset_;
};

/// Degrees of "degrees, minutes, seconds"; negative for `negative` in the field of the direction.
std::optional<double> angle_deg(const Exif& exif, const char* field, const char* direction,
                                char negative, double most_deg) {
    const std::vector<double> parts = exif.numbers(field);
    if (parts.empty() || parts.size() > 3) return std::nullopt;
    double deg = 0, unit = 1;
    for (const double part : parts) {
        deg += part * unit;
        unit /= 60;
    }
    if (!(deg >= 0 && deg <= most_deg)) return std::nullopt;
    return exif.text(direction).starts_with(negative) ? -deg : deg;
}

std::optional<geo::Geodetic> place_of(const Exif& exif) {
    const auto lat = angle_deg(exif, "GPSLatitude", "GPSLatitudeRef", 'S', 90);
    const auto lon = angle_deg(exif, "GPSLongitude", "GPSLongitudeRef", 'W', 180);
    if (!lat || !lon) return std::nullopt;
    double height_m = exif.number("GPSAltitude").value_or(std::numeric_limits<double>::quiet_NaN());
    const std::string below = exif.text("GPSAltitudeRef");
    if (below == "1" || below == "0x01" || below == "01") height_m = -height_m;
    return geo::geodetic_deg(*lat, *lon, height_m);
}

/// "2026-06-21" of "2026:06:21"; empty for anything else.
std::string date_of(const std::string& text) {
    const std::vector<std::string> parts = split(text.substr(0, 10), ':');
    if (parts.size() != 3 || text.size() < 10) return "";
    return parts[0] + "-" + parts[1] + "-" + parts[2];
}

/// Of the camera's clock, whose offset newer cameras write; else of the GPS, which is in UTC.
std::string time_of(const Exif& exif) {
    const std::string taken = exif.text("DateTimeOriginal");
    const std::string date = date_of(taken);
    const std::string local =
        date.empty() || taken.size() < 19 ? "" : date + "T" + taken.substr(11, 8);
    const std::string offset = exif.text("OffsetTimeOriginal");
    if (!local.empty() && offset.size() == 6) return local + offset;
    const std::string gps_date = date_of(exif.text("GPSDateStamp"));
    const std::vector<double> clock = exif.numbers("GPSTimeStamp");
    if (!gps_date.empty() && clock.size() == 3)
        return fmt::format("{}T{:02.0f}:{:02.0f}:{:02.0f}Z", gps_date, clock[0], clock[1],
                           std::floor(clock[2]));
    return local;
}

}  // namespace

std::optional<CameraPhoto> camera_photo(const std::string& path) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    const dem::Dataset dataset = dem::gdal_open(AllowedName(path));
    if (!dataset) return std::nullopt;
    const Exif exif(dataset.get());
    CameraPhoto photo;
    photo.place = place_of(exif);
    photo.heading_deg = exif.number("GPSImgDirection");
    if (photo.heading_deg && !(*photo.heading_deg >= 0 && *photo.heading_deg <= 360))
        photo.heading_deg.reset();
    photo.is_magnetic = photo.heading_deg && exif.text("GPSImgDirectionRef").starts_with('M');
    photo.focal_length_mm = exif.number("FocalLengthIn35mmFilm");
    if (photo.focal_length_mm && *photo.focal_length_mm <= 0) photo.focal_length_mm.reset();
    photo.time = time_of(exif);
    if (!photo.place && photo.time.empty() && !photo.focal_length_mm) return std::nullopt;
    photo.width_px = GDALGetRasterXSize(dataset.get());
    photo.height_px = GDALGetRasterYSize(dataset.get());
    // From 5 on the file's rows are the columns of the upright picture.
    if (exif.number("Orientation").value_or(1) >= 5) std::swap(photo.width_px, photo.height_px);
    return photo;
}

}  // namespace relevo::overlay
