#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace relevo::dem {

/// How the colours of a picture mean heights.
enum class Encoding {
    None,        ///< the numbers of a band are heights
    TerrainRgb,  ///< Mapbox: -10000 m + 0.1 m (65536 R + 256 G + B); 0, 0, 0 is a hole
    Terrarium,   ///< Mapzen, AWS: 256 R + G + B / 256 - 32768 m; 0, 0, 0 is a hole
};

/// As `--encoding` writes it: "terrain-rgb", "terrarium".
std::string_view name_of(Encoding encoding);

/// The height of a colour [m], exact to the rounding of a float. Terrain-RGB has steps of 0.1 m,
/// Terrarium of 1/256 m. Sources: docs.mapbox.com, "Access elevation data"; github.com/tilezen/
/// joerd, docs/formats.md.
float decoded_m(Encoding encoding, std::uint8_t red, std::uint8_t green, std::uint8_t blue);

/// The height of black, which tiles are filled up with where there is no data [m].
double black_m(Encoding encoding);

/// The encoding by which a picture is a piece of the Earth's surface: all heights are the Earth's,
/// and neighbours are near each other. A photograph is neither by a wide margin.
/// @param red,green,blue  rows of `width`, one after the other
std::optional<Encoding> plausible_encoding(std::span<const std::uint8_t> red,
                                           std::span<const std::uint8_t> green,
                                           std::span<const std::uint8_t> blue, int width);

}  // namespace relevo::dem
