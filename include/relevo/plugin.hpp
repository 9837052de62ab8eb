// relevo/plugin.h in C++20: services as objects, failures as exceptions that stay inside.
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

#if !defined(__cplusplus) || \
    (__cplusplus < 202002L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 202002L))
#error "relevo/plugin.hpp needs C++20 (-std=c++20); relevo/plugin.h does with C99"
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <relevo/plugin.h>

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
    /// The minor version of the interface that this host has.
    std::uint32_t minor() const { return host_->abi_version & 0xffff; }
    const relevo_host* get() const { return host_; }

  private:
    const relevo_host* host_;
};

/// A function of a service's table that came with a later minor version than the table itself.
/// Those of version 2.0 need no such check.
/// @throws Failure if this host's table ends before it
template <auto Member, typename Table>
auto function_of(const Table& table, const char* name) {
    const auto* const begin = reinterpret_cast<const char*>(&table);
    const auto* const end = reinterpret_cast<const char*>(&(table.*Member)) + sizeof(table.*Member);
    if (table.size < static_cast<std::size_t>(end - begin) || table.*Member == nullptr)
        throw Failure(std::string("this program has no ") + name + "; a newer Relevo may");
    return table.*Member;
}

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
    /// A text, or the path of a file, of plugin.json's "texts"; empty where none is given.
    std::string text(const char* address) const {
        std::uint64_t length = 0;
        check(table_.get_text(table_.self, address, nullptr, 0, &length));
        std::string text(static_cast<std::size_t>(length), '\0');
        check(table_.get_text(table_.self, address, text.data(), length + 1, nullptr));
        return text;
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

    /// Replaces a rectangle of a level. @param texels  as the format has them, rows without gaps
    void write(int layer, int level, int x, int y, int width, int height,
               std::span<const std::byte> texels) const {
        relevo_texels to{};
        to.size = sizeof to;
        to.texture = texture_;
        to.layer = layer;
        to.level = level;
        to.x = x;
        to.y = y;
        to.width = width;
        to.height = height;
        to.texels = texels.data();
        to.bytes = texels.size();
        check(table_->write(table_->self, &to));
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

/// A fragment program of the plugin's folder, which goes with its owner.
class Program {
  public:
    Program(const Host& host, const char* file)
        : table_(&host.service<relevo_draw_1>("relevo.draw", 1)) {
        check(table_->program(table_->self, file, &program_));
    }
    Program(Program&& other) noexcept
        : table_(other.table_), program_(std::exchange(other.program_, 0)) {}
    Program& operator=(Program&& other) noexcept {
        std::swap(table_, other.table_);
        std::swap(program_, other.program_);
        return *this;
    }
    ~Program() {
        if (program_) table_->destroy_program(table_->self, program_);
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
        check(table_->draw(table_->self, &draw));
    }

  private:
    const relevo_draw_1* table_;
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
        const relevo_status status = table_.visible_bounds(table_.self, nearer_than_m, &box);
        if (status != RELEVO_NOTHING) check(status);
        return status == RELEVO_OK;
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

/// The DEM's heights. Inside prepare() only.
class Heights {
  public:
    explicit Heights(const Host& host)
        : table_(host.service<relevo_heights_1>("relevo.heights", 1)) {}

    relevo_heights describe() const {
        relevo_heights heights{};
        heights.size = sizeof heights;
        check(table_.describe(table_.self, &heights));
        return heights;
    }
    /// Row by row [m], NaN in holes.
    std::vector<float> read(int level, int column, int row, int columns, int rows) const {
        if (columns < 1 || rows < 1) return {};
        relevo_nodes nodes{};
        nodes.size = sizeof nodes;
        nodes.level = level;
        nodes.column = column;
        nodes.row = row;
        nodes.columns = columns;
        nodes.rows = rows;
        std::vector<float> heights_m(static_cast<std::size_t>(columns) *
                                     static_cast<std::size_t>(rows));
        check(table_.read(table_.self, &nodes, heights_m.data(), heights_m.size()));
        return heights_m;
    }

  private:
    const relevo_heights_1& table_;
};

/// Where things lie. Inside prepare() only; degrees and metres.
class Geo {
  public:
    explicit Geo(const Host& host) : table_(host.service<relevo_geo_1>("relevo.geo", 1)) {}

    using Point = std::array<double, 3>;
    using Post = std::array<double, 2>;
    Point to_local(const Point& lat_lon_height) const {
        Point local_m{};
        check(table_.to_local(table_.self, lat_lon_height.data(), local_m.data()));
        return local_m;
    }
    Point from_local(const Point& local_m) const {
        Point place{};
        check(table_.from_local(table_.self, local_m.data(), place.data()));
        return place;
    }
    /// Column and row; nothing where the DEM's map has no such place.
    std::optional<Post> to_post(const Post& lat_lon) const {
        return found([&](double* to) { return table_.to_post(table_.self, lat_lon.data(), to); });
    }
    std::optional<Post> from_post(const Post& column_row) const {
        return found(
            [&](double* to) { return table_.from_post(table_.self, column_row.data(), to); });
    }

  private:
    template <typename Ask>
    static std::optional<Post> found(const Ask& ask) {
        Post post{};
        const relevo_status status = ask(post.data());
        if (status == RELEVO_NOTHING) return std::nullopt;
        check(status);
        return post;
    }
    const relevo_geo_1& table_;
};

/// A name or symbol at a place. relevo_mark describes the members.
struct Mark {
    double lat_deg = 0, lon_deg = 0;
    std::string text = {};
    std::int32_t height_of = RELEVO_ON_GROUND;
    double height_m = 0;
    double rank = 1;
    std::int32_t symbol = RELEVO_SYMBOL_OF_LIST;
    std::optional<double> azimuth_deg = {};  ///< of the text; nothing: it is upright

    bool operator==(const Mark&) const = default;
};

/// Marks that the host draws over the picture. Hosts of version 2.0 lack this service.
class Marks {
  public:
    explicit Marks(const Host& host) : table_(host.service<relevo_marks_1>("relevo.marks", 1)) {}

    /// Replaces all marks of a list of plugin.json.
    void set(const char* list, std::span<const Mark> marks) const {
        std::vector<relevo_mark> given;
        given.reserve(marks.size());
        for (const Mark& mark : marks) {
            relevo_mark& to = given.emplace_back();
            to.size = sizeof to;
            to.height_of = mark.height_of;
            to.lat_deg = mark.lat_deg;
            to.lon_deg = mark.lon_deg;
            to.height_m = mark.height_m;
            to.rank = mark.rank;
            to.symbol = mark.symbol;
            to.direction = mark.azimuth_deg ? RELEVO_ALONG_AZIMUTH : RELEVO_UPRIGHT;
            to.azimuth_deg = mark.azimuth_deg.value_or(0);
            to.text = mark.text.c_str();
        }
        check(table_.set(table_.self, list, given.data(), given.size()));
    }

  private:
    const relevo_marks_1& table_;
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

    static relevo_status fill(const relevo_host* host, relevo_module* module, const char* id) {
        if (!host || !module) return RELEVO_FAILED;
        return guarded(host, [&] {
            if (host->abi_version >> 16 != RELEVO_ABI_MAJOR || host->size < kHost ||
                module->size < kModule)
                throw Failure(
                    "this program has version " + std::to_string(host->abi_version >> 16) + "." +
                    std::to_string(host->abi_version & 0xffff) +
                    " of the plugin interface, and the module is built for " +
                    std::to_string(RELEVO_ABI_MAJOR) + "." + std::to_string(RELEVO_ABI_MINOR));
            module->id = id;
            module->create = &create;
            module->destroy = &destroy;
            module->prepare = &prepare;
        });
    }

  private:
    // Up to what is used here of structs that may have grown since.
    static constexpr std::size_t kHost = offsetof(relevo_host, fail) + sizeof(void*);
    static constexpr std::size_t kModule = offsetof(relevo_module, prepare) + sizeof(void*);
};

}  // namespace relevo::plugin

/// Exports a class that derives from Instance and is made of a `const Host&`.
#define RELEVO_PLUGIN(plugin_id, type)                                                            \
    extern "C" RELEVO_PLUGIN_EXPORT const std::uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;   \
    extern "C" RELEVO_PLUGIN_EXPORT relevo_status relevo_plugin_register(const relevo_host* host, \
                                                                         relevo_module* module) { \
        return relevo::plugin::Module<type>::fill(host, module, plugin_id);                       \
    }
