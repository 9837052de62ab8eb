#include "effect/module_services.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include "effect/texture_format.h"

namespace relevo::effect {
namespace {

template <typename Struct>
struct Least {
    std::uint32_t size;
};
/// Size of each struct in version 2.0 of the interface [bytes]; of relevo_mark in 2.1, which
/// brought it. Frozen: modules are built with it.
constexpr std::tuple kLeast{Least<relevo_frame>{488}, Least<relevo_texture_info>{40},
                            Least<relevo_texels>{48}, Least<relevo_draw>{48},
                            Least<relevo_box>{128},   Least<relevo_heights>{16},
                            Least<relevo_nodes>{24},  Least<relevo_mark>{64}};
template <typename Struct>
constexpr std::uint32_t kLeastSize = std::get<Least<Struct>>(kLeast).size;

using Services = ModuleServices;

/// What a service needs.
constexpr int kNothing = 0, kDevice = 1, kFrame = 2, kBoth = kDevice | kFrame;

template <typename T>
T* not_null(T* argument, const char* name) {
    if (!argument) refuse(name, " is null");
    return argument;
}

template <typename Struct>
void check_size(const Struct* argument, const char* name) {
    static_assert(sizeof(Struct) >= kLeastSize<Struct>);
    not_null(argument, name);
    if (argument->size < kLeastSize<Struct>)
        refuse(name, "->size is ", argument->size, ", expected its sizeof, at least ",
               kLeastSize<Struct>);
}

/// Members that the module's version of a struct lacks are zero.
template <typename Struct>
Struct copy_in(const Struct* from, const char* name) {
    check_size(from, name);
    Struct full{};
    std::memcpy(&full, from, std::min<std::size_t>(from->size, sizeof full));
    return full;
}

/// Writes the members that the module's version of a struct has.
template <typename Struct>
void copy_out(Struct full, Struct* to) {
    full.size = std::min<std::uint32_t>(to->size, sizeof full);
    std::memcpy(to, &full, full.size);
}

template <std::size_t N>
std::array<double, N> values_in(const double* from, const char* name) {
    std::array<double, N> values;
    std::copy_n(not_null(from, name), N, values.begin());
    return values;
}

template <std::size_t N>
void values_out(const std::array<double, N>& from, double* to, const char* name) {
    std::copy(from.begin(), from.end(), not_null(to, name));
}

/// The same, if the values are finite.
relevo_status post_out(const ModuleServices::Pair& from, double* to, const char* name) {
    if (!std::isfinite(from[0]) || !std::isfinite(from[1])) return RELEVO_NOTHING;
    values_out(from, to, name);
    return RELEVO_OK;
}

}  // namespace

ModuleServices::ModuleServices() {
    host_.size = sizeof(relevo_host);
    host_.owner = this;
    host_.abi_version = RELEVO_ABI_VERSION;
    host_.service = &ModuleServices::service;
    host_.fail = [](const relevo_host* host, const char* text) {
        if (host) static_cast<const Host*>(host)->owner->reason_ = text ? text : "no reason given";
    };
    const auto begin = [this](auto&... tables) {
        ((tables.size = sizeof tables, tables.self = this), ...);
    };
    begin(log_, params_, frame_, texture_, draw_, terrain_, heights_, geo_, marks_);
    fill_data_tables();
    fill_texture_table();
    fill_draw_table();
    fill_ground_tables();
}

const void* ModuleServices::service(const relevo_host* host, const char* name,
                                    std::uint32_t version) {
    if (!host || !name || version != 1) return nullptr;
    const ModuleServices& self = *static_cast<const Host*>(host)->owner;
    const std::pair<const char*, const void*> tables[] = {
        {"relevo.log", &self.log_},         {"relevo.params", &self.params_},
        {"relevo.frame", &self.frame_},     {"relevo.texture", &self.texture_},
        {"relevo.draw", &self.draw_},       {"relevo.terrain", &self.terrain_},
        {"relevo.heights", &self.heights_}, {"relevo.geo", &self.geo_},
        {"relevo.marks", &self.marks_}};
    for (const auto& [known, table] : tables)
        if (std::strcmp(known, name) == 0 && (self.offers_all_ || table == &self.log_))
            return table;
    return nullptr;
}

// ---- textures and programs

const ModuleTexture& ModuleServices::known(relevo_texture texture) const {
    const auto found = textures_.find(texture);
    if (found == textures_.end()) refuse("there is no texture ", texture);
    return found->second;
}

void ModuleServices::check_program(relevo_program program) const {
    if (programs_.count(program) == 0) refuse("there is no program ", program);
}

relevo_texture ModuleServices::add_texture(const relevo_texture_info& info) {
    const std::optional<PixelFormat> format = texture_format(info.format);
    if (!format) refuse(info.format, " is no format of a texture");
    const int max_side = max_texture_side(), max_layers = max_texture_layers();
    if (info.width < 1 || info.height < 1 || info.width > max_side || info.height > max_side ||
        info.layers < 0 || info.layers > max_layers)
        refuse("expected a texture of up to ", max_side, " x ", max_side, " and ", max_layers,
               " layers but got ", info.width, " x ", info.height, ", ", info.layers, " layers");
    const int longest = std::max(info.width, info.height);
    const int all_levels = std::bit_width(static_cast<unsigned>(longest));
    if (info.levels < 0 || info.levels > all_levels)
        refuse("expected 0 to ", all_levels, " levels of ", info.width, " x ", info.height,
               " texels but got ", info.levels);
    if (info.filter < RELEVO_FILTER_NEAREST || info.filter > RELEVO_FILTER_MIPMAP)
        refuse(info.filter, " is no filter of a texture");
    const ModuleTexture texture{*format,
                                info.width,
                                info.height,
                                info.levels == 0 ? all_levels : info.levels,
                                info.layers,
                                info.filter,
                                info.name ? info.name : ""};
    create_texture(last_texture_ + 1, texture);
    textures_.emplace(++last_texture_, texture);
    return last_texture_;
}

void ModuleServices::check(const relevo_texels& texels) const {
    not_null(texels.texels, "texels->texels");
    const ModuleTexture& to = known(texels.texture);
    if (texels.level < 0 || texels.level >= to.levels || texels.layer < 0 ||
        texels.layer >= std::max(to.layers, 1))
        refuse("expected a level below ", to.levels, " and a layer below ", std::max(to.layers, 1),
               " but got ", texels.level, " and ", texels.layer);
    const int width = std::max(1, to.width >> texels.level);
    const int height = std::max(1, to.height >> texels.level);
    if (texels.x < 0 || texels.y < 0 || texels.width < 1 || texels.height < 1 ||
        texels.x > width - texels.width || texels.y > height - texels.height)
        refuse("expected a rectangle within ", width, " x ", height, " texels but got ",
               texels.width, " x ", texels.height, " at ", texels.x, ", ", texels.y);
    if (to.format == PixelFormat::Depth32F) refuse("a texture of depth is drawn, not written");
    const std::uint64_t bytes = std::uint64_t{1} * static_cast<unsigned>(texels.width) *
                                static_cast<unsigned>(texels.height) *
                                static_cast<unsigned>(layout_of(to.format).bytes());
    if (texels.bytes != bytes)
        refuse("expected ", bytes, " bytes for ", texels.width, " x ", texels.height,
               " texels but got ", texels.bytes);
}

void ModuleServices::check(const relevo_draw& draw) const {
    if (draw.input_count < 0 || draw.input_count > RELEVO_MAX_INPUTS || draw.value_count < 0 ||
        draw.value_count > RELEVO_MAX_VALUES)
        refuse("expected up to ", RELEVO_MAX_INPUTS, " inputs and ", RELEVO_MAX_VALUES,
               " values but got ", draw.input_count, " and ", draw.value_count);
    if (draw.input_count > 0) not_null(draw.inputs, "draw->inputs");
    if (draw.value_count > 0) not_null(draw.values, "draw->values");
    check_program(draw.program);
    const ModuleTexture& target = known(draw.target);
    if (draw.layer < 0 || draw.layer >= std::max(target.layers, 1) || draw.level < 0 ||
        draw.level >= target.levels || target.format == PixelFormat::Depth32F)
        refuse("expected a layer and a level of a colour texture");
    for (int i = 0; i < draw.input_count; ++i) {
        known(draw.inputs[i]);
        if (draw.inputs[i] == draw.target)
            refuse("expected a target that the same draw does not read");
    }
}

void ModuleServices::check_depth(const relevo_box& box, double tolerance_m,
                                 relevo_texture target) const {
    const ModuleTexture& texture = known(target);
    if (texture.format != PixelFormat::Depth32F || texture.layers > 0)
        refuse("expected a target of RELEVO_FORMAT_DEPTH32F without layers");
    for (int i = 0; i < 3; ++i)
        if (!(box.low[i] < box.high[i])) refuse("expected a box whose sides are longer than 0 m");
    if (!(tolerance_m >= 0)) refuse("expected a tolerance of 0 m or more but got ", tolerance_m);
}

// ---- the tables

/// The name of a function as a template argument.
template <std::size_t N>
struct FunctionName {
    char text[N];
    constexpr FunctionName(const char (&from)[N]) { std::copy_n(from, N, text); }
};

/// The C function of a service, from its body: a function of the services and the same arguments,
/// which may return a status.
/// @param name  "relevo.texture: create"; begins the message of a failure
template <int needs, FunctionName name, typename Body>
struct Served {
    template <typename Result, typename... Args>
    using Function = Result (*)(void*, Args...);

