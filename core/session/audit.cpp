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

// Of the posts' spacing: behind a lit post shade may begin at once.
constexpr double kAtPost = 0.06;
constexpr double kAlike = 0.9;  // of a pixel's ground, for it to be lit or in the shade

/// The posts as high as they are drawn, where that is not as the DEM has them. Of a DEM beyond
/// --memory these are means, as those that shade in pictures.
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

/// The share of the sun's disc that each post sees.
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
            at.height_m /= exaggeration;  // of the ground that there is
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

/// Posts of a line that a pixel shows, each by its cell, half a spacing to either side of it.
struct Span {
    double from, to;  ///< of the pixel; the same where it is finer than the posts
    int first, last;  ///< none where last < first

    static Span of(double centre, double pixel_posts, int count) {
        const bool fine = pixel_posts < 1;
        const double half = fine ? 0 : pixel_posts / 2, reach = fine ? kAtPost : half + 0.5;
        return {centre - half, centre + half,
                std::max(static_cast<int>(std::ceil(centre - reach)), 0),
                std::min(static_cast<int>(std::floor(centre + reach)), count - 1)};
    }
    /// How much of a post's cell the pixel covers.
    double weight(int post) const {
        if (from == to) return 1;
        return std::max(std::min(to, post + 0.5) - std::max(from, post - 0.5), 0.0);
    }
};

/// What the sweep has of the ground of a pixel.
struct Truth {
    double weight = 0;  ///< of posts that are there
    double seen = 0;    ///< of the disc, times weight
    double lit = 0;     ///< weight of those that see half of the disc or more

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

/// Puts a pixel beside the posts that it shows.
/// @param reduction  of the DEM's posts to one of `shares`, each way
void compare(const render::SunSeen& pixel, const Array2d<float>& shares, double reduction,
             ShadowAudit& audit) {
    if (!pixel.faces) return void(++audit.left_out.faces_away);
    if (pixel.moved) return void(++audit.left_out.moved);
    const glm::dvec2 at = (pixel.post + 0.5) / reduction - 0.5;
    const double side = pixel.pixel_posts / reduction;
    const Span x = Span::of(at.x, side, shares.width()), y = Span::of(at.y, side, shares.height());
    if (x.last < x.first || y.last < y.first) return void(++audit.left_out.between_posts);
    const Truth truth(shares, x, y);
    if (truth.weight <= 0) return void(++audit.left_out.holes);
    const double is = truth.seen / truth.weight, lit = truth.lit / truth.weight;
    const auto add = [&](ShadowAudit::Difference& difference) {
        ++difference.pixels;
        difference.sum += pixel.share - is;
        difference.sum_of_sizes += std::abs(pixel.share - is);
    };
    add(audit.all);
    if (is > 0 && is < 1) add(audit.penumbra);
    if (std::max(lit, 1 - lit) < kAlike) return void(++audit.left_out.mixed);
    const bool is_lit = lit > 0.5, drawn_lit = pixel.share >= 0.5;
    ++(is_lit ? audit.lit : audit.shaded);
    if (is_lit == drawn_lit) ++(is_lit ? audit.lit_right : audit.shaded_right);
}

/// Null without pixels.
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
    if (!refusal.empty()) return "audit: the CPU sweep has no shadows here: " + refusal;
    if (pixels() == 0)
        return "audit: no pixel shows a post of the DEM that is turned to the sun; there is "
               "nothing "
               "to compare";
    const std::string figures = fmt::format(
        "with the CPU sweep on {:.2f} % of {} pixels that show a post, balanced {:.2f} %",
        100 * agreement(), pixels(), 100 * balanced_accuracy());
    if (provider.empty())
        return fmt::format("audit: no effect that is on draws shadows; all ground lit agrees {}",
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
    json["left_out"] = {{"between_posts", left_out.between_posts},
                        {"mixed", left_out.mixed},
                        {"faces_away", left_out.faces_away},
                        {"holes", left_out.holes},
                        {"moved", left_out.moved}};
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
        audit.refusal = error.what();  // a sun cannot be found over maps of the world
        return audit;
    }
    const double reduction = session.dem()->field.reduction;
    for (const render::SunSeen& pixel : session.read_sun_seen())
        compare(pixel, truth, reduction, audit);
    return audit;
}

}  // namespace relevo::session
