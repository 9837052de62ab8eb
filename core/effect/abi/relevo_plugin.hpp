// relevo_plugin.h in C++20: services as objects, failures as exceptions that stay inside.
// Header-only; links with nothing of Relevo's.
//
//     class Dust : public relevo::plugin::Instance {
//       public:
//         explicit Dust(const relevo::plugin::Host& host) : params_(host) {}
//         void prepare() override { params_.set("dust.time_s", {seconds()}); }
//       private:
//         relevo::plugin::Params params_;
//     };
//     RELEVO_PLUGIN("dust", Dust)
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "relevo_plugin.h"

namespace relevo::plugin {

/// Something cannot go on; what() is what the user reads.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The host reported why itself: there is nothing to add.
struct HostFailure : Failure {
    HostFailure() : Failure("the host refused") {}
};

class Host {
  public:
    explicit Host(const relevo_host* host) : host_(host) {}

    /// A service's table. @throws Failure if this host has none
    template <typename Table>
    const Table& service(const char* name, std::uint32_t version) const {
        const void* table = host_->service(host_, name, version);
        if (!table)
            throw Failure(std::string("this program has no service ") + name + "/" +
                          std::to_string(version) + "; a newer Relevo may");
        return *static_cast<const Table*>(table);
    }
    const relevo_host* get() const { return host_; }

  private:
    const relevo_host* host_;
};

/// What a plugin makes: one for each renderer.
class Instance {
  public:
    virtual ~Instance() = default;
    virtual void prepare() {}  ///< for every frame, before its picture is drawn
};

inline void check(relevo_status status) {
    if (status != RELEVO_OK) throw HostFailure();
}

class Log {
  public:
    explicit Log(const Host& host) : table_(host.service<relevo_log_1>("relevo.log", 1)) {}
    void debug(const std::string& text) const { write(RELEVO_LOG_DEBUG, text); }
    void info(const std::string& text) const { write(RELEVO_LOG_INFO, text); }
    void warning(const std::string& text) const { write(RELEVO_LOG_WARNING, text); }

  private:
    void write(std::int32_t level, const std::string& text) const {
        table_.write(table_.self, level, text.c_str());
    }
    const relevo_log_1& table_;
};

class Params {
  public:
    explicit Params(const Host& host) : table_(host.service<relevo_params_1>("relevo.params", 1)) {}
    std::array<double, 4> get4(const char* address) const {
        std::array<double, 4> value{};
        check(table_.get(table_.self, address, value.data()));
        return value;
    }
    double get(const char* address) const { return get4(address)[0]; }
    void set(const char* address, const std::array<double, 4>& value) const {
        check(table_.set(table_.self, address, value.data()));
    }

  private:
    const relevo_params_1& table_;
};

class Frame {
  public:
    explicit Frame(const Host& host) : table_(host.service<relevo_frame_1>("relevo.frame", 1)) {}
    relevo_frame get() const {
        relevo_frame frame{};
        frame.size = sizeof frame;
        check(table_.get(table_.self, &frame));
        return frame;
    }

  private:
    const relevo_frame_1& table_;
};

/// A texture that goes with its owner.
class Texture {
  public:
    Texture() = default;
    Texture(const Host& host, relevo_texture_info info)
        : table_(&host.service<relevo_texture_1>("relevo.texture", 1)) {
        info.size = sizeof info;
        check(table_->create(table_->self, &info, &texture_));
    }
    Texture(Texture&& other) noexcept
        : table_(other.table_), texture_(std::exchange(other.texture_, 0)) {}
    Texture& operator=(Texture&& other) noexcept {
        std::swap(table_, other.table_);
        std::swap(texture_, other.texture_);
        return *this;
    }
    ~Texture() {
        if (texture_) table_->destroy(table_->self, texture_);
    }

    void make_mipmaps() const { check(table_->make_mipmaps(table_->self, texture_)); }
    void read(int layer, std::span<float> values) const {
        check(table_->read(table_->self, texture_, layer, values.data(), values.size()));
    }
    relevo_texture get() const { return texture_; }
    explicit operator bool() const { return texture_ != 0; }

