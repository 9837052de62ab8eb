#include "geo/crs.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "geo/other_body.h"
#include "geo/proj.h"
#include "geo/proj_files.h"

namespace relevo::geo {
namespace {

struct DestroyContext {
    void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct DestroyPj {
    void operator()(PJ* pj) const { proj_destroy(pj); }
};
using Context = std::unique_ptr<PJ_CONTEXT, DestroyContext>;
using Pj = std::unique_ptr<PJ, DestroyPj>;

// A PROJ object may be used by one thread at a time, and so may the context it was made in: the two
// travel together. Declared in this order, the object goes first.
struct Transformation {
    Context context;
    Pj pj;  // from x, y of the CRS to longitude, latitude in degrees, WGS 84

    Transformation clone() const {
        Transformation copy;
        copy.context.reset(proj_context_clone(context.get()));
        proj_log_level(copy.context.get(), PJ_LOG_NONE);
        open_regular_files_only(copy.context.get());
        copy.pj.reset(proj_clone(copy.context.get(), pj.get()));
        if (!copy.pj) failed("CRS: a PROJ transformation could not be copied");
        return copy;
    }
};

// Global grids with posts on the poles overshoot 90 degrees by rounding.
constexpr double kPoleSlack_deg = 1e-7;
// Rasters count longitudes from Greenwich, from the date line, or on past a turn; nothing counts
// two turns.
constexpr double kMaxTurnedLon_deg = 720;

Geodetic nowhere() {
    return {kNaN, kNaN, 0};
}

Geodetic checked_deg(double lon_deg, double lat_deg) {
    if (!(std::abs(lat_deg) <= 90 + kPoleSlack_deg && std::abs(lon_deg) <= kMaxTurnedLon_deg))
        return nowhere();
    return geodetic_deg(std::clamp(lat_deg, -90.0, 90.0), lon_deg);
}

std::string shortened(std::string_view text) {
    constexpr std::size_t kLongest = 60;
    if (text.size() <= kLongest) return std::string(text);
    return fmt::format("{}...", text.substr(0, kLongest - 3));
}

/// Collects what PROJ logs, so that it becomes part of our message instead of going to stderr.
void keep_last_message(void* to, int, const char* message) {
    // PROJ begins with the function that complains: "proj_create: crs not found".
    std::string_view text = message;
    if (const std::size_t colon = text.find(": "); colon != std::string_view::npos)
        text.remove_prefix(colon + 2);
    *static_cast<std::string*>(to) = trimmed(text.substr(0, text.find('\n')));
}

struct Axis {
    std::string unit_name;
    double unit_si = 1;
    bool down = false;
};

std::optional<Axis> axis_of(PJ_CONTEXT* context, const PJ* crs, int index) {
    const Pj system(proj_crs_get_coordinate_system(context, crs));
    if (!system || proj_cs_get_axis_count(context, system.get()) <= index) return std::nullopt;
    const char* direction = nullptr;
    const char* unit_name = nullptr;
    Axis axis;
    if (!proj_cs_get_axis_info(context, system.get(), index, nullptr, nullptr, &direction,
                               &axis.unit_si, &unit_name, nullptr, nullptr))
        return std::nullopt;
    axis.unit_name = unit_name ? unit_name : "";
    axis.down = direction && equal_ignoring_case(direction, "down");
    return axis;
}

bool is_ellipsoidal(PJ_CONTEXT* context, const PJ* crs) {
    const Pj system(proj_crs_get_coordinate_system(context, crs));
    return system && proj_cs_get_type(context, system.get()) == PJ_CS_TYPE_ELLIPSOIDAL;
}

std::string code_of(const PJ* object) {
    const char* authority = proj_get_id_auth_name(object, 0);
    const char* code = proj_get_id_code(object, 0);
    return authority && code ? fmt::format("{}:{}", authority, code) : std::string();
}

/// The CRS itself where it is bound to a datum shift of its own (TOWGS84), else a copy.
Pj unbound(PJ_CONTEXT* context, const PJ* crs) {
    if (proj_get_type(crs) == PJ_TYPE_BOUND_CRS) return Pj(proj_get_source_crs(context, crs));
    return Pj(proj_clone(context, crs));
}

const char* kind_without_place(PJ_TYPE type) {
    switch (type) {
        case PJ_TYPE_ENGINEERING_CRS:
            return "a local (engineering)";
        case PJ_TYPE_VERTICAL_CRS:
            return "a vertical";
        case PJ_TYPE_GEOCENTRIC_CRS:
            return "a geocentric";
        case PJ_TYPE_TEMPORAL_CRS:
            return "a temporal";
        default:
            return nullptr;
    }
}

/// Whether PROJ reads the text as a definition or a code; what is left is searched as a name, and
/// PROJ then takes the nearest ("foo" finds Amersfoort), which is not for us.
bool is_name(std::string_view text) {
    const bool is_wkt = text.find('[') != std::string_view::npos;
    const bool is_json = text.starts_with('{');
    const bool has_code = text.find(':') != std::string_view::npos;
    const bool is_proj = text.find('=') != std::string_view::npos;
    return !is_wkt && !is_json && !has_code && !is_proj;
}

/// The name of a CRS for people; where it has none, what it is: "Transverse Mercator on WGS 84".
std::string readable_name(PJ_CONTEXT* context, const PJ* crs) {
    const char* given = proj_get_name(crs);
    const std::string name = given ? given : "";
    if (!name.empty() && name != "unnamed" && name != "unknown") return name;
    const Pj operation(proj_crs_get_coordoperation(context, crs));
    const Pj base(proj_get_source_crs(context, crs));
    const char* method = nullptr;
    if (!operation || !base ||
        !proj_coordoperation_get_method_info(context, operation.get(), &method, nullptr, nullptr) ||
        !method) {
        const Pj datum(proj_crs_get_datum_forced(context, crs));
        const char* datum_name = datum ? proj_get_name(datum.get()) : nullptr;
        return datum_name ? datum_name : "unnamed";
    }

    return fmt::format("{} on {}", method, readable_name(context, base.get()));
}

/// Whether PROJ takes the text for an operation unless told that it defines a CRS.
bool wants_type_crs(std::string_view text) {
    if (text.find("pipeline") != std::string_view::npos ||
        text.find("type=crs") != std::string_view::npos)
        return false;
    return text.starts_with('+') || text.starts_with("proj=") || text.starts_with("init=");
}

[[noreturn]] void unknown(std::string_view who, std::string_view text, std::string_view reason) {
    const bool digits =
        std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
    const std::string remedy = digits && !text.empty() ? fmt::format("perhaps EPSG:{}", text)
                                                       : "write EPSG:n, WKT or a PROJ string";
    bad_input(fmt::format("{}: {}: not a coordinate reference system that PROJ knows{}{}; {}", who,
                          text.empty() ? "\"\"" : shortened(text), reason.empty() ? "" : ", ",
                          reason, remedy));
}

/// The CRS that a text means. @param reason  what PROJ has logged last
Pj created(PJ_CONTEXT* c, std::string_view text, std::string_view who, const std::string& reason) {
    std::string definition(text);
    if (wants_type_crs(text)) definition += text.starts_with('+') ? " +type=crs" : " type=crs";
    if (equal_ignoring_case(text, "WGS84")) definition = "EPSG:4326";
    Pj crs(text.empty() ? nullptr : proj_create(c, definition.c_str()));
    if (!crs) unknown(who, text, reason);
    if (!proj_is_crs(crs.get())) unknown(who, text, "it is an operation");
    const std::string name = proj_get_name(crs.get());
    if (is_name(text) && definition == text && !equal_ignoring_case(name, text))
        unknown(who, text, fmt::format("the nearest name is \"{}\"", name));
    return crs;
}

}  // namespace

struct Crs::Impl {
    std::string name;
    std::string code;
    std::string wkt;
    bool geographic = false;
    bool is_wgs84 = false;
    Axis axis;
    std::optional<VerticalCrs> vertical;

