#pragma once

#include "figure/accuracy.h"
#include "figure/figure.h"
#include "light/raster/sun_hours.h"
#include "sun/zone.h"

namespace relevo::figure {

/// Hours of direct sun in a period, and what else its sun does: `relevo sun hours`.
struct Hours : Figure {
    sun::TimeSpan time;
    sun::Zone zone;                           ///< of the period, for the metadata
    std::vector<std::string> words{"hours"};  ///< bands, of all_words()
    std::string refraction = "standard";      ///< as light::refraction_at()
    double step_s = kStep_s.value;            ///< as light::SunHoursOptions
    light::SunHoursOptions::Irradiation irradiation{kLinke.value,
                                                    kAlbedo.value};  ///< of bands that need it
    /// Shown each part.
    std::function<void(const light::SunHours& part)> seen{};

    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts& posts) const override;
    const char* accuracy() const override;
    int bytes_a_post() const override;
    double halo_m(const dem::Posts& posts) const override;
    std::optional<light::Beyond> beyond(const dem::Posts& posts,
                                        const dem::Window& window) const override;
    PartMaker maker(Work work) const override;

    /// First and last instant as texts of the metadata.
    std::string from() const, to() const;

    /// "hours", "first", "last", "spells", "global", "beam", "diffuse", "reflected".
    static const std::vector<std::string>& all_words();
    /// Whether a band is of first and last light and sunshine periods.
    bool has_spells() const;
    bool has_irradiation() const;
    /// The first word that is listed twice; empty: none is.
    std::string repeated_word() const;

  private:
    light::SunHoursOptions options() const;
};

}  // namespace relevo::figure
