#include "session/audit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "dem/posts.h"
#include "light/raster/shadows.h"
#include "session/active_effects.h"

namespace relevo::session {
namespace {

using nlohmann::ordered_json;

// In post spacings. Behind a lit post a shadow may begin at once.
constexpr double kAtPost = 0.06;
constexpr double kAlike = 0.9;  // least uniform fraction of a pixel's ground

/// The heights as drawn, or nullopt if they are the DEM's. Those of a DEM above the --memory limit
/// are means, as in the renderer's shadows.
std::optional<dem::Heightfield> other_heights(const Session& session) {
    const dem::Heightfield& given = session.dem()->field;
    const auto exaggeration = static_cast<float>(session.scene().exaggeration);
    if (exaggeration == 1 && given.reduction == 1) return std::nullopt;
    dem::Heightfield field = given;
    field.reduction = 1;
    for (float& height_m : field.height_m)
        height_m *= exaggeration;
    field.about.statistics = dem::statistics(field.height_m);
    return field;
}

/// Visible fraction of the solar disc at each post, 0 to 1; NaN in voids.
Array2d<float> swept(const Session& session) {
    const std::optional<dem::Heightfield> other = other_heights(session);
    const dem::Posts posts(other ? *other : session.dem()->field);
    const render::SunLight& light = session.sun_light();
    const double exaggeration = session.scene().exaggeration;
    light::ShadowOptions options;
    options.soft = true;
    options.refraction = light.terrestrial_refraction;
    if (light.air)
        options.air = [&](geo::Geodetic at) {
            at.height_m /= exaggeration;  // true height, not exaggerated
            return light.air(at);
        };
    const glm::dvec3& d = light.direction;
    const light::SunOverDem sun{std::atan2(d.x, d.y), std::atan2(d.z, std::hypot(d.x, d.y)),
                                light.semidiameter_rad};
    return std::move(light::shadows(posts, sun, options).lit);
}

std::string provider_of(const ActiveEffects& effects) {
    for (const effect::Effect* effect : effects.loaded.selection.effects) {
        const std::vector<std::string>& words = effect->manifest.provides;
        if (contains(words, "shadow")) return effect->id();
    }
    return {};
}

/// The posts of one row or column that a pixel covers. Each post stands for the cell within half a
/// spacing.
struct Span {
    double from, to;  ///< edges of the pixel in posts; equal if it is finer than the posts
    int first, last;  ///< indices of posts; empty if last < first

    static Span of(double centre, double pixel_posts, int count) {
        const bool fine = pixel_posts < 1;
        const double half = fine ? 0 : pixel_posts / 2, reach = fine ? kAtPost : half + 0.5;
        return {centre - half, centre + half,
                std::max(static_cast<int>(std::ceil(centre - reach)), 0),
                std::min(static_cast<int>(std::floor(centre + reach)), count - 1)};
    }
    /// Length of a post's cell that the pixel covers, in posts.
    double weight(int post) const {
        if (from == to) return 1;
        return std::max(std::min(to, post + 0.5) - std::max(from, post - 0.5), 0.0);
    }
};

/// Swept values over the ground of a pixel.
struct Truth {
    double weight = 0;  ///< area of posts with heights
    double seen = 0;    ///< visible fraction of the disc, times weight
    double lit = 0;     ///< weight of posts that see half of the disc or more

