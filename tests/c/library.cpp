#include "c/library.h"

#include <gtest/gtest.h>

#include "cli/program.h"

namespace relevo::test {

void expect_ok(relevo_result result) {
    EXPECT_EQ(result, RELEVO_RESULT_OK) << relevo_error();
}

void expect_error(relevo_result result, relevo_result code, const std::string& message) {
    EXPECT_EQ(result, code);
    EXPECT_EQ(relevo_error(), message);
}

DemHandle open_bundled() {
    const std::string path = bundled_dem();
    const char* const file = path.c_str();
    relevo_dem* dem = nullptr;
    expect_ok(relevo_dem_open(&file, 1, nullptr, &dem));
    return DemHandle(dem);
}

relevo_grid grid_of(relevo_dem* dem) {
    auto grid = sized<relevo_grid>();
    expect_ok(relevo_dem_grid(dem, &grid));
    return grid;
}

std::size_t posts_of(relevo_dem* dem) {
    const relevo_grid grid = grid_of(dem);
    return static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
}

SessionHandle open_session(relevo_dem* dem, const std::string& scene) {
    auto options = sized<relevo_open_options>();
    options.device = "software";
    options.dem = dem;
    relevo_session* session = nullptr;
    expect_ok(relevo_open(scene.c_str(), &options, &session));
    return SessionHandle(session);
}

Colours draw(relevo_session* session) {
    Colours colours;
    std::int32_t columns = 0, rows = 0;
    expect_ok(relevo_picture_size(session, &columns, &rows));
    colours.columns = columns;
    colours.rows = rows;
    colours.rgba.resize(4 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    auto picture = sized<relevo_picture>();
    picture.rgba = colours.rgba.data();
    picture.rgba_count = colours.rgba.size();
    expect_ok(relevo_draw_picture(session, &picture));
    return colours;
}

}  // namespace relevo::test
