#pragma once

#include <string>
#include <vector>

#include "film/film.h"
#include "image/image.h"

/// What the module `film_encoder` offers: FFmpeg's encoders behind two functions. It is a module of
/// its own, so that the program runs without FFmpeg, and starts without loading it.
namespace relevo::film {

/// A film to be encoded.
struct Request {
    int descriptor = -1;                ///< of the file, readable and writable, at its beginning
    std::string muxer;                  ///< FFmpeg's name of the format: "mp4"
    std::vector<std::string> encoders;  ///< FFmpeg's names; the first that is installed is used
    int width_px = 0, height_px = 0;
    Rate rate;
    int quality = 0;  ///< 0 to 100
    bool loop = true;
    std::string comment;
};

/// Each function returns an empty text on success, else the reason for failing.
class Encoder {
  public:
    virtual ~Encoder() = default;
    virtual std::string add(const image::Image8& frame) = 0;
    virtual std::string finish() = 0;
};

struct EncoderModule {
    /// @returns null and a reason where there is no encoder
    Encoder* (*open)(const Request& request, std::string& reason);
    bool (*has_encoder)(const std::string& name);
    std::string (*version)();  ///< "libavcodec 59.37.100"
};

/// The one function that the module exports.
extern "C" const EncoderModule* relevo_film_encoder();

}  // namespace relevo::film
