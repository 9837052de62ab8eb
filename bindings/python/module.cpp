// The module relevo._relevo: each function of the C interface as one of Python, nothing more. The
// package around it (relevo/*.py) makes arrays, options and results.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <tuple>

#include <pybind11/stl.h>

#include "library.h"

// The module does not know numpy: arrays are buffers of Python, checked for type and gaps, and
// filled in place. It compiles in 7 s, most of it pybind11, and works with any version of numpy.
//
// Rejected: ctypes, which has no types of handles and whose callbacks take the GIL on any thread;
// numpy's headers; and opening a rasterio dataset by its name, which memory files and warped
// datasets do not have.
namespace relevo::python {
namespace {

using Transform = std::array<double, 6>;
using Text = std::optional<std::string>;

const char* text_of(const Text& text) {
    return text ? text->c_str() : nullptr;
}

relevo_place place_of(double lat_deg, double lon_deg, double height_m) {
    auto place = sized<relevo_place>();
    place.lat_deg = lat_deg;
    place.lon_deg = lon_deg;
    place.height_m = height_m;
    return place;
}

// ---- DEMs ----

std::unique_ptr<Dem> open_dem(const std::vector<std::string>& files, const std::string& options) {
    std::vector<const char*> names;
    for (const std::string& file : files)
        names.push_back(file.c_str());
    auto dem = std::make_unique<Dem>();
    call([&] {
        return relevo_dem_open(names.data(), names.size(), options.c_str(), dem->receive());
    });
    return dem;
}

std::unique_ptr<Dem> dem_from_heights(const py::object& heights, const Transform& transform,
                                      const std::string& crs, const std::string& options) {
    const Array array(heights, 'f', Array::Use::Read);
    auto raster = sized<relevo_raster>();
    raster.heights_m = array.data<float>();
    raster.count = array.count();
    raster.columns = array.columns();
    raster.rows = array.rows();
    std::ranges::copy(transform, raster.transform);
    raster.crs = crs.c_str();
    raster.options = options.c_str();
    auto dem = std::make_unique<Dem>();
    call([&] { return relevo_dem_from_heights(&raster, dem->receive()); });
    return dem;
}

/// (columns, rows), geotransform, (latitude, longitude) of the centre, (column, row) spacing [m].
auto grid_of(const Dem& dem) {
    auto grid = sized<relevo_grid>();
    relevo_dem* const handle = dem.get("dem");
    call([&] { return relevo_dem_grid(handle, &grid); });
    Transform transform;
    std::ranges::copy(grid.transform, transform.begin());
    return std::make_tuple(std::pair(grid.columns, grid.rows), transform,
                           std::pair(grid.centre_lat_deg, grid.centre_lon_deg),
                           std::pair(grid.column_spacing_m, grid.row_spacing_m));
}

/// A text that the library returns through a pointer.
template <auto function, typename Handle>
std::string text_from(Handle* handle) {
    std::string text;
    call([&] {
        const char* returned = nullptr;
        const relevo_result result = function(handle, &returned);
        if (result == RELEVO_RESULT_OK) text = returned;
        return result;
    });
    return text;
}

void read(const Dem& dem, const py::object& heights) {
    const Array array(heights, 'f', Array::Use::Write);
    relevo_dem* const handle = dem.get("dem");
    call([&] { return relevo_dem_read(handle, array.data<float>(), array.count()); });
}

/// Arrays that a function takes together are of one length.
void check_length(const Array& array, std::size_t count) {
    if (array.count() != count)
        throw LibraryError{RELEVO_RESULT_BAD_CALL, "arrays: expected one length"};
}

void height(const Dem& dem, const py::object& lat_deg, const py::object& lon_deg,
            const py::object& height_m) {
    const Array lat(lat_deg, 'd', Array::Use::Read), lon(lon_deg, 'd', Array::Use::Read),
        heights(height_m, 'd', Array::Use::Write);
    check_length(lat, heights.count());
    check_length(lon, heights.count());
    relevo_dem* const handle = dem.get("dem");
    call([&] {
        relevo_result result = RELEVO_RESULT_OK;
        for (std::size_t i = 0; i < heights.count() && result == RELEVO_RESULT_OK; ++i)
            result = relevo_dem_height(handle, lat.data<double>()[i], lon.data<double>()[i],
                                       heights.data<double>() + i);
        return result;
    });
}

/// A raster of light: relevo_shadow(), relevo_sun_hours() or relevo_sky_view().
/// @returns its `about`
template <auto function>
std::string raster(const Dem& dem, const std::string& options, const py::object& values,
                   const py::object& progress) {
    const auto array = std::make_shared<Array>(values, 'f', Array::Use::Write);
    relevo_dem* const handle = dem.get("dem");
    return call_long(progress, [=](const relevo_progress* done, std::string& about) {
        const char* text = nullptr;
        const relevo_result result =
            function(handle, options.c_str(), array->data<float>(), array->count(), done, &text);
        if (result == RELEVO_RESULT_OK && text) about = text;
        return result;
    });
}

void horizon(const Dem& dem, double lat_deg, double lon_deg, const std::string& options,
             const py::object& azimuth_deg, const py::object& elevation_deg,
             const py::object& distance_m) {
    const auto azimuth = std::make_shared<Array>(azimuth_deg, 'd', Array::Use::Read),
               elevation = std::make_shared<Array>(elevation_deg, 'd', Array::Use::Write),
               distance = std::make_shared<Array>(distance_m, 'd', Array::Use::Write);
    check_length(*elevation, azimuth->count());
    check_length(*distance, azimuth->count());
    const relevo_place place = place_of(lat_deg, lon_deg, 0);
    relevo_dem* const handle = dem.get("dem");
    call_long(py::none(), [=](const relevo_progress*, std::string&) {
        return relevo_horizon(handle, &place, options.c_str(), azimuth->data<double>(),
                              azimuth->count(), elevation->data<double>(),
                              distance->data<double>());
    });
}

// ---- the sun ----

/// `places` has latitude, longitude and height for all times, or for each time.
void sun_position(const py::object& places, const py::object& times_s, const Text& refraction,
                  const py::object& azimuth_deg, const py::object& elevation_deg,
                  const py::object& apparent_deg) {
    const Array place(places, 'd', Array::Use::Read), times(times_s, 'd', Array::Use::Read),
        azimuth(azimuth_deg, 'd', Array::Use::Write),
        elevation(elevation_deg, 'd', Array::Use::Write),
        apparent(apparent_deg, 'd', Array::Use::Write);
    for (const Array* array : {&azimuth, &elevation, &apparent})
        check_length(*array, times.count());
    const bool one = place.count() == 3;
    if (!one) check_length(place, 3 * times.count());
    call([&] {
        relevo_result result = RELEVO_RESULT_OK;
        const std::size_t step = one ? times.count() : 1;
        for (std::size_t i = 0; i < times.count() && result == RELEVO_RESULT_OK; i += step) {
            const double* const p = place.data<double>() + (one ? 0 : 3 * i);
            const relevo_place at = place_of(p[0], p[1], p[2]);
            result = relevo_sun_position(&at, times.data<double>() + i, step, text_of(refraction),
                                         azimuth.data<double>() + i, elevation.data<double>() + i,
                                         apparent.data<double>() + i);
        }
        return result;
    });
}

/// (kind, seconds since 1970, azimuth, elevation) of each event.
std::vector<std::tuple<std::string, double, double, double>> sun_events(
    double lat_deg, double lon_deg, double height_m, const std::string& date, const Text& zone) {
    const relevo_place place = place_of(lat_deg, lon_deg, height_m);
    std::array<relevo_event, 64> events{};
    events.front().size = sizeof(relevo_event);
    std::size_t count = 0;
    call([&] {
        return relevo_sun_events(&place, date.c_str(), text_of(zone), events.data(), events.size(),
                                 &count);
    });
    std::vector<std::tuple<std::string, double, double, double>> result;
    for (std::size_t i = 0; i < std::min(count, events.size()); ++i)
        result.emplace_back(events[i].kind, events[i].time_s, events[i].azimuth_deg,
                            events[i].elevation_deg);
    return result;
}

// ---- pictures ----

std::unique_ptr<Session> open_session(const Text& scene, const Dem& dem, const Text& device) {
    auto options = sized<relevo_open_options>();
    options.device = text_of(device);
    options.dem = dem.get("dem");
    auto session = std::make_unique<Session>();
    call([&] { return relevo_open(text_of(scene), &options, session->receive()); });
    return session;
}

void set(const Session& session, const std::string& change) {
    relevo_session* const handle = session.get("view");
    call([&] { return relevo_set(handle, change.c_str()); });
}

std::pair<int, int> picture_size(const Session& session) {
    std::int32_t columns = 0, rows = 0;
    relevo_session* const handle = session.get("view");
    call([&] { return relevo_picture_size(handle, &columns, &rows); });
    return {columns, rows};
}

/// Fills those arrays that are not None. @returns the origin of positions
std::tuple<double, double, double> draw(const Session& session, const py::object& rgba,
                                        const py::object& depth, const py::object& position,
                                        const py::object& normal) {
    std::optional<Array> held[4];
    const auto hold = [&](int i, const py::object& array, char format, auto& data,
                          std::size_t& count) {
        if (array.is_none()) return;
        held[i].emplace(array, format, Array::Use::Write);
        data = held[i]->data<std::remove_reference_t<decltype(*data)>>();
        count = held[i]->count();
    };
    auto picture = sized<relevo_picture>();
    hold(0, rgba, 'B', picture.rgba, picture.rgba_count);
    hold(1, depth, 'f', picture.depth_m, picture.depth_count);
    hold(2, position, 'f', picture.position_m, picture.position_count);
    hold(3, normal, 'f', picture.normal, picture.normal_count);
    relevo_session* const handle = session.get("view");
    call([&] { return relevo_draw_picture(handle, &picture); });
    return {picture.origin_lat_deg, picture.origin_lon_deg, picture.origin_height_m};
}

/// Closing waits for the session's thread, others go on meanwhile.
void close(Session& session) {
    const py::gil_scoped_release released;
    session.close();
}

void to_python(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const LibraryError& error) {
        const py::object raised =
            py::module_::import("relevo._errors").attr("error_of")(error.code, error.text);
        PyErr_SetObject(py::type::handle_of(raised).ptr(), raised.ptr());
    }
}

void add_dem(py::module_& module) {
    py::class_<Dem>(module, "Dem")
        .def_property_readonly("closed", &Dem::closed)
        .def("close", &Dem::close)
        .def("grid", &grid_of)
        .def("crs", [](const Dem& dem) { return text_from<relevo_dem_crs>(dem.get("dem")); })
        .def("wkt", [](const Dem& dem) { return text_from<relevo_dem_wkt>(dem.get("dem")); })
        .def("read", &read)
        .def("height", &height)
        .def("shadow", &raster<relevo_shadow>)
        .def("sun_hours", &raster<relevo_sun_hours>)
        .def("sky_view", &raster<relevo_sky_view>)
        .def("horizon", &horizon);
}

void add_session(py::module_& module) {
    py::class_<Session>(module, "Session")
        .def_property_readonly("closed", &Session::closed)
        .def("close", &close)
        .def("set", &set)
        .def("scene",
             [](const Session& session) { return text_from<relevo_scene>(session.get("view")); })
        .def("picture_size", &picture_size)
        .def("draw", &draw);
}

}  // namespace
}  // namespace relevo::python

PYBIND11_MODULE(_relevo, module) {
    using namespace relevo::python;
    py::register_local_exception_translator(to_python);
    keep_messages();
    py::module_::import("atexit").attr("register")(py::cpp_function(finish_calls));
    add_dem(module);
    add_session(module);
    module.def("version", &relevo_version);
    module.def("take_messages", &take_messages);
    module.def("open_dem", &open_dem);
    module.def("dem_from_heights", &dem_from_heights);
    module.def("open_session", &open_session);
    module.def("sun_position", &sun_position);
    module.def("sun_events", &sun_events);
}
