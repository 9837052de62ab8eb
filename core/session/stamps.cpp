#include "session/stamps.h"

#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/text.h"
#include "base/units.h"
#include "session/graticule.h"
#include "session/seen_ground.h"
#include "sun/zone.h"

namespace relevo::session {
namespace {

/// A scale that is off by no more anywhere in the picture holds everywhere.
constexpr double kMostOff = 0.02;
/// North that is shorter than this share of an unforeshortened length is no direction.
constexpr double kLeastNorth = 0.02;
/// Ground as it is drawn is off the posts by no more [px].
constexpr double kGround_px = 4;

std::string name_of(const scene::Scene& scene) {
    return scene.dems.empty()
               ? std::string()
               : printable(std::filesystem::path(scene.dems.front()).stem().string());
}

std::string length_text(double length_m) {
    return length_m >= 9950  ? fmt::format("{:.0f} km", length_m / 1000)
           : length_m >= 995 ? fmt::format("{:.1f} km", length_m / 1000)
                             : fmt::format("{:.0f} m", length_m);
}

class Stamper {
  public:
    explicit Stamper(const Session& session) : session_(session), wanted_(session.scene().stamps) {
        if (!wanted_.scale && !wanted_.north && !wanted_.graticule) return;
        std::vector<float> depths_m;
        session.read_depths(depths_m);
        seen_.emplace(session.camera(), session.scene().width_px, session.scene().height_px,
                      std::move(depths_m));
        middle_ = seen_->middle();
    }

    chart::Stamps stamps(const std::vector<chart::Legend>& legends) {
        chart::Stamps stamps;
        if (wanted_.legend) stamps.legends = legends;
        if (wanted_.title)
            stamps.title =
                wanted_.title_text.empty() ? name_of(session_.scene()) : wanted_.title_text;
        if (wanted_.attribution) stamps.attribution = wanted_.attribution_text;
        if (wanted_.date) stamps.lines.push_back(session_.clock_text());
        if (wanted_.sun) stamps.lines.push_back("Sun: " + session_.sun_text());
        if (!seen_) return stamps;
        if (!middle_) {
            notes_.emplace_back(
                "stamp: scale, north and graticule are left out: no ground is in the picture");
            return stamps;
        }
        if (wanted_.scale) stamps.scale = scale();
        if (wanted_.north) stamps.north = north();
        return stamps;
    }

    /// Draws the lines of the graticule.
    void add_graticule(image::Image8& picture, chart::Stamps& stamps) {
        if (!wanted_.graticule || !middle_) return;
        const Graticule graticule = make_graticule(*seen_, session_.ground().frame,
                                                   [&](const auto& p) { return is_ground(p); });
        draw_lines(graticule, picture);
        stamps.graticule = graticule.labels;
        if (graticule.labels.empty())
            notes_.emplace_back("stamp: graticule: no line is long enough to be named");
    }

    std::vector<std::string> notes_;

  private:
    chart::Stamps::Scale scale() const {
        const double depth_m = seen_->depth_m(middle_->x, middle_->y);
        const auto [least_m, most_m] = seen_->depth_range_m();
        if (most_m < (1 + kMostOff) * least_m) return {seen_->px_per_m(depth_m), {}};
        const double off_px = std::hypot(middle_->x + 0.5 - 0.5 * seen_->width_px(),
                                         middle_->y + 0.5 - 0.5 * seen_->height_px());
        return {seen_->px_per_m(depth_m), fmt::format("across the view, {}, {} away",
                                                      off_px <= 2 ? "at the picture's middle"
                                                                  : "at the ground nearest to "
                                                                    "the middle",
                                                      length_text(depth_m))};
    }

    std::optional<glm::dvec2> north() {
        const glm::dvec3 point = *seen_->point(middle_->x, middle_->y);
        const geo::LocalFrame& frame = session_.ground().frame;
        const geo::Geodetic place = frame.to_geodetic(point);
        const glm::dvec2 way = seen_->moved(point, frame.axes(place.lat_rad, place.lon_rad).north);
        if (length(way) >= kLeastNorth * seen_->px_per_m(seen_->depth_m(middle_->x, middle_->y)))
            return normalize(way);
        notes_.emplace_back("stamp: north is left out: it lies along the line of sight");
        return std::nullopt;
    }

    /// Walls hang below the ground's edge.
    bool is_ground(const glm::dvec3& point_m) const {
        geo::Geodetic place = session_.ground().frame.to_geodetic(point_m);
        const double drawn_m = place.height_m;
        const LoadedDem& dem = *session_.dem();
        const glm::dvec2 post = dem.field.grid.post(place);
        const double height_m =
            dem.to_draw().height_at(post.x, post.y) * session_.scene().exaggeration;
        const double depth_m = dot(point_m - session_.camera().eye_m, session_.camera().forward);
        return drawn_m >= height_m - kGround_px / seen_->px_per_m(depth_m);
    }

    const Session& session_;
    const scene::Stamps& wanted_;
    std::optional<SeenGround> seen_;
    std::optional<glm::ivec2> middle_;
};

}  // namespace

std::vector<std::string> add_stamps(const Session& session,
                                    const std::vector<chart::Legend>& legends,
                                    image::Image8& picture) {
    Stamper stamper(session);
    chart::Stamps stamps = stamper.stamps(legends);
    stamper.add_graticule(picture, stamps);
    for (const std::string& name : chart::stamp(stamps, picture))
        stamper.notes_.push_back(
            fmt::format("stamp: {}: no room in a picture of {} x {} pixels, "
                        "left out",
                        name, picture.width, picture.height));
    return std::move(stamper.notes_);
}

}  // namespace relevo::session