    // Transformations that no call is using. The first one made is never handed out: it is what
    // others are copied from, under the mutex.
    mutable std::mutex mutex;
    Transformation original;
    mutable std::vector<Transformation> idle;

    /// @throws Error (BadInput) as Crs::parse()
    static std::shared_ptr<const Impl> parse(std::string_view text, std::string_view who);

    /// Reads the vertical part, and completes the code with it. False where it cannot be read.
    bool settle_vertical(PJ_CONTEXT* c, const PJ* compound, const std::string& horizontal_code);
    /// Makes the transformation to WGS 84, and keeps its context. False where PROJ knows none.
    bool settle_way(Context& context, const PJ* horizontal, const PJ* wgs84);

    /// Calls body(PJ_CONTEXT*, PJ*) with a transformation that is this call's alone.
    template <typename Body>
    void borrow(const Body& body) const {
        Transformation mine;
        {
            const std::lock_guard lock(mutex);
            if (idle.empty()) {
                mine = original.clone();
            } else {
                mine = std::move(idle.back());
                idle.pop_back();
            }
        }
        body(mine.context.get(), mine.pj.get());
        const std::lock_guard lock(mutex);
        idle.push_back(std::move(mine));
    }

    /// Geographic coordinates that are no place would pass through a null transformation as they
    /// are.
    bool is_expressible(double x, double y) const {
        if (!geographic) return true;
        const double unit_deg = degrees(axis.unit_si);
        return std::abs(y) * unit_deg <= 90 + kPoleSlack_deg &&
               std::abs(x) * unit_deg <= kMaxTurnedLon_deg;
    }