  private:
    const relevo_texture_1* table_ = nullptr;
    relevo_texture texture_ = 0;
};

/// A fragment program of the plugin's folder.
class Program {
  public:
    Program(const Host& host, const char* file)
        : table_(host.service<relevo_draw_1>("relevo.draw", 1)) {
        check(table_.program(table_.self, file, &program_));
    }

    using Value = std::array<float, 4>;
    void draw(const Texture& target, int layer, int level, std::initializer_list<const Texture*> in,
              std::initializer_list<Value> values) const {
        std::vector<relevo_texture> inputs;
        for (const Texture* texture : in)
            inputs.push_back(texture->get());
        relevo_draw draw{};
        draw.size = sizeof draw;
        draw.program = program_;
        draw.target = target.get();
        draw.layer = layer;
        draw.level = level;
        draw.inputs = inputs.data();
        draw.input_count = static_cast<std::int32_t>(inputs.size());
        draw.values = values.size() > 0 ? values.begin()->data() : nullptr;
        draw.value_count = static_cast<std::int32_t>(values.size());
        check(table_.draw(table_.self, &draw));
    }

  private:
    const relevo_draw_1& table_;
    relevo_program program_ = 0;
};

class Terrain {
  public:
    explicit Terrain(const Host& host)
        : table_(host.service<relevo_terrain_1>("relevo.terrain", 1)) {}

    /// Fills the sides of a box whose axes are set.
    void bounds(relevo_box& box) const {
        box.size = sizeof box;
        check(table_.bounds(table_.self, &box));
    }
    /// False where no ground is seen that near.
    bool visible_bounds(double nearer_than_m, relevo_box& box) const {
        box.size = sizeof box;
        return table_.visible_bounds(table_.self, nearer_than_m, &box) == RELEVO_OK;
    }
    /// @returns the level of detail that was drawn
    int draw_depth(relevo_box box, double tolerance_m, const Texture& target) const {
        std::int32_t level = 0;
        box.size = sizeof box;
        check(table_.draw_depth(table_.self, &box, tolerance_m, target.get(), &level));
        return level;
    }

  private:
    const relevo_terrain_1& table_;
};

/// Runs `body` and turns what it throws into a status.
template <typename Body>
relevo_status guarded(const relevo_host* host, const Body& body) noexcept {
    try {
        body();
        return RELEVO_OK;
    } catch (const HostFailure&) {
    } catch (const std::exception& error) {
        host->fail(host, error.what());
    } catch (...) {
        host->fail(host, "an exception that is no std::exception");
    }
    return RELEVO_FAILED;
}

template <typename Made>
struct Module {
    struct Box {
        const relevo_host* host;
        Made made;
    };
    static relevo_status create(const relevo_host* host, void** instance) {
        return guarded(host, [&] { *instance = new Box{host, Made(Host(host))}; });
    }
    static void destroy(void* instance) { delete static_cast<Box*>(instance); }
    static relevo_status prepare(void* instance) {
        Box* box = static_cast<Box*>(instance);
        return guarded(box->host, [&] { box->made.prepare(); });
    }
};

}  // namespace relevo::plugin

/// Exports a class that derives from Instance and is made of a `const Host&`.
#define RELEVO_PLUGIN(plugin_id, type)                                                          \
    extern "C" RELEVO_PLUGIN_EXPORT const std::uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION; \
    extern "C" RELEVO_PLUGIN_EXPORT relevo_status relevo_plugin_register(const relevo_host*,    \
                                                                         relevo_module* m) {    \
        m->id = plugin_id;                                                                      \
        m->create = &relevo::plugin::Module<type>::create;                                      \
        m->destroy = &relevo::plugin::Module<type>::destroy;                                    \
        m->prepare = &relevo::plugin::Module<type>::prepare;                                    \
        return RELEVO_OK;                                                                       \
    }
