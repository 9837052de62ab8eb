// The same by the C++ header: each class of it, and what it throws.
#include <cmath>
#include <string>

#include <relevo/plugin.hpp>

namespace {

using namespace relevo::plugin;

void expect(bool condition, const char* what) {
    if (!condition) throw Failure(std::string("module.cpp: ") + what);
}

template <typename Body>
bool fails(const Body& body) {
    try {
        body();
    } catch (const Failure&) {
        return true;
    }
    return false;
}

/// A table that has grown by a function that this host may lack.
struct Grown {
    std::uint32_t size, reserved;
    void* self;
    void (*old)(void*);
    void (*later)(void*);
};

class Probe : public Instance {
  public:
    explicit Probe(const Host& host)
        : host_(host),
          log_(host),
          params_(host),
          frame_(host),
          terrain_(host),
          heights_(host),
          geo_(host),
          marks_(host),
          program_(host, "fill.glsl") {
        log_.debug("made");
        expect(params_.get("probe.size") == 3, "a parameter");
        params_.set("probe.level", {1, 2, 3, 4});
        expect(params_.text("probe.track").empty(), "a text");
        expect(fails([&] { params_.get("probe.nothing"); }), "an unknown parameter");
        expect(fails([&] { frame_.get(); }), "a frame outside of prepare()");
        expect(fails([&] { host.service<relevo_log_1>("relevo.weather", 1); }), "a service");
        relevo_texture_info info{};
        info.format = RELEVO_FORMAT_RGBA8;
        info.width = info.height = 2;
        info.levels = 1;
        texture_ = Texture(host, info);
        const std::array<std::byte, 16> texels{};
        texture_.write(0, 0, 0, 0, 2, 2, texels);
        expect(fails([&] { texture_.write(0, 0, 1, 0, 2, 2, texels); }), "a rectangle beyond");
        program_.draw(texture_, 0, 0, {}, {Program::Value{1, 0, 0, 1}});

        Grown grown{sizeof(Grown) - sizeof(void*), 0, nullptr, [](void*) {}, nullptr};
        expect(function_of<&Grown::old>(grown, "old") == grown.old, "a function that is there");
        expect(fails([&] { function_of<&Grown::later>(grown, "later"); }), "one beyond the size");
        grown.size = sizeof grown;
        expect(fails([&] { function_of<&Grown::later>(grown, "later"); }), "one that is null");
    }

    void prepare() override {
        const relevo_frame frame = frame_.get();
        relevo_box box{};
        box.right[0] = box.up[1] = box.towards[2] = 1;
        terrain_.bounds(box);
        expect(box.high[0] > box.low[0] && frame.post_spacing_m > 0, "the ground's box");
        const relevo_heights about = heights_.describe();
        const std::vector<float> posts = heights_.read(0, 0, 0, about.columns, 1);
        expect(posts.size() == static_cast<std::size_t>(about.columns), "a row of posts");
        const auto post = geo_.to_post({0.01, 0.01});
        const auto back = post ? geo_.from_post(*post) : std::nullopt;
        expect(back && std::abs((*back)[0] - 0.01) < 1e-6, "to a post and back");
        const Geo::Point local = geo_.to_local({0.01, 0.01, 5});
        expect(std::abs(geo_.from_local(local)[2] - 5) < 1e-6, "to the local frame and back");
        marks_.set("places", std::array{Mark{.text = "here"}, Mark{.azimuth_deg = 30}});
        expect(fails([&] { marks_.set("others", {}); }), "an unknown list");
        expect(fails([&] { marks_.set("places", std::array{Mark{.lat_deg = 95}}); }), "a latitude");
    }

  private:
    Host host_;
    Log log_;
    Params params_;
    Frame frame_;
    Terrain terrain_;
    Heights heights_;
    Geo geo_;
    Marks marks_;
    Program program_;
    Texture texture_;
};

}  // namespace

RELEVO_PLUGIN("probe", Probe)