    template <typename Result, typename... Args>
    operator Function<Result, Args...>() const {
        return [](void* self, Args... args) -> Result {
            const auto call = [&](ModuleServices& host) { return Body{}(host, args...); };
            return static_cast<Result>(ModuleServices::serve<needs>(self, name.text, call));
        };
    }
};
template <int needs, FunctionName name, typename Body>
Served<needs, name, Body> served(Body) {
    return {};
}

/// Runs the body of a service.
template <int needs, typename Body>
relevo_status ModuleServices::serve(void* self, const char* function, const Body& body) noexcept {
    if (!self) return RELEVO_FAILED;
    ModuleServices& services = *static_cast<ModuleServices*>(self);
    try {
        std::shared_ptr<void> at_work;
        if constexpr ((needs & kDevice) != 0) at_work = services.device_at_work();
        if ((needs & kFrame) != 0 && !services.in_frame())
            refuse("no frame is drawn now; ask inside prepare()");
        if constexpr (std::is_void_v<std::invoke_result_t<Body, ModuleServices&>>)
            body(services);
        else
            return body(services);
        return RELEVO_OK;
    } catch (const std::invalid_argument& error) {
        services.reason_ = std::string(function) + ": " + error.what();
    } catch (const std::bad_alloc&) {
        services.reason_ = "there is not enough memory";
    } catch (const std::exception& error) {
        services.reason_ = error.what();
    } catch (...) {
        services.reason_ = std::string(function) + " failed";
    }
    return RELEVO_FAILED;
}

void ModuleServices::fill_data_tables() {
    log_.write = served<kNothing, "relevo.log: write">(
        [](Services& host, auto level, auto text) { host.log(level, not_null(text, "text")); });
    params_.get =
        served<kNothing, "relevo.params: get">([](Services& host, auto address, auto value) {
            values_out(host.parameter(not_null(address, "address")), value, "value");
        });
    params_.set =
        served<kNothing, "relevo.params: set">([](Services& host, auto address, auto value) {
            host.set_parameter(not_null(address, "address"), values_in<4>(value, "value"));
        });
    params_.get_text = served<kNothing, "relevo.params: get_text">(
        [](Services& host, auto address, auto text, auto capacity, auto length) {
            if (!text && !length) refuse("text and length are null");
            const std::string known = host.text(not_null(address, "address"));
            if (length) *length = known.size();
            if (text && capacity > 0) {
                const std::size_t fits = std::min<std::size_t>(known.size(), capacity - 1);
                std::memcpy(text, known.data(), fits);
                text[fits] = '\0';
            }
        });
    geo_.to_local = served<kFrame, "relevo.geo: to_local">([](Services& host, auto from, auto to) {
        values_out(host.to_local(values_in<3>(from, "lat_lon_height")), to, "local_m");
    });
    geo_.from_local =
        served<kFrame, "relevo.geo: from_local">([](Services& host, auto from, auto to) {
            values_out(host.from_local(values_in<3>(from, "local_m")), to, "lat_lon_height");
        });
    geo_.to_post = served<kFrame, "relevo.geo: to_post">([](Services& host, auto from, auto to) {
        return post_out(host.to_post(values_in<2>(from, "lat_lon")), to, "column_row");
    });
    geo_.from_post =
        served<kFrame, "relevo.geo: from_post">([](Services& host, auto from, auto to) {
            return post_out(host.from_post(values_in<2>(from, "column_row")), to, "lat_lon");
        });
    marks_.set = served<kNothing, "relevo.marks: set">([](Services& host, auto list, auto marks,
                                                          auto count) {
        host.set_marks(not_null(list, "list"), read_marks(marks, count, kLeastSize<relevo_mark>));
    });
}

void ModuleServices::fill_texture_table() {
    texture_.create =
        served<kDevice, "relevo.texture: create">([](Services& host, auto info, auto texture) {
            not_null(texture, "texture");
            *texture = host.add_texture(copy_in(info, "info"));
        });
    texture_.destroy = served<kDevice, "relevo.texture: destroy">([](Services& host, auto texture) {
        host.known(texture);
        host.textures_.erase(texture);
        host.destroy_texture(texture);
    });
    texture_.write = served<kDevice, "relevo.texture: write">([](Services& host, auto given) {
        const relevo_texels texels = copy_in(given, "texels");
        host.check(texels);
        host.write_texture(texels);
    });
    texture_.make_mipmaps =
        served<kDevice, "relevo.texture: make_mipmaps">([](Services& host, auto texture) {
            host.known(texture);
            host.make_mipmaps(texture);
        });
    texture_.read = served<kDevice, "relevo.texture: read">(
        [](Services& host, auto texture, auto layer, auto values, auto count) {
            not_null(values, "values");
            const ModuleTexture& from = host.known(texture);
            const int floats = readable_floats(from.format), layers = std::max(from.layers, 1);
            if (floats == 0) refuse("only textures of 32-bit floats can be read");
            const std::uint64_t wanted = std::uint64_t{1} * static_cast<unsigned>(floats) *
                                         static_cast<unsigned>(from.width) *
                                         static_cast<unsigned>(from.height);
            if (layer < 0 || layer >= layers || count < wanted)
                refuse("expected room for ", wanted, " floats and a layer below ", layers,
                       " but got ", count, " and ", layer);
            host.read_texture(texture, layer, {values, static_cast<std::size_t>(wanted)});
        });
}

void ModuleServices::fill_draw_table() {
    draw_.program =
        served<kDevice, "relevo.draw: program">([](Services& host, auto file, auto program) {
            not_null(program, "program");
            host.create_program(host.last_program_ + 1, not_null(file, "file"));
            host.programs_.insert(++host.last_program_);
            *program = host.last_program_;
        });
    draw_.destroy_program =
        served<kDevice, "relevo.draw: destroy_program">([](Services& host, auto program) {
            host.check_program(program);
            host.programs_.erase(program);
            host.destroy_program(program);
        });
    draw_.draw = served<kDevice, "relevo.draw: draw">([](Services& host, auto given) {
        const relevo_draw draw = copy_in(given, "draw");
        host.check(draw);
        host.draw(draw);
    });
}

void ModuleServices::fill_ground_tables() {
    frame_.get = served<kFrame, "relevo.frame: get">([](Services& host, auto frame) {
        check_size(frame, "frame");
        copy_out(host.frame(), frame);
    });
    terrain_.bounds = served<kBoth, "relevo.terrain: bounds">([](Services& host, auto box) {
        relevo_box full = copy_in(box, "box");
        host.fill_bounds(full);
        copy_out(full, box);
    });
    terrain_.visible_bounds = served<kBoth, "relevo.terrain: visible_bounds">(
        [](Services& host, auto nearer_than_m, auto box) {
            relevo_box full = copy_in(box, "box");
            if (!host.fill_visible_bounds(nearer_than_m, full)) return RELEVO_NOTHING;
            copy_out(full, box);
            return RELEVO_OK;
        });
    terrain_.draw_depth = served<kBoth, "relevo.terrain: draw_depth">(
        [](Services& host, auto given, auto tolerance_m, auto target, auto level) {
            const relevo_box box = copy_in(given, "box");
            host.check_depth(box, tolerance_m, target);
            const int drawn = host.draw_depth(box, tolerance_m, target);
            if (level) *level = drawn;
        });
    heights_.describe =
        served<kFrame, "relevo.heights: describe">([](Services& host, auto heights) {
            check_size(heights, "heights");
            copy_out(host.heights(), heights);
        });
    heights_.read = served<kBoth, "relevo.heights: read">(
        [](Services& host, auto given, auto heights_m, auto count) {
            const relevo_nodes nodes = copy_in(given, "nodes");
            not_null(heights_m, "heights_m");
            const std::int64_t wanted = std::int64_t{nodes.columns} * nodes.rows;
            if (nodes.columns < 1 || nodes.rows < 1 || count < static_cast<std::uint64_t>(wanted))
                refuse("expected room for ", nodes.columns, " x ", nodes.rows, " heights but got ",
                       count);
            const int levels = host.heights().levels;
            if (nodes.level < 0 || nodes.level >= levels)
                refuse("expected a level of 0 to ", levels - 1, " but got ", nodes.level);
            host.read_heights(nodes, {heights_m, static_cast<std::size_t>(wanted)});
        });
}

}  // namespace relevo::effect
