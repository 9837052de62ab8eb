#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "base/pixel_format.h"
#include "effect/module_services.h"

namespace relevo::effect {

/// The services of relevo/plugin.h with no device behind them: textures that hold nothing, programs
/// that are not compiled, a DEM that is a plain. What a module asks wrongly is refused as
/// render/native_host.h refuses it.
class StandInHost : public ModuleServices {
  public:
    explicit StandInHost(std::filesystem::path plugin_folder);

    void add_parameter(const std::string& address, bool is_host, const Value& value);
    void add_text(const std::string& address) { texts_[address]; }

    /// From now on services that need a frame answer, with the sun and the ground of the n-th.
    void begin_frame(int number) { frame_ = number; }
    void end_frame() { frame_ = -1; }

    void log(int, const char*) override {}
    Value parameter(const char* address) override;
    void set_parameter(const char* address, const Value& value) override;
    std::string text(const char* address) override;
    relevo_frame frame() override;
    relevo_texture create_texture(const relevo_texture_info& info) override;
    void destroy_texture(relevo_texture texture) override;
    void write_texture(const relevo_texels& texels) override;
    void make_mipmaps(relevo_texture texture) override;
    void read_texture(relevo_texture texture, int layer, std::span<float> values) override;
    relevo_program create_program(const char* file) override;
    void destroy_program(relevo_program program) override;
    void draw(const relevo_draw& draw) override;
    void fill_bounds(relevo_box& box) override;
    bool fill_visible_bounds(double nearer_than_m, relevo_box& box) override;
    int draw_depth(const relevo_box& box, double tolerance_m, relevo_texture target) override;
    relevo_heights heights() override;
    void read_heights(const relevo_nodes& nodes, std::span<float> heights_m) override;
    Point to_local(const Point& lat_lon_height) override;
    Point from_local(const Point& local_m) override;
    std::array<double, 2> to_post(const std::array<double, 2>& lat_lon) override;
    std::array<double, 2> from_post(const std::array<double, 2>& column_row) override;

  private:
    struct Parameter {
        bool is_host;
        Value value;
    };
    struct Texture {
        int width, height, layers, levels;
        PixelFormat format;
    };
    const Parameter& known(const char* address) const;
    const Texture& known(relevo_texture texture) const;
    void need_frame() const;
    void fill_box(relevo_box& box, double half_side_m) const;

    std::filesystem::path folder_;
    std::map<std::string, Parameter, std::less<>> parameters_;
    std::map<std::string, std::string, std::less<>> texts_;
    std::map<relevo_texture, Texture> textures_;
    std::map<relevo_program, std::string> programs_;
    relevo_texture last_texture_ = 0;
    relevo_program last_program_ = 0;
    int frame_ = -1;
};

}  // namespace relevo::effect
