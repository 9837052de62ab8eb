#include "effect/service_tables.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace relevo::effect {
namespace {

/// What version 2.0 of the interface has of a struct [bytes]: frozen, as modules are built with it.
template <typename Struct>
constexpr std::uint32_t kLeastSize = 0;
template <>
constexpr std::uint32_t kLeastSize<relevo_frame> = 488;
template <>
constexpr std::uint32_t kLeastSize<relevo_texture_info> = 40;
template <>
constexpr std::uint32_t kLeastSize<relevo_texels> = 48;
template <>
constexpr std::uint32_t kLeastSize<relevo_draw> = 48;
template <>
constexpr std::uint32_t kLeastSize<relevo_box> = 128;
template <>
constexpr std::uint32_t kLeastSize<relevo_heights> = 16;
template <>
constexpr std::uint32_t kLeastSize<relevo_nodes> = 24;

[[noreturn]] void refuse(const std::string& what) {
    throw std::invalid_argument(what);
}

/// @param name  of the argument
template <typename T>
T* there(T* argument, const char* name) {
    if (!argument) refuse(std::string(name) + " is null");
    return argument;
}

template <typename Struct>
void check_size(const Struct* argument, const char* name) {
    static_assert(sizeof(Struct) >= kLeastSize<Struct>);
    there(argument, name);
    if (argument->size < kLeastSize<Struct>)
        refuse(std::string(name) + "->size is " + std::to_string(argument->size) +
               ", expected its sizeof, at least " + std::to_string(kLeastSize<Struct>));
}

/// What the module knows of a struct, the rest at zero.
template <typename Struct>
Struct copy_in(const Struct* from, const char* name) {
    check_size(from, name);
    Struct full{};
    std::memcpy(&full, from, std::min<std::size_t>(from->size, sizeof full));
    return full;
}

/// Writes as much of `full` as the module knows of.
template <typename Struct>
void copy_out(Struct full, Struct* to) {
    full.size = std::min<std::uint32_t>(to->size, sizeof full);
    std::memcpy(to, &full, full.size);
}

template <std::size_t N>
std::array<double, N> values_in(const double* from, const char* name) {
    std::array<double, N> values;
    std::copy_n(there(from, name), N, values.begin());
    return values;
}

template <std::size_t N>
bool finite(const std::array<double, N>& values) {
    return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

std::span<float> room(float* values, std::uint64_t count, const char* name) {
    return {there(values, name), static_cast<std::size_t>(count)};
}

}  // namespace

ServiceTables::ServiceTables(ModuleServices& services) : services_(services) {
    host_.size = sizeof(relevo_host);
    host_.owner = this;
    host_.abi_version = RELEVO_ABI_VERSION;
    host_.service = &ServiceTables::service;
    host_.fail = [](const relevo_host* host, const char* text) {
        if (host)
            static_cast<const OwnHost*>(host)->owner->reason_ = text ? text : "no reason given";
    };
    fill_tables();
    fill_texture_table();
}

const void* ServiceTables::service(const relevo_host* host, const char* name,
                                   std::uint32_t version) {
    if (!host || !name || version != 1) return nullptr;
    const ServiceTables& self = *static_cast<const OwnHost*>(host)->owner;
    const std::pair<const char*, const void*> tables[] = {
        {"relevo.log", &self.log_},         {"relevo.params", &self.params_},
        {"relevo.frame", &self.frame_},     {"relevo.texture", &self.texture_},
        {"relevo.draw", &self.draw_},       {"relevo.terrain", &self.terrain_},
        {"relevo.heights", &self.heights_}, {"relevo.geo", &self.geo_}};
    for (const auto& [known, table] : tables)
        if (std::strcmp(known, name) == 0 && (self.offers_all_ || table == &self.log_))
            return table;
    return nullptr;
}

/// Runs a service's body, which returns a status where it may be other than RELEVO_OK.
/// @param function  "relevo.texture: create"; before the reason of a failure
template <typename Body>
relevo_status ServiceTables::serve(void* self, const char* function, const Body& body) noexcept {
    if (!self) return RELEVO_FAILED;
    ServiceTables& tables = of(self);
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<Body, ModuleServices&>>)
            body(tables.services_);
        else
            return body(tables.services_);
        return RELEVO_OK;
    } catch (const std::invalid_argument& error) {
        tables.reason_ = std::string(function) + ": " + error.what();
    } catch (const std::bad_alloc&) {
        tables.reason_ = "there is not enough memory";
    } catch (const std::exception& error) {
        tables.reason_ = error.what();
    } catch (...) {
        tables.reason_ = std::string(function) + " failed";
    }
    return RELEVO_FAILED;
}

