#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "image/image.h"

namespace relevo::test {

/// What FFmpeg's decoders find in a film. GIF, too; animated WebP they do not read.
struct DecodedFilm {
    std::string codec;          ///< "h264"
    std::string pixels;         ///< "yuv420p"
    std::string matrix, range;  ///< "bt709", "tv"
    std::string comment;        ///< of the file
    bool index_first = false;   ///< of mp4: moov before mdat
    int width_px = 0, height_px = 0;
    std::vector<double> times_s;        ///< when each frame is shown
    double duration_s = 0;              ///< of the last frame's end, where the file says so
    std::vector<image::Image8> frames;  ///< those asked for, RGB
};

/// @param keep  whether frame n, from 0, is kept
/// @throws std::runtime_error for what is no film
DecodedFilm decode_film(
    const std::filesystem::path& path,
    const std::function<bool(std::size_t)>& keep = [](std::size_t) { return true; });

}  // namespace relevo::test
