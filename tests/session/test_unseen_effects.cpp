// An effect that is asked for changes the picture, or a line says why it does not.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/contains.h"
#include "base/log.h"
#include "base/units.h"
#include "dem/fixture.h"
#include "session/session.h"
#include "support/change.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_unseen_effects {
namespace {

using Ids = std::vector<std::string>;
const Ids kBase = {"block", "sky", "layering", "sea"};

/// Lines that are logged while this exists.
class Said {
  public:
    Said() {
        log::set_sink([this](log::Level, std::string_view line) { texts_.back() += line; });
    }
    ~Said() { log::set_sink({}); }
    /// What is logged from now on is of the next view.
    void begin() { texts_.emplace_back(); }
    /// In this view; or once in the first one, of what no view shows.
    bool about(std::size_t view, const std::string& id) const {
        const auto has = [](const std::string& text, const std::string& words) {
            return text.find(words) != std::string::npos;
        };
        const std::string &first = texts_[1], &now = texts_[view + 1];
        return has(now, id) || (has(first, id) && !has(first, "not seen from"));
    }

  private:
    std::vector<std::string> texts_{1};
};

/// Mountains of up to 51 degrees, with sea between them.
std::string mountains() {
    test::Raster raster;
    raster.columns = raster.rows = 96;
    raster.value = [](int column, int row, int) {
        return std::max(250 * std::sin(0.15 * column) * std::cos(0.13 * row), 0.0);
    };
    return test::write_raster(test::scratch_dir("mountains") / "mountains.tif", raster);
}

TEST(UnseenEffects, ChangeThePictureOrSayWhyNot) {
    scene::Scene scene;
    scene.dems = {mountains()};
    scene.time.at = "2026-06-21T06:00Z";
    scene.width_px = 96;
    scene.height_px = 72;
    scene.effects.switches.only = kBase;
    scene::View ground;
    ground.eye = {{radians(46.9430), radians(9.0154), 100}, /*above_ground=*/true};
    const std::vector<std::pair<std::string, scene::View>> views = {
        {"a block", scene::parse_view("az=210,el=30")},
        {"a top view", scene::parse_view("top")},
        {"a view from within", ground}};
    FilesInUse files;
    Session session(scene, {.device = test::gl_device()}, files);
    scene.ortho = true;
    Session map(scene, {.device = test::gl_device()}, files);
    std::vector<std::uint8_t> base_top;
    const auto pictures = [&](const Ids& ids, Said* said) {
        std::vector<image::Image8> shown;
        const auto show = [&](Session& of) {
            scene::Effects effects = scene.effects;
            effects.switches.only = ids;
            if (said) said->begin();
            test::set_effects(of, effects);
            of.draw();
            shown.push_back(of.picture());
        };
        for (const auto& [name, view] : views) {
            test::look(session, view);
            show(session);
        }
        // Programs of maps take long to compile: those that a top view does not show.
        if (!said || shown[1].values == base_top) show(map);
        return shown;
    };
    const std::vector<image::Image8> base = pictures(kBase, nullptr);
    base_top = base[1].values;
    Ids installed;
    for (const effect::Effect& effect : session.effects().registry.effects())
        installed.push_back(effect.id());
    for (const std::string& id : installed) {
        if (contains(kBase, id)) continue;
        Ids ids = kBase;
        ids.push_back(id);
        Said said;
        const std::vector<image::Image8> shown = pictures(ids, &said);
        for (std::size_t i = 0; i < shown.size(); ++i)
            EXPECT_TRUE(shown[i].values != base[i].values || said.about(i, id))
                << id << " in " << (i < views.size() ? views[i].first : "a map");
    }
}

}  // namespace
}  // namespace relevo::session::test_unseen_effects
