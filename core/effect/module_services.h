#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <relevo/plugin.h>

namespace relevo::effect {

/// What a host does for a native module: the services of relevo/plugin.h with arguments that are
/// there and whole structs. ServiceTables puts them behind the C interface. A function that cannot
/// do what it is asked to throws a std::exception, whose text the user reads.
class ModuleServices {
  public:
    ModuleServices() = default;
    ModuleServices(const ModuleServices&) = delete;
    ModuleServices& operator=(const ModuleServices&) = delete;
    virtual ~ModuleServices() = default;

    /// Lives while a service draws or waits for the device, whose time is not the module's.
    virtual std::shared_ptr<void> device_at_work() { return nullptr; }

    virtual void log(int level, const char* text) = 0;

    using Value = std::array<double, 4>;
    virtual Value parameter(const char* address) = 0;
    virtual void set_parameter(const char* address, const Value& value) = 0;
    virtual std::string text(const char* address) = 0;

    virtual relevo_frame frame() = 0;

    virtual relevo_texture create_texture(const relevo_texture_info& info) = 0;
    virtual void destroy_texture(relevo_texture texture) = 0;
    virtual void write_texture(const relevo_texels& texels) = 0;
    virtual void make_mipmaps(relevo_texture texture) = 0;
    virtual void read_texture(relevo_texture texture, int layer, std::span<float> values) = 0;

    virtual relevo_program create_program(const char* file) = 0;
    virtual void destroy_program(relevo_program program) = 0;
    virtual void draw(const relevo_draw& draw) = 0;

    virtual void fill_bounds(relevo_box& box) = 0;
    /// @returns whether there is ground that near
    virtual bool fill_visible_bounds(double nearer_than_m, relevo_box& box) = 0;
    /// @returns the finest level of detail that was drawn
    virtual int draw_depth(const relevo_box& box, double tolerance_m, relevo_texture target) = 0;

    virtual relevo_heights heights() = 0;
    virtual void read_heights(const relevo_nodes& nodes, std::span<float> heights_m) = 0;

    using Point = std::array<double, 3>;
    virtual Point to_local(const Point& lat_lon_height) = 0;
    virtual Point from_local(const Point& local_m) = 0;
    /// Not finite where there is none.
    virtual std::array<double, 2> to_post(const std::array<double, 2>& lat_lon) = 0;
    virtual std::array<double, 2> from_post(const std::array<double, 2>& column_row) = 0;
};

}  // namespace relevo::effect
