// The interface of native plugins is frozen: modules that are built against this header load for
// ever, and what is laid out here may only grow.
#include <array>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <relevo/plugin.h>

#include "support/support.h"

namespace relevo::test {
namespace {

#define AT(type, member, offset) \
    static_assert(offsetof(type, member) == (offset), #type "." #member " has moved")

AT(relevo_host, size, 0);
AT(relevo_host, abi_version, 4);
AT(relevo_host, service, 8);
AT(relevo_host, fail, 16);

AT(relevo_module, size, 0);
AT(relevo_module, id, 8);
AT(relevo_module, create, 16);
AT(relevo_module, destroy, 24);
AT(relevo_module, prepare, 32);

AT(relevo_log_1, self, 8);
AT(relevo_log_1, write, 16);
AT(relevo_params_1, self, 8);
AT(relevo_params_1, get, 16);
AT(relevo_params_1, set, 24);
AT(relevo_params_1, get_text, 32);
AT(relevo_frame_1, self, 8);
AT(relevo_frame_1, get, 16);
AT(relevo_texture_1, self, 8);
AT(relevo_texture_1, create, 16);
AT(relevo_texture_1, destroy, 24);
AT(relevo_texture_1, write, 32);
AT(relevo_texture_1, make_mipmaps, 40);
AT(relevo_texture_1, read, 48);
AT(relevo_draw_1, self, 8);
AT(relevo_draw_1, program, 16);
AT(relevo_draw_1, destroy_program, 24);
AT(relevo_draw_1, draw, 32);
AT(relevo_terrain_1, self, 8);
AT(relevo_terrain_1, bounds, 16);
AT(relevo_terrain_1, visible_bounds, 24);
AT(relevo_terrain_1, draw_depth, 32);
AT(relevo_heights_1, self, 8);
AT(relevo_heights_1, describe, 16);
AT(relevo_heights_1, read, 24);
AT(relevo_geo_1, self, 8);
AT(relevo_geo_1, to_local, 16);
AT(relevo_geo_1, from_local, 24);
AT(relevo_geo_1, to_post, 32);
AT(relevo_marks_1, self, 8);
AT(relevo_marks_1, set, 16);
AT(relevo_geo_1, from_post, 40);

AT(relevo_frame, size, 0);
AT(relevo_frame, width_px, 4);
AT(relevo_frame, height_px, 8);
AT(relevo_frame, software_device, 12);
AT(relevo_frame, ground, 16);
AT(relevo_frame, unix_s, 24);
AT(relevo_frame, eye_m, 32);
AT(relevo_frame, right, 56);
AT(relevo_frame, up, 80);
AT(relevo_frame, forward, 104);
AT(relevo_frame, fov_y_rad, 128);
AT(relevo_frame, pixel_rad, 136);
AT(relevo_frame, view, 144);
AT(relevo_frame, projection, 272);
AT(relevo_frame, exposure, 400);
AT(relevo_frame, sun, 408);
AT(relevo_frame, sun_apparent, 432);
AT(relevo_frame, exaggeration, 456);
AT(relevo_frame, lowest_m, 464);
AT(relevo_frame, highest_m, 472);
AT(relevo_frame, post_spacing_m, 480);
AT(relevo_frame, afresh, 488);
AT(relevo_frame, reserved, 492);

AT(relevo_texture_info, format, 4);
AT(relevo_texture_info, filter, 8);
AT(relevo_texture_info, width, 12);
AT(relevo_texture_info, height, 16);
AT(relevo_texture_info, layers, 20);
AT(relevo_texture_info, levels, 24);
AT(relevo_texture_info, name, 32);

AT(relevo_texels, texture, 4);
AT(relevo_texels, layer, 8);
AT(relevo_texels, level, 12);
AT(relevo_texels, x, 16);
AT(relevo_texels, y, 20);
AT(relevo_texels, width, 24);
AT(relevo_texels, height, 28);
AT(relevo_texels, texels, 32);
AT(relevo_texels, bytes, 40);

AT(relevo_draw, program, 4);
AT(relevo_draw, target, 8);
AT(relevo_draw, layer, 12);
AT(relevo_draw, level, 16);
AT(relevo_draw, input_count, 20);
AT(relevo_draw, value_count, 24);
AT(relevo_draw, inputs, 32);
AT(relevo_draw, values, 40);

AT(relevo_box, right, 8);
AT(relevo_box, up, 32);
AT(relevo_box, towards, 56);
AT(relevo_box, low, 80);
AT(relevo_box, high, 104);

AT(relevo_heights, columns, 4);
AT(relevo_heights, rows, 8);
AT(relevo_heights, levels, 12);
AT(relevo_nodes, level, 4);
AT(relevo_nodes, column, 8);
AT(relevo_nodes, row, 12);
AT(relevo_nodes, columns, 16);
AT(relevo_nodes, rows, 20);

AT(relevo_mark, height_of, 4);
AT(relevo_mark, lat_deg, 8);
AT(relevo_mark, lon_deg, 16);
AT(relevo_mark, height_m, 24);
AT(relevo_mark, rank, 32);
AT(relevo_mark, symbol, 40);
AT(relevo_mark, direction, 44);
AT(relevo_mark, azimuth_deg, 48);
AT(relevo_mark, text, 56);

// No padding at the end either: the next word would lie in it, and nobody could tell.
#define ENDS(type, last) \
    static_assert(sizeof(type) == offsetof(type, last) + sizeof(type::last), #type " has padding")

ENDS(relevo_host, fail);
ENDS(relevo_module, prepare);
ENDS(relevo_frame, reserved);
ENDS(relevo_texture_info, name);
ENDS(relevo_texels, bytes);
ENDS(relevo_draw, values);
ENDS(relevo_box, high);
ENDS(relevo_heights, levels);
ENDS(relevo_nodes, rows);
ENDS(relevo_mark, text);

/// What a host says of a module, each built against this header or against one that has grown.
std::string answer(const std::string& host, const std::string& module,
                   const std::string& more = "") {
    const std::string folder = (build_dir() / "tests/abi").string();
    const std::string command = fmt::format("{0}/{1} {0}/{2}.so {3}/tests/abi/plugin {4} 2>&1",
                                            folder, host, module, source_dir().string(), more);
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
    std::string text;
    std::array<char, 256> piece{};
    while (pipe && std::fgets(piece.data(), piece.size(), pipe.get()))
        text += piece.data();
    return text;
}

TEST(Abi, ModulesInCAndCppDoInTodaysHost) {
    EXPECT_EQ(answer("host", "c_module"), "ok, interface 2.1 of the module\n");
    EXPECT_EQ(answer("host", "cpp_module"), "ok, interface 2.1 of the module\n");
}

TEST(Abi, TheyDoInAHostWhoseStructsHaveGrown) {
    EXPECT_EQ(answer("grown_host", "c_module"), "ok, interface 2.1 of the module\n");
    EXPECT_EQ(answer("grown_host", "cpp_module"), "ok, interface 2.1 of the module\n");
}

TEST(Abi, LaterModulesThatAskForNoMoreDoInTodaysHost) {
    EXPECT_EQ(answer("host", "grown_cpp_module"), "ok, interface 2.7 of the module\n");
    EXPECT_EQ(answer("grown_host", "grown_c_module"), "ok, interface 2.7 of the module\n");
}

TEST(Abi, AModuleRefusesAHostThatItCannotUse) {
    EXPECT_EQ(answer("host", "cpp_module", "older-major"),
              "registration: this program has version 1.0 of the plugin interface, and the module "
              "is built for 2.1\n");
    EXPECT_EQ(answer("host", "cpp_module", "small-table"),
              "registration: this program has version 2.1 of the plugin interface, and the module "
              "is built for 2.1\n");
}

}  // namespace
}  // namespace relevo::test
