#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "effect/module_services.h"

namespace relevo::effect {

/// The services without a device: textures hold zeros, programs are not compiled, the DEM is a
/// plain of 20 x 20 km.
class StandInHost : public ModuleServices {
  public:
    explicit StandInHost(std::filesystem::path plugin_folder) : folder_(std::move(plugin_folder)) {}

    void add_parameter(const std::string& address, bool is_host, const Value& value);
    void add_text(const std::string& address) { texts_[address]; }
    /// A list of marks that the module sets.
    void add_marks(const std::string& list) { marks_.insert(list); }

    /// The sun is high, low and below the horizon in frames 0, 1 and 2.
    void begin_frame(int number) { frame_ = number; }
    void end_frame() { frame_ = -1; }

  private:
    void log(int, const char*) override {}
    Value parameter(const char* address) override;
    void set_parameter(const char* address, const Value& value) override;
    std::string text(const char* address) override;
    void set_marks(const char* list, ModuleMarks marks) override;

    int max_texture_side() const override { return 16384; }
    int max_texture_layers() const override { return 2048; }
    void create_texture(relevo_texture, const ModuleTexture&) override {}
    void destroy_texture(relevo_texture) override {}
    void write_texture(const relevo_texels& texels) override;
    void make_mipmaps(relevo_texture) override {}
    void read_texture(relevo_texture texture, int layer, std::span<float> values) override;
    void create_program(relevo_program program, const char* file) override;
    void destroy_program(relevo_program) override {}
    void draw(const relevo_draw& draw) override;

    bool in_frame() const override { return frame_ >= 0; }
    relevo_frame frame() override;
    void fill_bounds(relevo_box& box) override;
    bool fill_visible_bounds(double nearer_than_m, relevo_box& box) override;
    int draw_depth(const relevo_box&, double, relevo_texture) override { return 0; }
    relevo_heights heights() override;
    void read_heights(const relevo_nodes& nodes, std::span<float> heights_m) override;
    Point to_local(const Point& lat_lon_height) override;
    Point from_local(const Point& local_m) override;
    Pair to_post(const Pair& lat_lon) override;
    Pair from_post(const Pair& column_row) override;

    struct Parameter {
        bool is_host;
        Value value;
    };
    Parameter& known(const char* address);

    std::filesystem::path folder_;
    std::map<std::string, Parameter> parameters_;
    std::map<std::string, std::string> texts_;
    std::set<std::string> marks_;
    int frame_ = -1;
};

}  // namespace relevo::effect