/// The same for a body that draws or waits for the device.
template <typename Body>
relevo_status ServiceTables::serve_device(void* self, const char* function,
                                          const Body& body) noexcept {
    if (!self) return RELEVO_FAILED;
    const std::shared_ptr<void> at_work = of(self).services_.device_at_work();
    return serve(self, function, body);
}

// In one piece: a table of short functions, one for each of the interface.
void ServiceTables::fill_tables() {
    using Services = ModuleServices;
    log_ = {sizeof log_, 0, this, [](void* self, std::int32_t level, const char* text) {
                serve(self, "relevo.log: write",
                      [&](Services& services) { services.log(level, there(text, "text")); });
            }};
    params_ = {
        sizeof params_,
        0,
        this,
        [](void* self, const char* address, double value[4]) {
            return serve(self, "relevo.params: get", [&](Services& services) {
                there(value, "value");
                const auto known = services.parameter(there(address, "address"));
                std::copy(known.begin(), known.end(), value);
            });
        },
        [](void* self, const char* address, const double value[4]) {
            return serve(self, "relevo.params: set", [&](Services& services) {
                services.set_parameter(there(address, "address"), values_in<4>(value, "value"));
            });
        },
        [](void* self, const char* address, char* text, std::uint64_t capacity,
           std::uint64_t* length) {
            return serve(self, "relevo.params: get_text", [&](Services& services) {
                if (!text && !length) refuse("text and length are null");
                const std::string known = services.text(there(address, "address"));
                if (length) *length = known.size();
                if (text && capacity > 0) {
                    const std::size_t fits = std::min<std::size_t>(known.size(), capacity - 1);
                    std::memcpy(text, known.data(), fits);
                    text[fits] = '\0';
                }
            });
        }};
    frame_ = {sizeof frame_, 0, this, [](void* self, relevo_frame* frame) {
                  return serve(self, "relevo.frame: get", [&](Services& services) {
                      check_size(frame, "frame");
                      copy_out(services.frame(), frame);
                  });
              }};
    draw_ = {
        sizeof draw_,
        0,
        this,
        [](void* self, const char* file, relevo_program* program) {
            return serve_device(self, "relevo.draw: program", [&](Services& services) {
                there(program, "program");
                *program = services.create_program(there(file, "file"));
            });
        },
        [](void* self, relevo_program program) {
            return serve_device(self, "relevo.draw: destroy_program",
                                [&](Services& services) { services.destroy_program(program); });
        },
        [](void* self, const relevo_draw* given) {
            return serve_device(self, "relevo.draw: draw", [&](Services& services) {
                const relevo_draw draw = copy_in(given, "draw");
                if (draw.input_count < 0 || draw.input_count > RELEVO_MAX_INPUTS ||
                    draw.value_count < 0 || draw.value_count > RELEVO_MAX_VALUES)
                    refuse("expected up to " + std::to_string(RELEVO_MAX_INPUTS) + " inputs and " +
                           std::to_string(RELEVO_MAX_VALUES) + " values but got " +
                           std::to_string(draw.input_count) + " and " +
                           std::to_string(draw.value_count));
                if (draw.input_count > 0) there(draw.inputs, "draw->inputs");
                if (draw.value_count > 0) there(draw.values, "draw->values");
                const std::span inputs(draw.inputs, static_cast<std::size_t>(draw.input_count));
                if (std::ranges::find(inputs, draw.target) != inputs.end())
                    refuse("expected a target that the same draw does not read");
                services.draw(draw);
            });
        }};
    terrain_ = {
        sizeof terrain_,
        0,
        this,
        [](void* self, relevo_box* box) {
            return serve_device(self, "relevo.terrain: bounds", [&](Services& services) {
                relevo_box full = copy_in(box, "box");
                services.fill_bounds(full);
                copy_out(full, box);
            });
        },
        [](void* self, double nearer_than_m, relevo_box* box) {
            return serve_device(self, "relevo.terrain: visible_bounds", [&](Services& services) {
                relevo_box full = copy_in(box, "box");
                if (!services.fill_visible_bounds(nearer_than_m, full)) return RELEVO_NOTHING;
                copy_out(full, box);
                return RELEVO_OK;
            });
        },
        [](void* self, const relevo_box* box, double tolerance_m, relevo_texture target,
           std::int32_t* level) {
            return serve_device(self, "relevo.terrain: draw_depth", [&](Services& services) {
                const int drawn = services.draw_depth(copy_in(box, "box"), tolerance_m, target);
                if (level) *level = drawn;
            });
        }};
    heights_ = {sizeof heights_, 0, this,
                [](void* self, relevo_heights* heights) {
                    return serve(self, "relevo.heights: describe", [&](Services& services) {
                        check_size(heights, "heights");
                        copy_out(services.heights(), heights);
                    });
                },
                [](void* self, const relevo_nodes* given, float* heights_m, std::uint64_t count) {
                    return serve_device(self, "relevo.heights: read", [&](Services& services) {
                        const relevo_nodes nodes = copy_in(given, "nodes");
                        there(heights_m, "heights_m");
                        const std::int64_t wanted = std::int64_t{nodes.columns} * nodes.rows;
                        if (nodes.columns < 1 || nodes.rows < 1 ||
                            count < static_cast<std::uint64_t>(wanted))
                            refuse("expected room for " + std::to_string(nodes.columns) + " x " +
                                   std::to_string(nodes.rows) + " heights but got " +
                                   std::to_string(count));
                        services.read_heights(
                            nodes,
                            room(heights_m, static_cast<std::uint64_t>(wanted), "heights_m"));
                    });
                }};
    geo_ = {sizeof geo_,
            0,
            this,
            [](void* self, const double from[3], double to[3]) {
                return serve(self, "relevo.geo: to_local", [&](Services& services) {
                    const auto point = services.to_local(values_in<3>(from, "lat_lon_height"));
                    std::copy(point.begin(), point.end(), there(to, "local_m"));
                });
            },
            [](void* self, const double from[3], double to[3]) {
                return serve(self, "relevo.geo: from_local", [&](Services& services) {
                    const auto point = services.from_local(values_in<3>(from, "local_m"));
                    std::copy(point.begin(), point.end(), there(to, "lat_lon_height"));
                });
            },
            [](void* self, const double from[2], double to[2]) {
                return serve(self, "relevo.geo: to_post", [&](Services& services) {
                    const auto point = services.to_post(values_in<2>(from, "lat_lon"));
                    if (!finite(point)) return RELEVO_NOTHING;
                    std::copy(point.begin(), point.end(), there(to, "column_row"));
                    return RELEVO_OK;
                });
            },
            [](void* self, const double from[2], double to[2]) {
                return serve(self, "relevo.geo: from_post", [&](Services& services) {
                    const auto point = services.from_post(values_in<2>(from, "column_row"));
                    if (!finite(point)) return RELEVO_NOTHING;
                    std::copy(point.begin(), point.end(), there(to, "lat_lon"));
                    return RELEVO_OK;
                });
            }};
}

