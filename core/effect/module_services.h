#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>

#include <relevo/plugin.h>

#include "base/pixel_format.h"
#include "effect/module_marks.h"

namespace relevo::effect {

/// A texture that a module has created.
struct ModuleTexture {
    PixelFormat format{};
    int width = 0, height = 0, levels = 0;
    int layers = 0;  ///< 0: no array
    int filter = 0;  ///< RELEVO_FILTER_
    std::string name;
};

/// The services of relevo/plugin.h. This class has the C side: it checks the arguments, once for
/// all hosts, and no exception reaches the module. A host derives from it and does the work.
class ModuleServices {
  public:
    ModuleServices();
    ModuleServices(const ModuleServices&) = delete;
    ModuleServices& operator=(const ModuleServices&) = delete;
    virtual ~ModuleServices() = default;

    /// Offers only "relevo.log" before offer_all(): a registration gets no other service.
    const relevo_host* host() const { return &host_; }
    void offer_all() { offers_all_ = true; }

    /// The last reason that a service or the module gave.
    const std::string& reason() const { return reason_; }
    void clear_reason() { reason_.clear(); }

    /// Runs the body of a service's function. @param needs  a frame, a device
    template <int needs, typename Body>
    static relevo_status serve(void* self, const char* function, const Body& body) noexcept;

    using Value = std::array<double, 4>;
    using Point = std::array<double, 3>;
    using Pair = std::array<double, 2>;

  protected:
    // A function that cannot do its work throws a std::exception, whose text the user reads.

    /// Lives while a service draws or waits for the device: the module's time limit excludes it.
    virtual std::shared_ptr<void> device_at_work() { return nullptr; }

    virtual void log(int level, const char* text) = 0;
    virtual Value parameter(const char* address) = 0;
    virtual void set_parameter(const char* address, const Value& value) = 0;
    virtual std::string text(const char* address) = 0;
    /// @param list  as the module names it; throws if the plugin has no such list of its module
    virtual void set_marks(const char* list, ModuleMarks marks) = 0;

    virtual int max_texture_side() const = 0;
    virtual int max_texture_layers() const = 0;
    virtual void create_texture(relevo_texture texture, const ModuleTexture& info) = 0;
    virtual void destroy_texture(relevo_texture texture) = 0;
    virtual void write_texture(const relevo_texels& texels) = 0;
    virtual void make_mipmaps(relevo_texture texture) = 0;
    /// Level 0 of a layer.
    virtual void read_texture(relevo_texture texture, int layer, std::span<float> values) = 0;

    virtual void create_program(relevo_program program, const char* file) = 0;
    virtual void destroy_program(relevo_program program) = 0;
    virtual void draw(const relevo_draw& draw) = 0;

    /// Whether a frame is being prepared. The functions below are called only then.
    virtual bool in_frame() const = 0;
    virtual relevo_frame frame() = 0;
    virtual void fill_bounds(relevo_box& box) = 0;
    /// @returns whether there is ground within that distance
    virtual bool fill_visible_bounds(double nearer_than_m, relevo_box& box) = 0;
    /// @returns the finest level of detail that was drawn
    virtual int draw_depth(const relevo_box& box, double tolerance_m, relevo_texture target) = 0;
    virtual relevo_heights heights() = 0;
    virtual void read_heights(const relevo_nodes& nodes, std::span<float> heights_m) = 0;
    virtual Point to_local(const Point& lat_lon_height) = 0;
    virtual Point from_local(const Point& local_m) = 0;
    /// Not finite outside the range of the DEM's CRS.
    virtual Pair to_post(const Pair& lat_lon) = 0;
    virtual Pair from_post(const Pair& column_row) = 0;

  private:
    struct Host : relevo_host {
        ModuleServices* owner = nullptr;
    };
    static const void* service(const relevo_host* host, const char* name, std::uint32_t version);
    void fill_data_tables();
    void fill_texture_table();
    void fill_draw_table();
    void fill_ground_tables();

    const ModuleTexture& known(relevo_texture texture) const;
    void check_program(relevo_program program) const;
    relevo_texture add_texture(const relevo_texture_info& info);
    void check(const relevo_texels& texels) const;
    void check(const relevo_draw& draw) const;
    void check_depth(const relevo_box& box, double tolerance_m, relevo_texture target) const;

    Host host_{};
    relevo_log_1 log_{};
    relevo_params_1 params_{};
    relevo_frame_1 frame_{};
    relevo_texture_1 texture_{};
    relevo_draw_1 draw_{};
    relevo_terrain_1 terrain_{};
    relevo_heights_1 heights_{};
    relevo_geo_1 geo_{};
    relevo_marks_1 marks_{};
    std::map<relevo_texture, ModuleTexture> textures_;
    std::set<relevo_program> programs_;
    relevo_texture last_texture_ = 0;
    relevo_program last_program_ = 0;
    bool offers_all_ = false;
    std::string reason_;
};

}  // namespace relevo::effect
