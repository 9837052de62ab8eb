#pragma once

#include <vector>

#include "image/image.h"
#include "session/panorama_parts.h"

namespace relevo::session {

/// A panorama that is filled with its parts.
///
/// Frames are read between their pixels by cubic interpolation, in linear light, within the range
/// of the four nearest pixels so that silhouettes get no halo. Source of the cubic: R. Keys, Cubic
/// convolution interpolation for digital image processing, IEEE Transactions on Acoustics, Speech
/// and Signal Processing 29(6), 1981.
class PanoramaImage {
  public:
    explicit PanoramaImage(const scene::PanoramaMap& map) : map_(map) {}

    /// Adds a part. @param frame  an Image16 or an ImageF, of the same kind in all parts
    void add(const PanoramaPart& part, const image::Picture& frame);
    /// Adds the distances of a part's ground. @param depths_m  of its frame, along its axis, rows
    /// from the top; infinite without ground
    void add_depths(const PanoramaPart& part, const std::vector<float>& depths_m);

    /// Of the kind of the frames.
    image::Picture take() { return std::move(picture_); }
    /// From the eye [m], rows from the top; infinite without ground.
    const std::vector<float>& distances_m() const { return distances_m_; }

  private:
    const scene::PanoramaMap& map_;
    image::Picture picture_;
    std::vector<float> distances_m_;
};

}  // namespace relevo::session
