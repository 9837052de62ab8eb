#include "climate/climate_map.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"

namespace relevo::climate {
namespace {

constexpr const char* kWho = "climate";
constexpr const char* kRemedy = "; install Relevo again";

/// The grids in the file's order.
enum Layer { kTemperature, kRelief, kRain, kShare, kIce, kLayers };
constexpr std::array<std::string_view, kLayers> kNames{"temperature", "relief", "rain", "share",
                                                       "ice"};
constexpr std::array<int, kLayers> kPlanes{12, 1, 1, 12, 1};
constexpr std::array<int, kLayers> kBits{16, 16, 8, 8, 1};

/// A grid of the whole Earth: where its bands are, and those that have been unpacked.
struct Grid {
    int columns = 0, rows = 0, planes = 0, bits = 0, band_rows = 0;
    std::vector<std::string_view> packed;                  // a band each, of the file's bytes
    std::vector<std::optional<std::vector<short>>> bands;  // plane after plane, row after row;
                                                           // of single bits eight a value

    std::size_t cells(int band) const {
        const int of_band = std::min(band_rows, rows - band * band_rows);
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(of_band);
    }
};

std::string bytes_of(const std::filesystem::path& path) {
    try {
        return read_text(path, kWho);
    } catch (const Error& error) {
        bad_input(error.what() + std::string(kRemedy));
    }
}

}  // namespace

struct ClimateMap::Impl {
    std::string path, bytes;
    std::array<Grid, kLayers> grids;
    std::mutex unpacking;

    [[noreturn]] void damaged(const char* what = "damaged") const {
        bad_input(fmt::format("{}: {}: {}{}", kWho, path, what, kRemedy));
    }

    std::string_view line(std::string_view& rest) const {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) damaged();
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        return line;
    }

