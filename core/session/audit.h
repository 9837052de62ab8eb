#pragma once

#include <cstdint>
#include <string>

#include "session/session.h"

/// Whether the shadows of a picture are those of the figures.
namespace relevo::session {

/// The shadows of a picture beside those that light::shadows() sweeps on the CPU. Nothing is
/// interpolated on the sweep's side: of pixels finer than the posts those count that show what is
/// at a post, within 0.06 of the spacing; coarser ones have the mean of the posts that they cover,
/// each with the square about it.
struct ShadowAudit {
    std::string provider;  ///< id of the effect that draws shadows; empty: none does
    std::string refusal;   ///< why the sweep has no shadows to compare with, mostly empty

    struct LeftOut {
        std::int64_t between_posts = 0;  ///< pixels that show no post
        /// Pixels of which less than nine tenths are alike, lit or in the shade; they are in `all`
        /// and `penumbra`.
        std::int64_t mixed = 0;
        std::int64_t faces_away = 0;  ///< ground turned away from the sun is dark anyway
        std::int64_t holes = 0;       ///< the DEM has no height there, whatever is drawn
        std::int64_t moved = 0;       ///< by an effect, such as the surface of a sea
    } left_out;

    std::int64_t lit = 0, shaded = 0;  ///< pixels compared, by what the sweep says
    std::int64_t lit_right = 0, shaded_right = 0;

    /// Of the drawn share of the sun's disc less the true one.
    struct Difference {
        std::int64_t pixels = 0;
        double sum = 0, sum_of_sizes = 0;
    };
    Difference all, penumbra;  ///< penumbra: where the sweep has a part of the disc

    std::int64_t pixels() const { return lit + shaded; }
    /// Share of pixels that are right, half of the disc being the border; NaN without pixels.
    double agreement() const;
    /// Mean of the shares of lit and of shaded pixels that are right; of one sort alone its share.
    double balanced_accuracy() const;
    /// "shadows agrees with the CPU sweep on 99.71 % of 130211 pixels, balanced 99.64 %"
    std::string text() const;
    /// JSON, as docs/jobs.md has it.
    std::string json_text() const;
};

/// Of the last frame of a session with Options::audited.
ShadowAudit audit_shadows(const Session& session);

}  // namespace relevo::session
