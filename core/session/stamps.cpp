#include "session/stamps.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/text.h"
#include "names/ground_name.h"
#include "scene/map_view.h"
#include "scene/sheet.h"
#include "session/graticule.h"
#include "session/image_parts.h"
#include "session/seen_ground.h"
#include "sun/zone.h"
#include "sun/zone_of_place.h"

namespace relevo::session {
namespace {

/// If depths vary by less than this fraction, one scale holds for the whole image.
constexpr double kMostOff = 0.02;
/// Least foreshortening of north at which an arrow is drawn.
constexpr double kLeastNorth = 0.02;
/// Greatest distance of drawn ground from the DEM's surface [px].
constexpr double kGround_px = 4;

/// By the names that Relevo knows on a DEM, else by its file.
std::string name_of(const scene::Scene& scene, const dem::Grid& grid) {
    const std::string known = names::ground_name(names::Gazetteer::shipped(), grid);
    if (!known.empty()) return known;
    return scene.dems.empty()
               ? std::string()
               : printable(std::filesystem::path(scene.dems.front()).stem().string());
}

std::string title_of(const Stamped& of) {
    const std::string& given = of.scene.stamps.title_text;
    if (!given.empty()) return given;
    const auto& map = of.camera.map;
    if (!of.scene.sheet.is_on() || !map) return name_of(of.scene, of.dem.source->grid());
    // A sheet may have a part of the DEM only.
    const scene::MapArea& area = map->area();
    return name_of(of.scene,
                   dem::Grid(area.width_px, area.height_px,
                             dem::Affine::of_geotransform(area.geotransform()), map->grid().crs()));
}

std::string length_text(double length_m) {
    return length_m >= 9950  ? fmt::format("{:.0f} km", length_m / 1000)
           : length_m >= 995 ? fmt::format("{:.1f} km", length_m / 1000)
                             : fmt::format("{:.0f} m", length_m);
}

bool is_of_one_camera(const scene::View& view) {
    return view.panorama == scene::Panorama::None && view.stereo == scene::Stereo::None;
}

class Stamper {
  public:
    /// @param stamped  must outlive this; its depths are moved from
    Stamper(Stamped& stamped, const image::Image8& picture)
        : of_(stamped), wanted_(of_any_projection(stamped.scene, notes_)) {
        if (!needs_depths(wanted_)) return;
        seen_.emplace(of_.camera, picture.width, picture.height, std::move(stamped.depths_m));
        middle_ = seen_->middle();
    }
    /// For planned().
    explicit Stamper(const Stamped& stamped) : of_(stamped), wanted_(stamped.scene.stamps) {}

    /// As planned_stamps().
    chart::Stamps planned(const std::vector<chart::Legend>& legends) {
        chart::Stamps stamps = words(legends);
        if (wanted_.scale)
            stamps.scale = {1, "across the view, at the picture's middle, 000 km away", {}};
        if (wanted_.north) stamps.north = glm::dvec2(0, -1);
        if (wanted_.graticule) stamps.graticule.push_back({.words = "000°00'00\"W"});
        return stamps;
    }

    chart::Stamps words(const std::vector<chart::Legend>& legends) {
        chart::Stamps stamps;
        if (wanted_.legend) stamps.legends = legends;
        if (wanted_.title) stamps.title = title_of(of_);
        if (wanted_.attribution) stamps.attribution = wanted_.attribution_text;
        if (wanted_.date) add_line("", of_.clock, "date", stamps);
        if (wanted_.sun) add_line("Sun: ", of_.sun, "sun", stamps);
        if (const double times = of_.scene.exaggeration; wanted_.exaggeration && times != 1)
            stamps.lines.push_back(fmt::format("Heights × {:g}", times));
        stamps.bare_lines =
            wanted_.exaggeration && !wanted_.date && !wanted_.sun && !wanted_.margin;
        return stamps;
    }

    chart::Stamps stamps(const std::vector<chart::Legend>& legends) {
        chart::Stamps stamps = words(legends);
        if (!seen_) return stamps;
        if (!middle_) {
            notes_.emplace_back(
                "stamp: scale, north and graticule are omitted: the picture shows no ground");
            return stamps;
        }
        if (wanted_.scale) stamps.scale = scale();
        if (wanted_.north) stamps.north = north();
        return stamps;
    }

    /// Draws the lines and adds their labels to `stamps`.
    void add_graticule(image::Image8& picture, chart::Stamps& stamps) {
        if (!wanted_.graticule || !middle_) return;
        const Graticule graticule =
            make_graticule(*seen_, of_.frame, [&](const auto& p) { return is_ground(p); });
        draw_lines(graticule, picture);
        stamps.graticule = graticule.labels;
        if (graticule.labels.empty())
            notes_.emplace_back("stamp: graticule: no line is long enough to be named");
    }

