#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "base/error.h"
#include "scene/map_view.h"
#include "scene/sheet.h"
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
image::Pixels<T> framed(const image::Pixels<T>& view, const Place& place, const glm::ivec2& whole,
                        int line) {
    constexpr T kMost = std::numeric_limits<T>::max();
    image::Pixels<T> picture(whole.x, whole.y, view.channels);
    std::ranges::fill(picture.values, kMost);
    image::Pixels<T> edge(place.size.x + 2 * line, place.size.y + 2 * line, view.channels);
    for (std::size_t i = 0; i < edge.values.size(); ++i)
        edge.values[i] =
            i % static_cast<std::size_t>(edge.channels) == 3 ? kMost : T(kMost / 255 * kLine);
    put(edge, place.corner - line, picture);
    put(view, place.corner, picture);
    return picture;
}

void frame(image::Picture& picture, const Place& place, const glm::ivec2& whole, double unit_px) {
    const int line = std::max(1, static_cast<int>(unit_px));
    if (auto* const view = std::get_if<image::Image8>(&picture.pixels))
        picture.pixels = framed(*view, place, whole, line);
    else
        picture.pixels = framed(std::get<image::Image16>(picture.pixels), place, whole, line);
}

chart::Rect rect_of(const Place& place) {
    return {double(place.corner.x), double(place.corner.y), double(place.size.x),
            double(place.size.y)};
}

/// Puts back size, view and scale of the whole picture.
template <typename Impl>
struct Sized {
    Impl& impl;
    glm::ivec2 whole;
    scene::View view;
    scene::Sheet sheet;
    Sized(Impl& of, const glm::ivec2& view_px)
        : impl(of),
          whole(of.state.scene.width_px, of.state.scene.height_px),
          view(of.state.scene.view),
          sheet(of.state.scene.sheet) {
        impl.resize(view_px.x, view_px.y);
    }
    ~Sized() {
        impl.state.scene.width_px = whole.x;
        impl.state.scene.height_px = whole.y;
        impl.state.scene.view = view;
        impl.state.scene.sheet = sheet;
    }
};

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
    const Sized sized(*this, place.size);
    scene::View seen = state.scene.view;
    if (from_above) seen.orbit.zoom = 1 / scene::kFill;  // the ground ends at the line around it
    look(seen);
    PictureMaker maker(*this);
    if (maker.is_tiled()) maker.keep_depths();
    image::Picture picture = maker.whole(times);
    picture_shows_ground = maker.shows_ground();
    map_corner_px = place.corner;
    frame(picture, place, whole, chart::stamp_scale(whole.x, whole.y));
    const std::vector<float>* const depths_m = maker.is_tiled() ? &maker.depths_m() : nullptr;
    annotate(picture, [&](image::Image8& on) {
        std::vector<chart::Rect> taken;
        stamp_notes = add_stamps(session, session.legends(), on, taken, depths_m, rect_of(place));
        image::Image8 view = cut_out(on, place.corner, place.size);
        draw_marks_on(view, {}, depths_m);
        put(view, place.corner, on);
    });
    return picture;
}

image::Picture Session::Impl::make_sheet(const Session& session, render::PassTimes* times) {
    const scene::Sheet sheet = state.scene.sheet;
    const dem::Grid& grid = session.dem()->source->grid();
    const glm::ivec2 whole(state.scene.width_px, state.scene.height_px);
    const glm::ivec2 edge(static_cast<int>(std::lround(scene::sheet_edge_px(sheet))));
    SheetRoom room{
        .sheet_px = whole, .room_px = whole - 2 * edge, .unit_px = scene::sheet_unit_px(sheet)};
    room.margins = chart::margins_for(planned_stamps(session), room.room_px.x, room.unit_px);
    scene::Sheet settled = sheet;
    double fitting = 0;
    room.map_px = place_of(room.margins, room.room_px, [&](const glm::ivec2& left_px) {
                      fitting = scene::fitting_scale(grid, sheet.dpi, left_px);
                      if (!(sheet.scale > 0)) settled.scale = fitting;
                      return scene::sheet_map_px(grid, settled.scale, sheet.dpi, left_px);
                  }).size;
    const Sized sized(*this, room.map_px);
    state.scene.sheet = settled;
    look(state.scene.view);
    PictureMaker maker(*this);
    if (maker.is_tiled() && has_marks()) maker.keep_depths();
    image::Picture picture = maker.whole(times);
    picture.dpi = sheet.dpi;
    picture_shows_ground = maker.shows_ground();
    SheetStamps stamps = lay_out_sheet(session, room);
    map_corner_px = {static_cast<int>(stamps.map.x), static_cast<int>(stamps.map.y)};
    if (has_marks())
        for (chart::Drawing& marks :
             mark_drawings(room.map_px, {}, maker.is_tiled() ? &maker.depths_m() : nullptr))
            stamps.drawings.push_back({std::move(marks), glm::dvec2(map_corner_px), 1});
    stamp_notes = std::move(stamps.notes);
    if (settled.scale < fitting * (1 - 1e-9))
        stamp_notes.push_back(fmt::format("sheet: {} has the middle of the DEM; {} has all of it",
                                          scene::scale_text(settled.scale),
                                          scene::scale_text(fitting)));
    if (options.format->map_alone) {
        paper_sheet = std::make_shared<const chart::PaperSheet>(
            chart::PaperSheet{.size_mm = scene::sheet_mm(sheet, grid),
                              .dpi = sheet.dpi,
                              .picture = stamps.map,
                              .line_px = room.unit_px,
                              .drawings = std::move(stamps.drawings),
                              .taken = std::move(stamps.taken),
                              .title = stamps.title,
                              .author = state.scene.stamps.attribution_text});
        return picture;
    }
    frame(picture, {map_corner_px, room.map_px}, whole, room.unit_px);
    annotate(picture, [&](image::Image8& on) {
        for (const chart::Placed& placed : stamps.drawings)
            chart::paint(placed, on);
    });
    return picture;
}

}  // namespace relevo::session