    Geodetic place(PJ* pj, double x, double y) const {
        if (!is_expressible(x, y)) return nowhere();
        // The time is left open, HUGE_VAL, as PROJ asks for.
        const PJ_COORD out = proj_trans(pj, PJ_FWD, proj_coord(x, y, 0, HUGE_VAL));
        return checked_deg(out.xy.x, out.xy.y);
    }
};

namespace {

const std::string kWgs84Name = "WGS 84";
const std::string kWgs84Code = "EPSG:4326";
const std::string kDegree = "degree";
const std::optional<VerticalCrs> kNoVertical;
const std::string kWgs84Wkt =
    "GEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS 84\",6378137,"
    "298.257223563,LENGTHUNIT[\"metre\",1]]],PRIMEM[\"Greenwich\",0,ANGLEUNIT[\"degree\","
    "0.0174532925199433]],CS[ellipsoidal,2],AXIS[\"geodetic latitude (Lat)\",north,ORDER[1],"
    "ANGLEUNIT[\"degree\",0.0174532925199433]],AXIS[\"geodetic longitude (Lon)\",east,ORDER[2],"
    "ANGLEUNIT[\"degree\",0.0174532925199433]],ID[\"EPSG\",4326]]";

}  // namespace

Crs::Crs() = default;
Crs::Crs(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Crs Crs::parse(std::string_view given, std::string_view who) {
    constexpr std::size_t kMostKept = 64;
    struct Kept {
        std::mutex mutex;
        std::map<std::string, std::shared_ptr<const Impl>, std::less<>> by_text;
    };
    // Never destroyed: PROJ's library may be gone when this would be.
    static Kept& kept = *new Kept;
    const std::string_view text = trimmed(given);
    {
        const std::lock_guard lock(kept.mutex);
        if (const auto found = kept.by_text.find(text); found != kept.by_text.end())
            return Crs(found->second);
    }
    std::shared_ptr<const Impl> fresh = Impl::parse(text, who);
    const std::lock_guard lock(kept.mutex);
    if (kept.by_text.size() >= kMostKept) kept.by_text.clear();
    return Crs(kept.by_text.emplace(text, std::move(fresh)).first->second);
}

bool Crs::Impl::settle_vertical(PJ_CONTEXT* c, const PJ* compound,
                                const std::string& horizontal_code) {
    const Pj bound(proj_crs_get_sub_crs(c, compound, 1));
    const Pj found = bound ? unbound(c, bound.get()) : nullptr;
    const std::optional<Axis> up = found ? axis_of(c, found.get(), 0) : std::nullopt;
    if (!up) return false;
    vertical = VerticalCrs{proj_get_name(found.get()), code_of(found.get()), up->unit_name,
                           up->unit_si, up->down};
    // EPSG's own short form for a pair that has no code of its own.
    if (code.empty() && horizontal_code.starts_with("EPSG:") &&
        vertical->code.starts_with("EPSG:") && proj_get_type(bound.get()) != PJ_TYPE_BOUND_CRS)
        code = fmt::format("{}+{}", horizontal_code, vertical->code.substr(5));
    return true;
}

bool Crs::Impl::settle_way(Context& context, const PJ* horizontal, const PJ* wgs84) {
    PJ_CONTEXT* const c = context.get();
    const Pj authority_order(
        proj_create_crs_to_crs_from_pj(c, horizontal, wgs84, nullptr, nullptr));
    Pj gis_order(authority_order ? proj_normalize_for_visualization(c, authority_order.get())
                                 : nullptr);
    if (!gis_order) return false;
    // Nobody reads what single points have to say.
    proj_log_func(c, nullptr, [](void*, int, const char*) {});
    original.pj = std::move(gis_order);
    original.context = std::move(context);
    return true;
}

std::shared_ptr<const Crs::Impl> Crs::Impl::parse(std::string_view text, std::string_view who) {
    auto impl = std::make_shared<Impl>();
    std::string reason;
    Context context(proj_context_create());
    PJ_CONTEXT* const c = context.get();
    proj_log_func(c, &reason, keep_last_message);
    open_regular_files_only(c);

    const Pj crs = created(c, text, who, reason);
    impl->name = proj_get_name(crs.get());

    const std::string subject = is_name(text) || text.size() <= 20 ? std::string(text) : impl->name;
    const auto unusable = [&](std::string_view why) {
        bad_input(
            fmt::format("{}: {}: {}; give a geographic or projected one of the Earth with "
                        "--crs EPSG:n",
                        who, subject, why));
    };

    const bool compound = proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS;
    const Pj horizontal(compound ? proj_crs_get_sub_crs(c, crs.get(), 0)
                                 : proj_clone(c, crs.get()));
    if (!horizontal) unusable("its horizontal part cannot be read");
    if (const char* kind = kind_without_place(proj_get_type(unbound(c, horizontal.get()).get())))
        unusable(fmt::format("{} coordinate reference system, which cannot place a raster", kind));

    impl->code = code_of(crs.get());
    if (compound) {
        if (!impl->settle_vertical(c, crs.get(), code_of(horizontal.get())))
            unusable("its vertical part cannot be read");
    } else if (const std::optional<Axis> axis = axis_of(c, horizontal.get(), 2)) {
        impl->vertical =
            VerticalCrs{"ellipsoidal height", "", axis->unit_name, axis->unit_si, axis->down};
    }

    const Pj base = unbound(c, horizontal.get());
    if (const std::string body = other_body(c, base.get()); !body.empty())
        bad_input(fmt::format("{}: {}: a coordinate system of {}; Relevo draws only the Earth", who,
                              subject, body));
    const std::optional<Axis> axis = axis_of(c, base.get(), 0);
    if (!axis) unusable("its axes cannot be read");
    impl->axis = *axis;
    if (impl->name == "unnamed" || impl->name == "unknown")
        impl->name = readable_name(c, base.get());
    impl->geographic = is_ellipsoidal(c, base.get());
    constexpr std::array<const char*, 2> kOneLine = {"MULTILINE=NO", nullptr};
    const char* wkt = proj_as_wkt(c, crs.get(), PJ_WKT2_2019, kOneLine.data());
    impl->wkt = wkt ? wkt : "";

    const Pj wgs84(proj_create(c, kWgs84Code.c_str()));
    if (!wgs84) failed(fmt::format("{}: {}: PROJ has no database, {}", who, subject, reason));
    impl->is_wgs84 = proj_is_equivalent_to(horizontal.get(), wgs84.get(),
                                           PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS) != 0;
    if (impl->is_wgs84) return impl;

    reason.clear();
    if (!impl->settle_way(context, horizontal.get(), wgs84.get()))
        unusable(fmt::format("no way from it to WGS 84{}{}", reason.empty() ? "" : ", ", reason));
    return impl;
}

const std::string& Crs::name() const {
    return impl_ ? impl_->name : kWgs84Name;
}
const std::string& Crs::code() const {
    return impl_ ? impl_->code : kWgs84Code;
}
const std::string& Crs::wkt() const {
    return impl_ ? impl_->wkt : kWgs84Wkt;
}
bool Crs::is_geographic() const {
    return !impl_ || impl_->geographic;
}
const std::string& Crs::unit_name() const {
    return impl_ ? impl_->axis.unit_name : kDegree;
}
double Crs::unit_si() const {
    return impl_ ? impl_->axis.unit_si : kDegree_rad;
}
const std::optional<VerticalCrs>& Crs::vertical() const {
    return impl_ ? impl_->vertical : kNoVertical;
}

Geodetic Crs::to_geodetic(double x, double y) const {
    Geodetic place;
    const glm::dvec2 point(x, y);
    to_geodetic({&point, 1}, {&place, 1});
    return place;
}

void Crs::to_geodetic(std::span<const glm::dvec2> points, std::span<Geodetic> places) const {
    assert(points.size() == places.size());
    if (!impl_ || impl_->is_wgs84) {
        std::transform(points.begin(), points.end(), places.begin(),
                       [](const glm::dvec2& p) { return checked_deg(p.x, p.y); });
        return;
    }
    impl_->borrow([&](PJ_CONTEXT*, PJ* pj) {
        std::transform(points.begin(), points.end(), places.begin(),
                       [&](const glm::dvec2& p) { return impl_->place(pj, p.x, p.y); });
    });
}

glm::dvec2 Crs::from_geodetic(const Geodetic& place) const {
    const glm::dvec2 lonlat_deg(degrees(place.lon_rad), degrees(place.lat_rad));
    if (!impl_ || impl_->is_wgs84) return lonlat_deg;
    glm::dvec2 point(kNaN);
    impl_->borrow([&](PJ_CONTEXT*, PJ* pj) {
        const auto inverse = [&](double lon_deg, double lat_deg) {
            const PJ_COORD out = proj_trans(pj, PJ_INV, proj_coord(lon_deg, lat_deg, 0, HUGE_VAL));
            return std::isfinite(out.xy.x) && std::isfinite(out.xy.y)
                       ? glm::dvec2(out.xy.x, out.xy.y)
                       : glm::dvec2(kNaN);
        };
        // PROJ's inverse is near but not always the one of its forward direction: a Helmert shift
        // without heights closes to 1 mm only, and the datum shift is chosen anew, by another area
        // of use. What is left over is taken off until to_geodetic() gives the place.
        const glm::dvec2 first = inverse(lonlat_deg.x, lonlat_deg.y);
        point = first;
        const double close_enough = impl_->geographic ? 1e-10 / degrees(impl_->axis.unit_si)
                                                      : 1e-5 / impl_->axis.unit_si;  // 10 um
        for (int i = 0; i < 5; ++i) {
            const Geodetic found = impl_->place(pj, point.x, point.y);
            const glm::dvec2 step = first - inverse(degrees(found.lon_rad), degrees(found.lat_rad));
            // Where the way back is not defined, PROJ's own answer stands.
            if (!std::isfinite(step.x) || glm::length(step) < close_enough) break;
            point += step;
        }
    });
    return point;
}

std::optional<DatumShift> Crs::datum_shift(double x, double y) const {
    if (!impl_ || impl_->is_wgs84) return std::nullopt;
    std::optional<DatumShift> result;
    impl_->borrow([&](PJ_CONTEXT* context, PJ* pj) {
        impl_->place(pj, x, y);
        const Pj operation(proj_trans_get_last_used_operation(pj));
        if (!operation) return;
        // "Inverse of UTM zone 10N + NAD27 to WGS 84 (6) + axis order change (2D)": what projects
        // or swaps axes is exact and has no place in an account of the datum.
        std::vector<std::string> shifts;
        const std::string name = proj_get_name(operation.get());
        for (std::size_t from = 0; from < name.size();) {
            const std::size_t plus = std::min(name.find(" + ", from), name.size());
            const std::string step = name.substr(from, plus - from);
            std::string words = lower(step);
            std::ranges::replace(words, '_', ' ');  // Esri's "ETRS_1989_To_WGS_1984"
            if (words.find(" to ") != std::string::npos) shifts.push_back(step);
            from = plus + 3;
        }
        if (shifts.empty()) return;
        DatumShift shift{shifts.front(), std::nullopt};
        for (std::size_t i = 1; i < shifts.size(); ++i)
            shift.name += " + " + shifts[i];
        const double accuracy_m = proj_coordoperation_get_accuracy(context, operation.get());
        if (accuracy_m >= 0) shift.accuracy_m = accuracy_m;
        result = shift;
    });
    return result;
}

}  // namespace relevo::geo
