#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "base/error.h"
#include "scene/map_view.h"
#include "session/annotations.h"
#include "session/image_parts.h"
#include "session/picture_maker.h"
#include "session/stamps.h"

// Pictures with a margin, in which their stamps stand.

namespace relevo::session {
namespace {

/// Smallest side of the view within a margin [px].
constexpr int kLeastSide_px = 16;
constexpr std::uint8_t kLine = 0x30;  // of the line around the view

/// Where the view is in the picture [px].
struct Place {
    glm::ivec2 corner, size;
};

/// @param shape  of the view that fits into a room
template <typename Shape>
Place place_of(const chart::Margins& margins, const glm::ivec2& whole, const Shape& shape) {
    const glm::ivec2 corner(margins.left, margins.top);
    const glm::ivec2 room = whole - corner - glm::ivec2(margins.right, margins.bottom);
    if (std::min(room.x, room.y) < kLeastSide_px)
        bad_input(fmt::format(
            "--margin: stamps take all of a picture of {} x {} px; use a larger --size, "
            "or omit some of them",
            whole.x, whole.y));
    const glm::ivec2 size = shape(room);
    return {corner + (room - size) / 2, size};
}

/// The largest size that fits into a room and has the proportions of a grid.
glm::ivec2 ground_size(const dem::Grid& grid, const glm::ivec2& room) {
    const glm::dvec2 sides_m = grid.sides_m();
    const double px_per_m = std::min(room.x / sides_m.x, room.y / sides_m.y);
    return glm::max(glm::ivec2(glm::round(px_per_m * sides_m)), glm::ivec2(kLeastSide_px));
}

/// A white picture with the view in it and a line around that.
template <typename T>
image::Pixels<T> framed(const image::Pixels<T>& view, const Place& place, const glm::ivec2& whole) {
    constexpr T kMost = std::numeric_limits<T>::max();
    image::Pixels<T> picture(whole.x, whole.y, view.channels);
    std::ranges::fill(picture.values, kMost);
    const int line = std::max(1, static_cast<int>(chart::stamp_scale(whole.x, whole.y)));
    image::Pixels<T> edge(place.size.x + 2 * line, place.size.y + 2 * line, view.channels);
    for (std::size_t i = 0; i < edge.values.size(); ++i)
        edge.values[i] =
            i % static_cast<std::size_t>(edge.channels) == 3 ? kMost : T(kMost / 255 * kLine);
    put(edge, place.corner - line, picture);
    put(view, place.corner, picture);
    return picture;
}

}  // namespace

image::Picture Session::Impl::make_with_margin(const Session& session, render::PassTimes* times) {
    const glm::ivec2 whole(state.scene.width_px, state.scene.height_px);
    const dem::Grid& grid = session.dem()->source->grid();
    const bool from_above = !state.is_map() && scene::is_from_above(state.scene.view);
    const Place place = place_of(chart::margins_for(planned_stamps(session), whole.x, whole.y),
                                 whole, [&](const glm::ivec2& room) {
                                     return state.is_map() ? scene::map_size(grid, 0, room)
                                            : from_above   ? ground_size(grid, room)
                                                           : room;
                                 });
    struct Sized {  // puts back size and view of the whole picture
        Impl& impl;
        glm::ivec2 whole;
        scene::View view;
        Sized(Impl& of, const glm::ivec2& whole_px, const glm::ivec2& view_px)
            : impl(of), whole(whole_px), view(of.state.scene.view) {
            impl.resize(view_px.x, view_px.y);
        }
        ~Sized() {
            impl.state.scene.width_px = whole.x;
            impl.state.scene.height_px = whole.y;
            impl.state.scene.view = view;
        }
    } const sized(*this, whole, place.size);
    scene::View seen = state.scene.view;
    if (from_above) seen.orbit.zoom = 1 / scene::kFill;  // the ground ends at the line around it
    look(seen);
    PictureMaker maker(*this);
    if (maker.is_tiled()) maker.keep_depths();
    image::Picture picture = maker.whole(times);
    picture_shows_ground = maker.shows_ground();
    map_corner_px = place.corner;
    if (auto* const view = std::get_if<image::Image8>(&picture.pixels))
        picture.pixels = framed(*view, place, whole);
    else
        picture.pixels = framed(std::get<image::Image16>(picture.pixels), place, whole);
    const std::vector<float>* const depths_m = maker.is_tiled() ? &maker.depths_m() : nullptr;
    const chart::Rect map{double(place.corner.x), double(place.corner.y), double(place.size.x),
                          double(place.size.y)};
    annotate(picture, [&](image::Image8& on) {
        std::vector<chart::Rect> taken;
        stamp_notes = add_stamps(session, session.legends(), on, taken, depths_m, map);
        image::Image8 view = cut_out(on, place.corner, place.size);
        draw_marks_on(view, {}, depths_m);
        put(view, place.corner, on);
    });
    return picture;
}

}  // namespace relevo::session
