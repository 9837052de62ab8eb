#include "climate/earth_grids.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <zlib.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"

namespace relevo::climate {
namespace {

constexpr const char* kWho = "climate";
constexpr const char* kRemedy = "; install Relevo again";

std::string bytes_of(const std::filesystem::path& path) {
    try {
        return read_text(path, kWho);
    } catch (const Error& error) {
        bad_input(error.what() + std::string(kRemedy));
    }
}

}  // namespace

EarthGrids::EarthGrids(const std::filesystem::path& path, std::string_view title,
                       std::span<const Layer> layers)
    : path_(path.string()), bytes_(bytes_of(path)) {
    std::string_view rest = bytes_;
    if (line(rest) != fmt::format("relevo {}", title)) damaged("no such map of this version");
    for (const Layer& layer : layers)
        grids_.push_back(read_grid(line(rest), layer));
    if (line(rest) != "end") damaged();
    read_bands(rest);
}

int EarthGrids::cell(std::size_t layer, int plane, int column, int row) {
    Grid& grid = grids_[layer];
    const int index = row / grid.band_rows;
    std::optional<std::vector<short>>& band = grid.bands[static_cast<std::size_t>(index)];
    if (!band) band = unpacked(grid, index);
    const std::size_t at =
        static_cast<std::size_t>(row % grid.band_rows) * static_cast<std::size_t>(grid.columns) +
        static_cast<std::size_t>(column);
    if (grid.bits == 1) return (*band)[at / 8] >> (7 - at % 8) & 1;
    return (*band)[static_cast<std::size_t>(plane) * grid.cells(index) + at];
}

std::size_t EarthGrids::Grid::cells(int band) const {
    const int of_band = std::min(band_rows, rows - band * band_rows);
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(of_band);
}

void EarthGrids::damaged(const char* what) const {
    bad_input(fmt::format("{}: {}: {}{}", kWho, path_, what, kRemedy));
}

std::string_view EarthGrids::line(std::string_view& rest) const {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) damaged();
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return line;
}

EarthGrids::Grid EarthGrids::read_grid(std::string_view line, const Layer& layer) const {
    const std::vector<std::string> words = split(line, ' ');
    if (words.size() != 6 || words[0] != layer.name) damaged();
    std::array<int, 5> numbers{};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        constexpr double kLargest = 65536;
        const auto value = parse_number(words[k + 1]);
        if (!value || !(*value >= 1 && *value <= kLargest)) damaged();
        numbers[k] = static_cast<int>(*value);
    }
    Grid grid{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], {}, {}};
    if (grid.planes != layer.planes || grid.bits != layer.bits) damaged();
    return grid;
}

void EarthGrids::read_bands(std::string_view rest) {
    constexpr std::size_t kSizeBytes = 4;
    std::size_t count = 0;
    for (Grid& grid : grids_) {
        const int bands = (grid.rows + grid.band_rows - 1) / grid.band_rows;
        grid.packed.resize(static_cast<std::size_t>(bands));
        grid.bands.resize(grid.packed.size());
        count += grid.packed.size();
    }
    if (rest.size() < kSizeBytes * count) damaged();
    std::string_view sizes = rest.substr(0, kSizeBytes * count);
    rest.remove_prefix(sizes.size());
    for (Grid& grid : grids_) {
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
std::vector<unsigned char> EarthGrids::inflated(std::string_view packed, std::size_t size) const {
    std::vector<unsigned char> data(size);
    uLongf got = size;
    if (uncompress(data.data(), &got, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        got != size)
        damaged();
    return data;
}

/// What tools/make_climate.py describes.
std::vector<short> EarthGrids::unpacked(const Grid& grid, int band) const {
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

}  // namespace relevo::climate
