#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "effect/abi/relevo_plugin.h"

namespace relevo::effect {

/// The services of relevo_plugin.h with no device behind them: textures that hold nothing, programs
/// that are not compiled, a DEM that is a box. What a module asks wrongly is refused as
/// render/native_host.h refuses it.
class StandInHost {
  public:
    explicit StandInHost(std::filesystem::path plugin_folder);
    StandInHost(const StandInHost&) = delete;
    StandInHost& operator=(const StandInHost&) = delete;

    void add_parameter(const std::string& address, bool is_host,
                       const std::array<double, 4>& value);

    /// Offers "relevo.log" alone before start(), as a registration finds it.
    const relevo_host* host() const { return &host_; }
    void start() { started_ = true; }
    /// The last reason that a service or the module gave.
    const std::string& reason() const { return reason_; }

    /// From now on services that need a frame answer, with the sun and the ground of the n-th.
    void begin_frame(int number);
    void end_frame() { frame_ = -1; }

  private:
    struct Parameter {
        bool is_host;
        std::array<double, 4> value;
    };
    struct Texture {
        int width, height, layers, levels;
        std::int32_t format;
    };
    struct OwnHost : relevo_host {
        StandInHost* owner = nullptr;
    };

    static StandInHost& of(void* self) { return *static_cast<StandInHost*>(self); }
    relevo_status refuse(const char* reason);
    void fill_tables();
    relevo_status make_texture(const relevo_texture_info* info, relevo_texture* texture);
    relevo_status read_texture(relevo_texture name, int layer, float* values, std::uint64_t count);
    relevo_status draw(const relevo_draw* given);
    relevo_status fill_frame(relevo_frame* out);
    relevo_status fill_box(relevo_box* box, double half_side_m);

    std::filesystem::path folder_;
    OwnHost host_{};
    relevo_log_1 log_{};
    relevo_params_1 params_{};
    relevo_frame_1 frame_table_{};
    relevo_texture_1 texture_{};
    relevo_draw_1 draw_{};
    relevo_terrain_1 terrain_{};
    std::map<std::string, Parameter, std::less<>> parameters_;
    std::map<relevo_texture, Texture> textures_;
    relevo_texture last_texture_ = 0;
    relevo_program last_program_ = 0;
    int frame_ = -1;
    bool started_ = false;
    std::string reason_;
};

}  // namespace relevo::effect