    std::vector<std::string>& notes() { return notes_; }

  private:
    /// The stamps that a scene wants, without those that need a perspective picture.
    static scene::Stamps of_any_projection(const scene::Scene& scene,
                                           std::vector<std::string>& notes) {
        scene::Stamps stamps = scene.stamps;
        if (is_of_one_camera(scene.view) || !needs_depths(stamps)) return stamps;
        stamps.scale = stamps.north = stamps.graticule = false;
        notes.emplace_back(
            "stamp: scale, north and graticule are not drawn on panoramas and stereo pairs");
        return stamps;
    }

    /// The date and sun of an overlay come from its metadata or are omitted: those of the scene may
    /// differ.
    void add_line(const char* label, const std::string& words, const char* name,
                  chart::Stamps& stamps) {
        if (words.empty())
            notes_.push_back(
                fmt::format("stamp: {} is omitted: the overlay is not of one {}", name, name));
        else
            stamps.lines.push_back(label + words);
    }

    chart::Stamps::Scale scale() const {
        const double depth_m = seen_->depth_m(middle_->x, middle_->y);
        const auto& map = of_.camera.map;
        if (map && map->grid().crs().is_geographic())  // as wide as long, whatever the latitude
            return {seen_->px_per_m(depth_m), "from west to east, in the middle"};
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
        const geo::LocalFrame& frame = of_.frame;
        const geo::Geodetic place = frame.to_geodetic(point);
        const glm::dvec2 way = seen_->moved(point, frame.axes(place.lat_rad, place.lon_rad).north);
        if (length(way) >= kLeastNorth * seen_->px_per_m(seen_->depth_m(middle_->x, middle_->y)))
            return normalize(way);
        notes_.emplace_back("stamp: north is omitted: it lies along the line of sight");
        return std::nullopt;
    }

    /// False for walls below the ground's edge.
    bool is_ground(const glm::dvec3& point_m) const {
        geo::Geodetic place = of_.frame.to_geodetic(point_m);
        const double drawn_m = place.height_m;
        const glm::dvec2 post = of_.dem.field.grid.post(place);
        const double height_m =
            of_.dem.to_draw().height_at(post.x, post.y) * of_.scene.exaggeration;
        const double depth_m = dot(point_m - of_.camera.eye_m, of_.camera.forward);
        return drawn_m >= height_m - kGround_px / seen_->px_per_m(depth_m);
    }

