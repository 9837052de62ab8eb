#include "sun/zone_of_place.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"

namespace relevo::sun {

namespace {

constexpr const char* kZoneWho = "time zone";
constexpr const char* kRemedy = "; install Relevo again, or pass --tz Europe/Zurich";
constexpr const char* kAuto = "auto";
constexpr const char* kSolar = "solar";

/// FNV-1a, 64 bits: G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, The FNV Non-Cryptographic Hash
/// Algorithm, IETF draft-eastlake-fnv.
std::uint64_t fnv_1a(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes)
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    return hash;
}

}  // namespace

/// Reads what tools/make_time_zones.py describes.
class ZoneMapReader {
  public:
    explicit ZoneMapReader(const std::filesystem::path& path)
        : path_(path.string()), bytes_(bytes_of(path)), rest_(bytes_) {}

    ZoneMap run() {
        if (line() != "relevo time zones 1") damaged("no map of time zones of this version");
        check_hash();
        ZoneMap map;
        const std::vector<std::string> sizes = split(line(), ' ');
        if (sizes.size() != 3) damaged();
        map.columns_ = size(sizes[0]);
        map.rows_ = size(sizes[1]);
        const int names = size(sizes[2]);
        for (int i = 0; i < names; ++i)
            map.names_.emplace_back(line());
        for (int row = 0; row < map.rows_; ++row) {
            const int cells = row_spans(map);
            if (row == 0 && cells != map.columns_) damaged();  // there is none above to take from
            map.row_ends_.push_back(map.spans_.size());
        }
        if (!rest_.empty()) damaged();
        return map;
    }

  private:
    [[noreturn]] void damaged(const char* what = "damaged") const {
        bad_input(fmt::format("{}: {}: {}{}", kZoneWho, path_, what, kRemedy));
    }

    static std::string bytes_of(const std::filesystem::path& path) {
        try {
            return read_text(path, kZoneWho);
        } catch (const Error& error) {
            bad_input(error.what() + std::string(kRemedy));
        }
    }

    void check_hash() {
        constexpr std::size_t kBytes = 8;
        if (rest_.size() < kBytes) damaged();
        const std::string_view whole = std::string_view(bytes_).substr(0, bytes_.size() - kBytes);
        std::uint64_t hash = 0;
        for (std::size_t i = 0; i < kBytes; ++i)
            hash |= std::uint64_t{static_cast<unsigned char>(bytes_[whole.size() + i])} << (8 * i);
        if (hash != fnv_1a(whole)) damaged();
        rest_.remove_suffix(kBytes);
    }

    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        if (end == std::string_view::npos) damaged();
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return line;
    }

    int size(const std::string& text) const {
        constexpr double kLargest = 65536;
        const auto value = parse_number(text);
        if (!value || !(*value >= 1 && *value <= kLargest)) damaged();
        return static_cast<int>(*value);
    }

    /// A number below `limit`.
    int number(int limit) {
        int value = 0;
        for (int shift = 0; shift < 21; shift += 7) {
            if (rest_.empty()) damaged();
            const auto byte = static_cast<unsigned char>(rest_.front());
            rest_.remove_prefix(1);
            value |= (byte & 127) << shift;
            if (byte < 128) {
                if (value >= limit) damaged();
                return value;
            }
        }
        damaged();
    }

    /// @returns how many cells there are in its spans
    int row_spans(ZoneMap& map) {
        int cell = 0, cells = 0;
        const int count = number(map.columns_ + 1);
        for (int i = 0; i < count; ++i) {
            const int first = cell + number(map.columns_ - cell);
            const int end = first + number(map.columns_ - first + 1);
            map.spans_.push_back({first, end, number(static_cast<int>(map.names_.size()))});
            cell = end;
            cells += end - first;
        }
        return cells;
    }

    std::string path_, bytes_;
    std::string_view rest_;
};

ZoneMap ZoneMap::read(const std::filesystem::path& path) {
    return ZoneMapReader(path).run();
}

ZoneMap ZoneMap::shipped() {
    return read(share_dir() / "data/timezones/timezones.bin");
}

const std::string& ZoneMap::name_at(const geo::Geodetic& place) const {
    const double lon_deg = geo::normalized_lon_deg(degrees(place.lon_rad));
    const auto cell = [](double share, int count) {
        return std::clamp(static_cast<int>(std::floor(share * count)), 0, count - 1);
    };
    const int column = cell((lon_deg + 180) / 360, columns_);
    const int row = cell((90 - degrees(place.lat_rad)) / 180, rows_);
    int name = 0;
    const std::size_t end = row_ends_[static_cast<std::size_t>(row)];
    for (std::size_t i = 0; i < end; ++i)
        if (spans_[i].first <= column && column < spans_[i].end) name = spans_[i].name;
    return names_[static_cast<std::size_t>(name)];
}

ChosenZone zone_at(const geo::Geodetic& place, const ZoneMap& map) {
    const std::string& name = map.name_at(place);
    if (auto zone = Zone::find(name)) {
        // Their signs are the other way round: Etc/GMT+3 is three hours behind.
        const std::string offset =
            name.starts_with("Etc/")
                ? fmt::format(" ({})", offset_text(zone->local(Instant()).utc_offset_s))
                : "";
        return {*zone, fmt::format("time zone {}{} of the place", name, offset)};
    }
    constexpr double kHour_deg = 15;
    const double lon_deg = geo::normalized_lon_deg(degrees(place.lon_rad));
    const Zone fixed = Zone::fixed(static_cast<int>(std::lround(lon_deg / kHour_deg)) * 3600);
    return {fixed,
            fmt::format("time zone {}, by longitude only: the time zone database of this computer "
                        "(version {}) has no {}",
                        fixed.name(), zone_database_version(), name),
            true};
}

bool is_zone_by_place(std::string_view words) {
    return trimmed(words).empty() || equal_ignoring_case(trimmed(words), kAuto) ||
           is_solar_zone(words);
}

bool is_solar_zone(std::string_view words) {
    return equal_ignoring_case(trimmed(words), kSolar);
}

ChosenZone choose_zone(std::string_view words, const geo::Geodetic& place) {
    if (!is_zone_by_place(words)) return {Zone::named(words), {}};
    if (is_solar_zone(words)) return {Zone::mean_solar(place.lon_rad), {}};
    return zone_at(place, ZoneMap::shipped());
}

}  // namespace relevo::sun