void ServiceTables::fill_texture_table() {
    using Services = ModuleServices;
    texture_ = {
        sizeof texture_,
        0,
        this,
        [](void* self, const relevo_texture_info* info, relevo_texture* texture) {
            return serve_device(self, "relevo.texture: create", [&](Services& services) {
                there(texture, "texture");
                *texture = services.create_texture(copy_in(info, "info"));
            });
        },
        [](void* self, relevo_texture texture) {
            return serve_device(self, "relevo.texture: destroy",
                                [&](Services& services) { services.destroy_texture(texture); });
        },
        [](void* self, const relevo_texels* given) {
            return serve_device(self, "relevo.texture: write", [&](Services& services) {
                const relevo_texels texels = copy_in(given, "texels");
                there(texels.texels, "texels->texels");
                services.write_texture(texels);
            });
        },
        [](void* self, relevo_texture texture) {
            return serve_device(self, "relevo.texture: make_mipmaps",
                                [&](Services& services) { services.make_mipmaps(texture); });
        },
        [](void* self, relevo_texture texture, std::int32_t layer, float* values,
           std::uint64_t count) {
            return serve_device(self, "relevo.texture: read", [&](Services& services) {
                services.read_texture(texture, layer, room(values, count, "values"));
            });
        }};
}

}  // namespace relevo::effect
