#include "film/palette.h"

#include <algorithm>
#include <cstddef>

// libavfilter has such a palette, too, but brings 35 packages.
namespace relevo::film {
namespace {

// Colours are counted in cells of 5 bits a channel.
constexpr int kBits = 5, kLevels = 1 << kBits, kCells = kLevels * kLevels * kLevels;

constexpr int kCell = 256 / kLevels;

constexpr std::size_t cell_of(int r, int g, int b) {
    return static_cast<std::size_t>((r / kCell * kLevels + g / kCell) * kLevels + b / kCell);
}

/// A colour that occurs.
struct Counted {
    std::array<std::uint8_t, 3> level;  ///< 0 to kLevels - 1
    std::uint32_t pixels = 0;
    std::array<std::uint64_t, 3> sum{};  ///< of the pixels' values
};

/// Some of the colours.
struct Box {
    std::size_t begin, end;  ///< in the list of colours
    std::uint64_t pixels = 0;
    std::size_t axis = 0;  ///< along which it is longest
    int side = 0;

    Box(const std::vector<Counted>& colours, std::size_t first, std::size_t last)
        : begin(first), end(last) {
        for (std::size_t c = 0; c < 3; ++c) {
            int least = kLevels, most = -1;
            for (std::size_t i = begin; i < end; ++i) {
                least = std::min<int>(least, colours[i].level[c]);
                most = std::max<int>(most, colours[i].level[c]);
            }
            if (most - least <= side) continue;
            side = most - least;
            axis = c;
        }
        for (std::size_t i = begin; i < end; ++i)
            pixels += colours[i].pixels;
    }

    std::uint64_t weight() const { return pixels * static_cast<std::uint64_t>(side); }
};

std::vector<Counted> colours_of(const image::Image8& frame) {
    std::vector<Counted> cells(kCells);
    for (int y = 0; y < frame.height; ++y) {
        const std::uint8_t* pixel = frame.row(y);
        for (int x = 0; x < frame.width; ++x, pixel += frame.channels) {
            Counted& cell = cells[cell_of(pixel[0], pixel[1], pixel[2])];
            ++cell.pixels;
            for (std::size_t c = 0; c < 3; ++c)
                cell.sum[c] += pixel[c];
        }
    }
    std::vector<Counted> colours;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].pixels == 0) continue;
        cells[i].level = {static_cast<std::uint8_t>(i >> (2 * kBits)),
                          static_cast<std::uint8_t>(i >> kBits & (kLevels - 1)),
                          static_cast<std::uint8_t>(i & (kLevels - 1))};
        colours.push_back(cells[i]);
    }
    return colours;
}

/// Sorts the colours of a box along its longest side. @returns the first of its upper half
std::size_t median_of(std::vector<Counted>& colours, const Box& box) {
    std::sort(colours.begin() + static_cast<std::ptrdiff_t>(box.begin),
              colours.begin() + static_cast<std::ptrdiff_t>(box.end),
              [axis = box.axis](const Counted& a, const Counted& b) {
                  return a.level[axis] < b.level[axis];
              });
    std::uint64_t below = 0;
    std::size_t at = box.begin;
    while (at + 1 < box.end && 2 * below < box.pixels)
        below += colours[at++].pixels;
    return std::max(at, box.begin + 1);
}

std::uint32_t mean_of(const std::vector<Counted>& colours, const Box& box) {
    std::array<std::uint64_t, 3> sum{};
    for (std::size_t i = box.begin; i < box.end; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += colours[i].sum[c];
    const auto mean = [&](std::size_t c) {
        return static_cast<std::uint32_t>((sum[c] + box.pixels / 2) / box.pixels);
    };
    return mean(0) << 16 | mean(1) << 8 | mean(2);
}

/// The palette's nearest colour, by its number.
std::uint8_t nearest_in(const Palette& palette, int r, int g, int b) {
    int best = 0, least = 1 << 30;
    for (int i = 0; i < 256; ++i) {
        const std::uint32_t colour = palette[static_cast<std::size_t>(i)];
        const int dr = static_cast<int>(colour >> 16 & 255) - r;
        const int dg = static_cast<int>(colour >> 8 & 255) - g;
        const int db = static_cast<int>(colour & 255) - b;
        const int far = 2 * dr * dr + 4 * dg * dg + db * db;  // as eyes weigh them
        if (far >= least) continue;
        least = far;
        best = i;
    }
    return static_cast<std::uint8_t>(best);
}

}  // namespace

Palette median_cut(const image::Image8& frame) {
    std::vector<Counted> colours = colours_of(frame);
    std::vector<Box> boxes;
    if (!colours.empty()) boxes.emplace_back(colours, 0, colours.size());
    while (!boxes.empty() && boxes.size() < 256) {
        const auto widest = std::ranges::max_element(boxes, {}, &Box::weight);
        if (widest->side == 0) break;
        const Box box = *widest;
        const std::size_t middle = median_of(colours, box);
        *widest = Box(colours, box.begin, middle);
        boxes.emplace_back(colours, middle, box.end);
    }
    Palette palette{};
    for (std::size_t i = 0; i < boxes.size(); ++i)
        palette[i] = mean_of(colours, boxes[i]);
    return palette;
}

std::vector<std::uint8_t> dithered(const image::Image8& frame, const Palette& palette) {
    // Bayer's matrix, as wide as a cell.
    constexpr std::array<std::array<int, 4>, 4> kBayer{
        {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}}};
    constexpr int kUnknown = -1;
    std::vector<int> nearest(kCells, kUnknown);
    std::vector<std::uint8_t> result;
    result.reserve(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
    for (int y = 0; y < frame.height; ++y) {
        const std::uint8_t* pixel = frame.row(y);
        for (int x = 0; x < frame.width; ++x, pixel += frame.channels) {
            const int step =
                kBayer[static_cast<std::size_t>(y % 4)][static_cast<std::size_t>(x % 4)] / 2 - 4;
            const auto moved = [&](int c) { return std::clamp(pixel[c] + step, 0, 255); };
            const auto middle = [&](int c) { return moved(c) / kCell * kCell + kCell / 2; };
            int& known = nearest[cell_of(moved(0), moved(1), moved(2))];
            if (known == kUnknown) known = nearest_in(palette, middle(0), middle(1), middle(2));
            result.push_back(static_cast<std::uint8_t>(known));
        }
    }
    return result;
}

}  // namespace relevo::film
