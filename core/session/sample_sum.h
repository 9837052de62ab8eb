#pragma once

#include <span>
#include <vector>

#include "image/image.h"

namespace relevo::session {

/// The mean of several frames of a picture, in linear light.
///
/// Colours are decoded after tone mapping: a bright sky behind a dark ridge has then as much of an
/// edge pixel as it covers of it. The mean of radiance before tone mapping would be the sky's
/// alone, and the edge would show steps again. Radiance itself, for EXR, is added as it is.
class SampleSum {
  public:
    /// @param transparent  only samples that show ground count, for the colour and for the alpha
    SampleSum(int width_px, int height_px, bool transparent);

    /// @param depths_m  infinite where there is no ground; rows from the top; may be empty where
    ///     nothing is transparent
    void add(const image::Image16& colours, std::span<const float> depths_m);
    void add(const image::ImageF& radiance, std::span<const float> depths_m);

    /// sRGB, with straight alpha where the picture is transparent.
    image::Image16 colours() const;
    /// Linear radiance, with premultiplied alpha where the picture is transparent.
    image::ImageF radiance() const;

  private:
    template <typename Pixels, typename Linear>
    void add_pixels(const Pixels& pixels, std::span<const float> depths_m, const Linear& linear);

    int width_px_, height_px_;
    bool transparent_;
    int frames_ = 0;
    std::vector<float> sums_;     // three a pixel
    std::vector<float> covered_;  // frames in which the pixel shows ground, where transparent
};

/// Rounds to 8 bits with the dither that frames of 8 bits have (shaders/lib/shown.glsl). Alpha is
/// only rounded.
/// @param left_px, below_px  of the image in its picture, from the lower left corner
image::Image8 dithered(const image::Image16& image, int left_px, int below_px);

}  // namespace relevo::session
