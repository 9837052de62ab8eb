#pragma once

#include <cstdint>
#include <string>

#include "session/session.h"

/// Compares the shadows of an image with those of the CPU sweep.
namespace relevo::session {

/// Compares the shadows of an image with those of light::shadows(), swept on the CPU. Swept values
/// are not interpolated. If pixels are finer than the posts, only pixels within 0.06 post spacings
/// of a post count. Coarser pixels are compared with the mean of the posts that they cover, each
/// weighted by the covered area of its cell.
struct ShadowAudit {
    std::string provider;  ///< id of the effect that draws shadows; empty if none does
    std::string refusal;   ///< why the sweep failed; empty if it did not

    struct Excluded {
        std::int64_t between_posts = 0;  ///< pixels farther than 0.06 spacings from any post
        /// Pixels of which less than 90 % is uniformly lit or shaded. They count in `all` and
        /// `penumbra`.
        std::int64_t mixed = 0;
        /// Ground turned away from the sun, dark without cast shadows.
        std::int64_t faces_away = 0;
        std::int64_t voids = 0;      ///< pixels in voids of the DEM
        std::int64_t moved = 0;      ///< surfaces displaced by an effect, such as a sea's
        std::int64_t instances = 0;  ///< ground that instances of plugins shade
    } excluded;

    std::int64_t lit = 0, shaded = 0;  ///< pixels compared, as swept
    std::int64_t lit_right = 0, shaded_right = 0;

    /// Visible fraction of the solar disc: drawn minus swept.
    struct Difference {
        std::int64_t pixels = 0;
        double sum = 0, sum_of_sizes = 0;
    };
    Difference all, penumbra;  ///< penumbra: where the swept fraction is neither 0 nor 1

    std::int64_t pixels() const { return lit + shaded; }
    /// Fraction of pixels that agree, thresholded at half of the disc; NaN without pixels.
    double agreement() const;
    /// Mean of agreement over lit and over shaded pixels; if one class is empty, that of the other.
    double balanced_accuracy() const;
    /// "shadows agrees with the CPU sweep on 99.71 % of 130211 pixels, balanced 99.64 %"
    std::string text() const;
    /// JSON as documented in docs/jobs.md.
    std::string json_text() const;
};

/// Audits the last frame of a session that was opened with Options::audited.
/// @throws Error (not BadInput: that becomes ShadowAudit::refusal)
ShadowAudit audit_shadows(const Session& session);

}  // namespace relevo::session