    std::vector<std::string> notes_;
    const Stamped& of_;
    const scene::Stamps wanted_;
    std::optional<SeenGround> seen_;
    std::optional<glm::ivec2> middle_;
};

}  // namespace

bool needs_depths(const scene::Stamps& wanted) {
    return wanted.scale || wanted.north || wanted.graticule;
}

std::optional<geo::Geodetic> observer_of(const geo::LocalFrame& frame, const scene::Camera& camera,
                                         double exaggeration) {
    constexpr double kHighest_m = 100e3;
    geo::Geodetic eye = frame.to_geodetic(camera.eye_m);
    eye.height_m /= exaggeration;
    return eye.height_m <= kHighest_m ? std::optional(eye) : std::nullopt;
}

std::string clock_text(sun::Instant utc, const std::string& zone, const geo::Geodetic& middle) {
    return clock_text(utc, sun::choose_zone(zone, middle).zone);
}

std::string clock_text(sun::Instant utc, const sun::Zone& zone) {
    const std::string iso = sun::to_iso(utc, zone);  // such as 2026-06-21T10:12:00+02:00
    const std::string seconds = iso.substr(16, 3), offset = iso.substr(19);
    return fmt::format("{} {}{} UTC{}", iso.substr(0, 10), iso.substr(11, 5),
                       seconds == ":00" ? "" : seconds, offset == "Z" ? "" : offset);
}

namespace {

std::string no_room_text(const std::string& name, const glm::ivec2& picture_px) {
    return fmt::format("stamp: {}: no room in a picture of {} x {} pixels; omitted", name,
                       picture_px.x, picture_px.y);
}

/// Where true north is at the middle of a map.
glm::dvec2 north_of(const scene::MapView& map, const geo::LocalFrame& frame) {
    const glm::dvec2 middle = 0.5 * map.size_px();
    const glm::dvec3 point = map.point_m(middle, 0);
    const geo::Geodetic place = frame.to_geodetic(point);
    const double step_m = map.pixel_m(middle).y;
    const glm::dvec3 north = frame.axes(place.lat_rad, place.lon_rad).north;
    return normalize(map.pixel_of(point + step_m * glm::dvec3(north)) - middle);
}

/// Without depths.
Stamped stamped_of(const Session& session) {
    const scene::Stamps& wanted = session.scene().stamps;
    Stamped stamped{session.scene(), *session.dem(), session.ground().frame, session.camera()};
    const std::optional<OverlayTime>& laid = session.overlay_time();
    if (wanted.date)
        stamped.clock =
            laid ? clock_text(*laid, session.scene().time.zone, session.ground().frame.origin())
                 : session.clock_text();
    if (wanted.sun) stamped.sun = laid ? sun_text(*laid) : session.sun_text();
    return stamped;
}

}  // namespace

chart::Stamps planned_stamps(const Session& session) {
    return Stamper(stamped_of(session)).planned(session.legends());
}

std::vector<std::string> add_stamps(const Session& session,
                                    const std::vector<chart::Legend>& legends,
                                    image::Image8& picture, std::vector<chart::Rect>& taken,
                                    const std::vector<float>* depths_m,
                                    const std::optional<chart::Rect>& map) {
    Stamped stamped = stamped_of(session);
    const bool deep = needs_depths(session.scene().stamps);
    if (deep && depths_m) stamped.depths_m = *depths_m;
    if (deep && !depths_m && is_of_one_camera(session.scene().view))
        session.read_depths(stamped.depths_m);
    return add_stamps(std::move(stamped), legends, picture, taken, map);
}

std::vector<std::string> add_stamps(Stamped stamped, const std::vector<chart::Legend>& legends,
                                    image::Image8& picture, std::vector<chart::Rect>& taken,
                                    const std::optional<chart::Rect>& map) {
    const chart::Rect all{0, 0, double(picture.width), double(picture.height)};
    const chart::Rect at = map.value_or(all);
    const glm::ivec2 corner(at.x, at.y);
    image::Image8 view = cut_out(picture, corner, glm::ivec2(at.width, at.height));
    Stamper stamper(stamped, view);
    chart::Stamps stamps = stamper.stamps(legends);
    stamper.add_graticule(view, stamps);
    put(view, corner, picture);
    for (chart::Stamps::Label& label : stamps.graticule)
        label.at_px += glm::dvec2(corner);
    for (const std::string& name : chart::stamp(stamps, picture, &taken, map))
        stamper.notes().push_back(no_room_text(name, {picture.width, picture.height}));
    return std::move(stamper.notes());
}

SheetStamps lay_out_sheet(const Session& session, const SheetRoom& room) {
    const Stamped stamped = stamped_of(session);
    const scene::Stamps& wanted = stamped.scene.stamps;
    const scene::MapView& map = *stamped.camera.map;
    Stamper stamper(stamped);
    chart::Stamps stamps = stamper.words(session.legends());
    if (wanted.scale)
        stamps.scale = {1 / map.pixel_m(0.5 * map.size_px()).x, scene::projection_text(map.grid()),
                        scene::scale_text(stamped.scene.sheet.scale)};
    if (wanted.north) stamps.north = north_of(map, stamped.frame);
    // As tall as map and stamps are, in the middle of the sheet.
    const chart::Margins& margins = room.margins;
    const glm::ivec2 all(room.room_px.x, room.map_px.y + margins.top + margins.bottom);
    const glm::ivec2 corner = (room.sheet_px - all) / 2;
    const int free_px = all.x - margins.left - margins.right - room.map_px.x;
    const chart::Rect at{double(margins.left + free_px / 2), double(margins.top),
                         double(room.map_px.x), double(room.map_px.y)};
    SheetStamps result{.map = at, .title = title_of(stamped)};
    if (wanted.graticule) {
        MapGraticule lines = make_graticule(map, room.unit_px);
        result.drawings.push_back({std::move(lines.drawing), {at.x, at.y}, 1});
        for (chart::Stamps::Label& label : lines.labels)
            label.at_px += glm::dvec2(at.x, at.y);
        stamps.graticule = std::move(lines.labels);
    }
    chart::LaidStamps laid = chart::lay_out(stamps, all, room.unit_px, at);
    std::ranges::move(laid.drawings, std::back_inserter(result.drawings));
    result.taken = std::move(laid.taken);
    result.notes = std::move(stamper.notes());
    for (const std::string& name : laid.missing)
        result.notes.push_back(no_room_text(name, room.sheet_px));
    for (chart::Placed& placed : result.drawings)
        placed.corner_px += glm::dvec2(corner);
    result.taken.push_back(result.map);
    for (chart::Rect& rect : result.taken) {
        rect.x += corner.x;
        rect.y += corner.y;
    }
    result.map = result.taken.back();
    result.taken.pop_back();
    return result;
}

}  // namespace relevo::session