    void read_head() {
        std::string_view rest = bytes;
        if (line(rest) != "relevo climate 1") damaged("no map of the climate of this version");
        for (std::size_t i = 0; i < kLayers; ++i) {
            const std::vector<std::string> words = split(line(rest), ' ');
            if (words.size() != 6 || words[0] != kNames[i]) damaged();
            std::array<int, 5> numbers{};
            for (std::size_t k = 0; k < numbers.size(); ++k) {
                constexpr double kLargest = 65536;
                const auto value = parse_number(words[k + 1]);
                if (!value || !(*value >= 1 && *value <= kLargest)) damaged();
                numbers[k] = static_cast<int>(*value);
            }
            grids[i] = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], {}, {}};
            if (grids[i].planes != kPlanes[i] || grids[i].bits != kBits[i]) damaged();
        }
        if (line(rest) != "end") damaged();
        read_bands(rest);
    }

    void read_bands(std::string_view rest) {
        constexpr std::size_t kSizeBytes = 4;
        std::size_t count = 0;
        for (Grid& grid : grids) {
            const int bands = (grid.rows + grid.band_rows - 1) / grid.band_rows;
            grid.packed.resize(static_cast<std::size_t>(bands));
            grid.bands.resize(grid.packed.size());
            count += grid.packed.size();
        }
        if (rest.size() < kSizeBytes * count) damaged();
        std::string_view sizes = rest.substr(0, kSizeBytes * count);
        rest.remove_prefix(sizes.size());
        for (Grid& grid : grids) {
            for (std::string_view& band : grid.packed) {
                std::size_t size = 0;
                for (std::size_t i = 0; i < kSizeBytes; ++i)
                    size |= std::size_t{static_cast<unsigned char>(sizes[i])} << (8 * i);
                sizes.remove_prefix(kSizeBytes);
                if (size > rest.size()) damaged();
                band = rest.substr(0, size);
                rest.remove_prefix(size);
            }
        }
        if (!rest.empty()) damaged();
    }

    /// The bytes of a band of a grid, whose checksum zlib compares.
    std::vector<unsigned char> inflated(std::string_view packed, std::size_t size) const {
        std::vector<unsigned char> data(size);
        uLongf got = size;
        if (uncompress(data.data(), &got, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()) != Z_OK ||
            got != size)
            damaged();
        return data;
    }

    /// What tools/make_climate.py describes.
    std::vector<short> unpacked(const Grid& grid, int band) const {
        const std::size_t cells = grid.cells(band), planes = static_cast<std::size_t>(grid.planes);
        const std::size_t count = cells * planes, width = static_cast<std::size_t>(grid.columns);
        const std::vector<unsigned char> data =
            inflated(grid.packed[static_cast<std::size_t>(band)],
                     count * static_cast<std::size_t>(grid.bits) / 8);
        if (grid.bits == 1) return {data.begin(), data.end()};
        std::vector<short> values(count);
        unsigned left = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (i % width == 0) left = 0;
            left += data[i];
            if (grid.bits == 16) left += unsigned{data[count + i]} << 8;
            const unsigned value = grid.bits == 8 ? left & 255 : left & 65535;
            values[i] = static_cast<short>(value);
            if (grid.bits == 16 && i >= cells)
                values[i] = static_cast<short>(values[i] + values[i - cells]);
        }
        return values;
    }

    const std::vector<short>& band(Layer layer, int index) {
        Grid& grid = grids[layer];
        std::optional<std::vector<short>>& band = grid.bands[static_cast<std::size_t>(index)];
        if (!band) band = unpacked(grid, index);
        return *band;
    }

    double cell(Layer layer, int plane, int column, int row) {
        const Grid& grid = grids[layer];
        const int index = row / grid.band_rows;
        const std::vector<short>& values = band(layer, index);
        const std::size_t at = static_cast<std::size_t>(row % grid.band_rows) *
                                   static_cast<std::size_t>(grid.columns) +
                               static_cast<std::size_t>(column);
        if (grid.bits == 1) return values[at / 8] >> (7 - at % 8) & 1;
        return values[static_cast<std::size_t>(plane) * grid.cells(index) + at];
    }

    /// Of all cells of a row.
    double mean(Layer layer, int plane, int row, double (*value_of)(double)) {
        double sum = 0;
        for (int column = 0; column < grids[layer].columns; ++column)
            sum += value_of(cell(layer, plane, column, row));
        return sum / grids[layer].columns;
    }

    /// Bilinear between the middles of cells, round the Earth. Beyond the last row it goes to that
    /// row's mean at the pole, where all longitudes are one place.
    void bilinear(Layer layer, const geo::Geodetic& place, std::span<double> planes,
                  double (*value_of)(double)) {
        const Grid& grid = grids[layer];
        const double from_north = (90 - degrees(place.lat_rad)) * grid.rows / 180 - 0.5;
        const double y = std::clamp(from_north, 0.0, grid.rows - 1.0);
        const double polar = std::min(2 * std::abs(from_north - y), 1.0);
        double x = (degrees(place.lon_rad) + 180) * grid.columns / 360 - 0.5;
        x -= std::floor(x / grid.columns) * grid.columns;
        const int row = std::min(static_cast<int>(y), grid.rows - 2);
        const int column = std::min(static_cast<int>(x), grid.columns - 1);
        const int next = (column + 1) % grid.columns;
        const double u = x - column, v = y - row;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const int plane = static_cast<int>(i);
            const auto at = [&](int c, int r) { return value_of(cell(layer, plane, c, r)); };
            planes[i] = (1 - v) * ((1 - u) * at(column, row) + u * at(next, row)) +
                        v * ((1 - u) * at(column, row + 1) + u * at(next, row + 1));
            if (polar > 0)
                planes[i] +=
                    polar * (mean(layer, plane, v > 0.5 ? row + 1 : row, value_of) - planes[i]);
        }
    }

    Normals normals(const geo::Geodetic& place) {
        Normals normals{.lat_deg = degrees(place.lat_rad)};
        bilinear(kTemperature, place, normals.sea_level_c, [](double v) { return v / 10; });
        bilinear(kRelief, place, std::span(&normals.relief_m, 1), [](double v) { return v; });
        double year_mm = 0, sum = 0;
        bilinear(kRain, place, std::span(&year_mm, 1),
                 [](double v) { return 8 * (std::exp2(v / 20) - 1); });
        bilinear(kShare, place, normals.rain_mm, [](double v) { return v; });
        for (const double share : normals.rain_mm)
            sum += share;
        for (double& month : normals.rain_mm)
            month *= sum > 0 ? year_mm / sum : 0;
        return normals;
    }

    double ice_share(const geo::Geodetic& place, double half_deg) {
        const Grid& grid = grids[kIce];
        const double cells_a_degree = grid.rows / 180.0;
        const double x = (degrees(place.lon_rad) + 180) * cells_a_degree;
        const double y = (90 - degrees(place.lat_rad)) * cells_a_degree;
        const int reach = static_cast<int>(half_deg * cells_a_degree);
        // A few cells of a large box say enough.
        const int step = std::max(1, reach / 8);
        int count = 0;
        double sum = 0;
        for (int j = -reach; j <= reach; j += step) {
            const int row = std::clamp(static_cast<int>(y) + j, 0, grid.rows - 1);
            for (int i = -reach; i <= reach; i += step) {
                const int column = (static_cast<int>(std::floor(x)) + i) % grid.columns;
                sum += cell(kIce, 0, column < 0 ? column + grid.columns : column, row);
                ++count;
            }
        }
        return sum / count;
    }
};

ClimateMap::ClimateMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ClimateMap::ClimateMap(ClimateMap&&) noexcept = default;
ClimateMap& ClimateMap::operator=(ClimateMap&&) noexcept = default;
ClimateMap::~ClimateMap() = default;

ClimateMap ClimateMap::read(const std::filesystem::path& path) {
    auto impl = std::make_unique<Impl>();
    impl->path = path.string();
    impl->bytes = bytes_of(path);
    impl->read_head();
    return ClimateMap(std::move(impl));
}

ClimateMap ClimateMap::shipped() {
    return read(share_dir() / "data/climate/climate.bin");
}

Normals ClimateMap::at(const geo::Geodetic& place) const {
    return around(place, 0);
}

Normals ClimateMap::around(const geo::Geodetic& place, double half_deg) const {
    const std::lock_guard lock(impl_->unpacking);
    Normals normals = impl_->normals(place);
    normals.mapped_ice = impl_->ice_share(place, half_deg);
    return normals;
}

}  // namespace relevo::climate