    Truth(const Array2d<float>& shares, const Span& x, const Span& y) {
        for (int row = y.first; row <= y.last; ++row)
            for (int column = x.first; column <= x.last; ++column) {
                const float share = shares.at(column, row);
                const double part = x.weight(column) * y.weight(row);
                if (std::isnan(share)) continue;
                weight += part;
                seen += part * double{share};
                if (share >= 0.5F) lit += part;
            }
    }
};

/// Adds a pixel to the audit.
/// @param reduction  posts of the DEM per cell of `shares`, along each axis
void compare(const render::SunSeen& pixel, const Array2d<float>& shares, double reduction,
             ShadowAudit& audit) {
    if (!pixel.faces) return void(++audit.excluded.faces_away);
    if (pixel.moved) return void(++audit.excluded.moved);
    if (pixel.shaded_by_instance) return void(++audit.excluded.instances);
    const glm::dvec2 at = (pixel.post + 0.5) / reduction - 0.5;
    const double side = pixel.pixel_posts / reduction;
    const Span x = Span::of(at.x, side, shares.width()), y = Span::of(at.y, side, shares.height());
    if (x.last < x.first || y.last < y.first) return void(++audit.excluded.between_posts);
    const Truth truth(shares, x, y);
    if (truth.weight <= 0) return void(++audit.excluded.voids);
    const double is = truth.seen / truth.weight, lit = truth.lit / truth.weight;
    const auto add = [&](ShadowAudit::Difference& difference) {
        ++difference.pixels;
        difference.sum += pixel.share - is;
        difference.sum_of_sizes += std::abs(pixel.share - is);
    };
    add(audit.all);
    if (is > 0 && is < 1) add(audit.penumbra);
    if (std::max(lit, 1 - lit) < kAlike) return void(++audit.excluded.mixed);
    const bool is_lit = lit > 0.5, drawn_lit = pixel.share >= 0.5;
    ++(is_lit ? audit.lit : audit.shaded);
    if (is_lit == drawn_lit) ++(is_lit ? audit.lit_right : audit.shaded_right);
}

/// Means are null without pixels.
ordered_json difference_json(const ShadowAudit::Difference& difference) {
    const auto mean = [&](double sum) -> ordered_json {
        if (difference.pixels == 0) return nullptr;
        return sum / static_cast<double>(difference.pixels);
    };
    return {{"pixels", difference.pixels},
            {"mean", mean(difference.sum)},
            {"mean_size", mean(difference.sum_of_sizes)}};
}

double share_of(std::int64_t part, std::int64_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double ShadowAudit::agreement() const {
    return share_of(lit_right + shaded_right, pixels());
}

double ShadowAudit::balanced_accuracy() const {
    if (lit == 0) return share_of(shaded_right, shaded);
    if (shaded == 0) return share_of(lit_right, lit);
    return (share_of(lit_right, lit) + share_of(shaded_right, shaded)) / 2;
}

std::string ShadowAudit::text() const {
    if (!refusal.empty()) return "audit: the CPU sweep failed: " + refusal;
    if (pixels() == 0)
        return "audit: no pixel shows a post of the DEM that faces the sun; nothing to compare";
    const std::string figures = fmt::format(
        "with the CPU sweep on {:.2f} % of {} pixels that show a post, balanced {:.2f} %",
        100 * agreement(), pixels(), 100 * balanced_accuracy());
    if (provider.empty())
        return fmt::format("audit: no active effect draws shadows; a fully lit DEM agrees {}",
                           figures);
    return fmt::format("audit: {} agrees {}", provider, figures);
}

std::string ShadowAudit::json_text() const {
    ordered_json json;
    json["provider"] = provider.empty() ? ordered_json() : ordered_json(provider);
    if (!refusal.empty()) json["refusal"] = refusal;
    json["pixels"] = pixels();
    json["lit"] = {{"pixels", lit}, {"right", lit_right}};
    json["shaded"] = {{"pixels", shaded}, {"right", shaded_right}};
    // NaN is null in JSON.
    json["agreement"] = agreement();
    json["balanced_accuracy"] = balanced_accuracy();
    json["difference"] = difference_json(all);
    json["penumbra"] = difference_json(penumbra);
    json["left_out"] = {{"between_posts", excluded.between_posts},
                        {"mixed", excluded.mixed},
                        {"faces_away", excluded.faces_away},
                        {"holes", excluded.voids},
                        {"moved", excluded.moved},
                        {"instances", excluded.instances}};
    return json.dump();
}

ShadowAudit audit_shadows(const Session& session) {
    ShadowAudit audit;
    audit.provider = provider_of(session.effects());
    Array2d<float> truth;
    try {
        truth = swept(session);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::BadInput) throw;
        audit.refusal = error.what();  // such as a world map, which has no single sun direction
        return audit;
    }
    const double reduction = session.dem()->field.reduction;
    for (const render::SunSeen& pixel : session.read_sun_seen())
        compare(pixel, truth, reduction, audit);
    return audit;
}

}  // namespace relevo::session
