#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "options.h"
#include "scene_drawer.h"
#include "session_thread.h"

namespace relevo::c {
namespace {

/// A scene with the thread that it is drawn on.
class SceneOnThread {
  public:
    /// @throws Error as SceneDrawer
    SceneOnThread(scene::Scene scene, std::shared_ptr<Dem> dem, const std::string& device,
                  const std::filesystem::path& folder) {
        thread_.run([&] {
            drawer_ =
                std::make_unique<SceneDrawer>(std::move(scene), std::move(dem), device, folder);
        });
    }
    ~SceneOnThread() {
        thread_.run([this] { drawer_.reset(); });
    }

    template <typename Work>
    void run(const Work& work) {
        thread_.run([&] { work(*drawer_); });
    }

  private:
    SessionThread thread_;
    std::unique_ptr<SceneDrawer> drawer_;
};

Handles<relevo_session, SceneOnThread>& sessions() {
    static auto& all = *new Handles<relevo_session, SceneOnThread>;  // closed by nobody else
    return all;
}

std::shared_ptr<SceneOnThread> open(const char* text, const relevo_open_options* given) {
    relevo_open_options options{};
    if (given) options = read_struct(given, "options");
    const std::filesystem::path folder = options.folder ? options.folder : "";
    scene::Scene scene;
    std::shared_ptr<Dem> dem;
    if (options.dem) {
        dem = dems().get(options.dem, "options.dem");
        scene = dem->named();
    }
    change_scene(scene, text, folder);
    if (dem && !same_dem(scene, dem->named()))
        bad_input("scene: dem: expected the DEM of options.dem, read as it is");
    return std::make_shared<SceneOnThread>(std::move(scene), std::move(dem),
                                           options.device ? options.device : "auto", folder);
}

/// Before anything is written.
void check_counts(const glm::ivec2& size_px, const relevo_picture& picture) {
    const std::size_t pixels =
        static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y);
    const auto check = [&](const void* array, const char* name, std::size_t count,
                           std::size_t components) {
        if (array) check_count(name, count, components * pixels);
    };
    check(picture.rgba, "picture.rgba_count", picture.rgba_count, 4);
    check(picture.depth_m, "picture.depth_count", picture.depth_count, 1);
    check(picture.position_m, "picture.position_count", picture.position_count, 3);
    check(picture.normal, "picture.normal_count", picture.normal_count, 3);
}

void fill_colours(const image::Image8& image, const relevo_picture& picture) {
    const std::size_t pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const auto channels = static_cast<std::size_t>(image.channels);
    const bool grey = channels < 3, alpha = channels % 2 == 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::uint8_t* from = &image.values[i * channels];
        std::uint8_t* to = picture.rgba + 4 * i;
        for (std::size_t k = 0; k < 3; ++k)
            to[k] = from[grey ? 0 : k];
        to[3] = alpha ? from[channels - 1] : 255;
    }
}

/// A layer of one channel or of three, as pixels.
void fill_layer(const DrawnData& data, const std::string& name, std::size_t components, float* to) {
    if (!to) return;
    std::size_t component = 0;
    for (const image::Channel& channel : data.channels) {
        if (!channel.name.starts_with(name + ".")) continue;
        for (std::size_t i = 0; i < channel.values.size(); ++i)
            to[i * components + component] = channel.values[i];
        ++component;
    }
}

void fill_data(const DrawnData& data, relevo_picture& picture) {
    fill_layer(data, "depth", 1, picture.depth_m);
    fill_layer(data, "position", 3, picture.position_m);
    fill_layer(data, "normal", 3, picture.normal);
    picture.origin_lat_deg = degrees(data.origin.lat_rad);
    picture.origin_lon_deg = degrees(data.origin.lon_rad);
    picture.origin_height_m = data.origin.height_m;
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_open(const char* scene, const relevo_open_options* options,
                          relevo_session** session) {
    return c::guarded("relevo_open", [&] {
        c::need(session, "session") = nullptr;
        *session = c::sessions().add(c::open(scene, options));
    });
}

void relevo_close(relevo_session* session) {
    c::sessions().remove(session);
}

relevo_result relevo_set(relevo_session* session, const char* change) {
    return c::guarded("relevo_set", [&] {
        c::need(change, "change");
        c::sessions().get(session, "session")->run([&](c::SceneDrawer& drawer) {
            drawer.change(change);
        });
    });
}

relevo_result relevo_resize(relevo_session* session, int32_t columns, int32_t rows) {
    return c::guarded("relevo_resize", [&] {
        const auto of = c::sessions().get(session, "session");
        if (columns < 1 || rows < 1 || columns > scene::kMaxSide_px || rows > scene::kMaxSide_px)
            bad_input(
                fmt::format("relevo_resize: expected 1 to {} columns and rows but got {} and "
                            "{}",
                            scene::kMaxSide_px, columns, rows));
        of->run([&](c::SceneDrawer& drawer) { drawer.resize(columns, rows); });
    });
}

relevo_result relevo_scene(relevo_session* session, const char** scene) {
    return c::guarded("relevo_scene", [&] {
        c::need(scene, "scene") = nullptr;
        scene::Scene settled;
        c::sessions().get(session, "session")->run([&](c::SceneDrawer& drawer) {
            settled = drawer.settled();
        });
        *scene = c::returned_text(scene::whole_scene_line(settled));
    });
}

relevo_result relevo_picture_size(relevo_session* session, int32_t* columns, int32_t* rows) {
    return c::guarded("relevo_picture_size", [&] {
        c::need(columns, "columns");
        c::need(rows, "rows");
        c::sessions().get(session, "session")->run([&](c::SceneDrawer& drawer) {
            const glm::ivec2 size_px = drawer.picture_px();
            *columns = size_px.x;
            *rows = size_px.y;
        });
    });
}

relevo_result relevo_draw_picture(relevo_session* session, relevo_picture* picture) {
    return c::guarded("relevo_draw_picture", [&] {
        relevo_picture wanted = c::read_struct(picture, "picture");
        c::sessions().get(session, "session")->run([&](c::SceneDrawer& drawer) {
            const bool with_data = wanted.depth_m || wanted.position_m || wanted.normal;
            if (with_data) drawer.check_has_data();
            c::check_counts(drawer.picture_px(), wanted);
            if (wanted.rgba) c::fill_colours(drawer.picture(), wanted);
            if (with_data) c::fill_data(drawer.data(), wanted);
        });
        c::write_struct(wanted, picture);
    });
}
