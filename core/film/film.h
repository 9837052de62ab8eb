#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/output_file.h"
#include "image/image.h"

/// Films: frames in, one file out. FFmpeg's libraries encode, in a module that is loaded on first
/// use.
namespace relevo::film {

/// How a film is encoded.
struct Settings {
    double fps = 30;             ///< frames per second, kMinFps to kMaxFps
    std::optional<int> quality;  ///< 0 to 100; none: kDefaultQuality
    std::optional<bool> loop;    ///< of gif and webp: repeats for ever; none: true

    bool operator==(const Settings&) const = default;
};

inline constexpr double kMinFps = 0.1, kMaxFps = 240;
inline constexpr int kDefaultQuality = 80;

/// Whether a file of that name is always a film: mp4, webm and gif, by its ending.
bool is_film_name(const std::filesystem::path& path);

/// Checks before any work is done whether a film can have that name, size and settings.
/// @throws Error (BadInput) for another ending than mp4, webm, webp and gif, for sizes that the
///     format does not have, and for settings that it has not
void check(const std::filesystem::path& path, int width_px, int height_px,
           const Settings& settings);

/// Frames per second as a fraction. 23.976, 29.97 and 59.94 are 24000/1001, 30000/1001 and
/// 60000/1001; others are exact to 1/1000.
struct Rate {
    int frames = 30, seconds = 1;

    bool operator==(const Rate&) const = default;
};
Rate rate_of(double fps);

class Encoder;

/// A film on its way to its file. Used on one thread at a time.
class Film {
  public:
    /// Loads FFmpeg and begins the file.
    /// @param file     gets its name by finish()
    /// @param comment  text that the file carries, as mp4 and webm can
    /// @throws Error as check(), and (Failed) where FFmpeg or its encoder is not installed
    Film(OutputFile file, int width_px, int height_px, const Settings& settings,
         const std::string& comment = {});
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Adds the next frame. @param frame  of the film's size, RGB or RGBA; alpha is ignored
    /// @throws Error (Failed) where the encoder or the disk refuses
    void add(const image::Image8& frame);

    /// Completes the file and gives it its name; called once, after one frame at least.
    /// @throws Error as add() and OutputFile::finish()
    void finish();

    int frames() const { return frames_; }  ///< added so far

  private:
    [[noreturn]] void fail(const std::string& reason) const;

    OutputFile file_;
    std::unique_ptr<Encoder> encoder_;
    int width_px_, height_px_;
    int frames_ = 0;
};

/// The FFmpeg libraries and the encoders of the formats, a line for each: for `doctor`. Says what
/// is missing instead of an error.
std::string installed_text();

}  // namespace relevo::film
