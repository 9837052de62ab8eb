#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/parallel_for.h"
#include "base/paths.h"
#include "cli/commands.h"
#include "cli/memory_use.h"
#include "cli/shared.h"
#include "dem/versions.h"
#include "effect/registry.h"
#include "film/film.h"
#include "gl/context.h"
#include "image/image.h"
#include "render/renderer.h"
#include "session/active_effects.h"

namespace relevo::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A device, and what came of opening it.
struct Tried {
    gl::Device device;
    std::optional<gl::DeviceInfo> info;  ///< it can draw
    std::string reason;                  ///< it cannot, why
};

Tried try_device(const gl::Device& device) {
    Tried tried{device, std::nullopt, {}};
    try {
        tried.info = gl::Context({.device = std::to_string(device.index)}).info();
        tried.device = tried.info->device;
    } catch (const Error& error) {
        // The message names each device that was tried, on a line of its own.
        const std::string text = error.what();
        const std::string line =
            fmt::format("{}: {} ({}) ", device.index, device.platform, device.description);
        const std::size_t at = text.find(line);
        tried.reason = at == std::string::npos ? text : text.substr(at + line.size());
        tried.reason = tried.reason.substr(0, tried.reason.find('\n'));
    }
    return tried;
}

/// What stands between this program and the machine's GPUs, as far as it can be seen, and what to
/// do about it.
std::vector<std::string> remedies(const std::vector<Tried>& devices,
                                  const std::optional<gl::DeviceInfo>& chosen) {
    std::vector<std::string> lines;
    std::error_code ignored;
    bool hardware_listed = false;
    bool hardware_draws = false;
    for (const Tried& tried : devices) {
        const bool hardware = tried.device.platform == "device" && !tried.device.software;
        hardware_listed = hardware_listed || hardware;
        hardware_draws = hardware_draws || (hardware && tried.info);
    }
    int nodes = 0;
    for (std::filesystem::directory_iterator node("/dev/dri", ignored), end;
         !ignored && node != end; node.increment(ignored)) {
        if (!node->path().filename().string().starts_with("renderD")) continue;
        ++nodes;
        if (access(node->path().c_str(), R_OK | W_OK) != 0)
            lines.push_back(
                fmt::format("{} may not be opened by this user: join its group "
                            "(usually render or video)",
                            node->path().string()));
    }
    const bool nvidia = std::filesystem::exists("/dev/nvidiactl", ignored);
    if (!hardware_listed && nvidia)
        lines.push_back(
            "an NVIDIA GPU is there, but EGL does not list it: install its driver's EGL library "
            "(libnvidia-gl, or in a container NVIDIA_DRIVER_CAPABILITIES=graphics)");
    else if (!hardware_listed && nodes == 0)
        lines.push_back(
            "no GPU is visible (/dev/dri has no render node): where the machine has one, install "
            "its driver, or let it into the container (--device /dev/dri, --gpus all)");
    for (const char* name : {"LIBGL_ALWAYS_SOFTWARE", "MESA_LOADER_DRIVER_OVERRIDE",
                             "GALLIUM_DRIVER", "__EGL_VENDOR_LIBRARY_FILENAMES", "EGL_PLATFORM"})
        if (const char* value = std::getenv(name); value && *value)
            lines.push_back(
                fmt::format("{}={} is set and takes part in the choice; unset it to "
                            "leave the choice to EGL",
                            name, value));
    if (!chosen)
        lines.push_back(
            "install Mesa's software renderer, which draws anywhere: libegl1, libegl-mesa0, "
            "libgl1-mesa-dri");
    if (devices.size() > 1)
        lines.push_back("--device N takes another by its index, --device nvidia by its name");
    if (chosen && hardware_draws && !chosen->device.software)
        lines.push_back("--device software draws with Mesa's software renderer");
    return lines;
}

std::string why(const std::string& wanted, const std::vector<Tried>& devices,
                const gl::DeviceInfo& chosen) {
    if (wanted != "auto") return fmt::format("--device {} asks for it", wanted);
    std::string text = chosen.device.index == 0
                           ? "the first that EGL lists, hardware before software"
                           : "the first that can draw, hardware before software";
    for (const Tried& tried : devices)
        if (tried.device.index < chosen.device.index && !tried.info)
            text += fmt::format("; {} {}", tried.device.index, tried.reason);
    return text;
}

struct Plugins {
    std::filesystem::path folder;
    std::vector<std::string> search_path;
    std::vector<std::string> ids;
    std::vector<std::string> broken;
};

Plugins find_plugins() {
    Plugins plugins{share_dir() / "plugins", {}, {}, {}};
    try {
        const effect::Registry registry = effect::Registry::load_installed();
        for (const std::filesystem::path& path : registry.search_paths())
            plugins.search_path.push_back(path.string());
        for (const effect::Effect& effect : registry.effects())
            plugins.ids.push_back(effect.id());
        for (const effect::BrokenEffect& effect : registry.broken())
            plugins.broken.push_back(effect.error);
    } catch (const Error& error) {
        plugins.broken.emplace_back(error.what());
    }
    return plugins;
}

Json to_json(const gl::Device& device) {
    return {{"index", device.index},
            {"platform", device.platform},
            {"description", device.description},
            {"software", device.software}};
}

Json to_json(const Tried& tried) {
    Json json = to_json(tried.device);
    json["can_draw"] = tried.info.has_value();
    json["renderer"] = tried.info ? Json(tried.info->renderer) : Json();
    json["vendor"] = tried.info ? Json(tried.info->vendor) : Json();
    json["version"] = tried.info ? Json(tried.info->version) : Json();
    json["reason"] = tried.info ? Json() : Json(tried.reason);
    return json;
}

/// What there is to tell.
struct Findings {
    std::string wanted;
    std::vector<Tried> devices;
    std::optional<gl::DeviceInfo> chosen;
    std::string error;  // why none is chosen
    Plugins plugins;
    std::vector<std::string> advice;
    bool has_share = false;
    std::optional<double> floor_mib;  ///< of memory

    bool software() const { return chosen && chosen->device.software; }
};

Findings examine(const std::string& wanted) {
    Findings found{.wanted = wanted};
    for (const gl::Device& device : gl::list_devices())
        found.devices.push_back(try_device(device));
    try {
        found.chosen = gl::Context({.device = wanted}).info();
    } catch (const Error& none) {
        found.error = none.what();
    }
    found.plugins = find_plugins();
    found.advice = remedies(found.devices, found.chosen);
    std::error_code ignored;
    found.has_share = std::filesystem::is_directory(share_dir() / "shaders", ignored);
    if (found.chosen) found.floor_mib = memory_floor_mib(wanted);
    return found;
}

Json to_json(const Findings& found) {
    Json json;
    json["version"] = RELEVO_VERSION;
    json["device"] = Json();
    if (const auto& chosen = found.chosen) {
        Json& device = json["device"] = to_json(chosen->device);
        device["renderer"] = chosen->renderer;
        device["vendor"] = chosen->vendor;
        device["version"] = chosen->version;
        device["software"] = found.software();
        device["why"] = why(found.wanted, found.devices, *chosen);
        device["limits"] = {{"texture_size_px", chosen->max_texture_size},
                            {"array_layers", chosen->max_array_layers},
                            {"texture_units", chosen->max_texture_units},
                            {"samples", chosen->max_samples},
                            {"anisotropy", chosen->max_anisotropy}};
    }
    json["devices"] = Json::array();
    for (const Tried& tried : found.devices)
        json["devices"].push_back(to_json(tried));
    json["threads"] = thread_count();
    json["floor_mib"] = found.floor_mib ? Json(std::round(*found.floor_mib)) : Json();
    json["gdal"] = dem::gdal_version();
    json["proj"] = dem::proj_version();
    json["pictures"] = image::installed_text();
    json["films"] = film::installed_text();
    json["share_dir"] = share_dir().string();
    json["share_found"] = found.has_share;
    json["plugin_folder"] = found.plugins.folder.string();
    json["plugin_search_path"] = found.plugins.search_path;
    json["plugins"] = found.plugins.ids;
    json["broken_plugins"] = found.plugins.broken;
    json["advice"] = found.advice;
    return json;
}

void print(const Findings& found) {
    const auto line = [](std::string_view name, const std::string& value) {
        fmt::print("{:<10} {}\n", name, value);
    };
    line("version", fmt::format("relevo {}, GDAL {}, PROJ {}", RELEVO_VERSION, dem::gdal_version(),
                                dem::proj_version()));
    if (const auto& chosen = found.chosen) {
        line("draws with", fmt::format("{}, {}{}", chosen->renderer, chosen->version,
                                       found.software() ? " (software, on the processor)" : ""));
        line("because", why(found.wanted, found.devices, *chosen));
        line("limits",
             fmt::format("textures of {} px, {} layers, {} units, {:g}x anisotropic filter",
                         chosen->max_texture_size, chosen->max_array_layers,
                         chosen->max_texture_units, chosen->max_anisotropy));
    } else {
        line("draws with", "nothing");
    }
    for (const Tried& tried : found.devices)
        line(fmt::format("device {}", tried.device.index),
             fmt::format("{} ({}): {}", tried.device.platform, tried.device.description,
                         tried.info
                             ? fmt::format("{}, {}", tried.info->renderer, tried.info->version)
                             : tried.reason));
    line("threads", std::to_string(thread_count()));
    if (found.floor_mib)
        line("memory", fmt::format("{:.0f} MiB for a picture of 2 x 2 posts; --memory, {} MiB by "
                                   "default, is on top of that",
                                   *found.floor_mib, MemoryBudget::kDefault_mib));
    line("pictures", image::installed_text());
    line("films", film::installed_text());
    line("data", fmt::format("{}{}", share_dir().string(),
                             found.has_share ? "" : " (not there; RELEVO_SHARE names another)"));
    line("plugins",
         fmt::format("{} in {}", found.plugins.ids.size(),
                     found.plugins.search_path.empty()
                         ? found.plugins.folder.string()
                         : fmt::format("{}", fmt::join(found.plugins.search_path, ", "))));
    for (const std::string& broken : found.plugins.broken)
        line("broken", broken);
    for (const std::string& text : found.advice)
        line("advice", text);
}

/// Prints the graph of frames with the effects that are on by default.
void print_graph(const std::string& device) {
    const auto effects = session::ActiveEffects::of({}, /*aloud=*/false);
    const gl::DeviceInfo info = gl::Context({.device = device}).info();
    const auto frames = render::stitch(effects->inputs(), info, {.radiance = false});
    fmt::print("{}", render::graph_text(frames));
}

void doctor(const std::string& wanted, bool as_json) {
    const Findings found = examine(wanted);
    if (as_json)
        fmt::print("{}", json_text(with_schema("relevo-doctor-1", to_json(found))));
    else
        print(found);
    if (!found.chosen) throw Error(ErrorCode::NoDevice, found.error);
}

}  // namespace

void add_doctor(Verb app) {
    struct Arguments {
        std::string device = "auto";
        bool json = false, graph = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    const Verb verb =
        app.add_verb("doctor", "Lists the GL devices and says which one draws, and why");
    verb.add_option("--device", arguments->device,
                    "GL device: auto, an index, software, or a part of its name");
    const Option json =
        verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.add_flag("--graph", arguments->graph,
                  "The passes and textures of a frame in Graphviz's language, instead")
        .excludes(json);
    verb.callback([arguments] {
        if (arguments->graph) return print_graph(arguments->device);
        doctor(arguments->device, arguments->json);
    });
}

}  // namespace relevo::cli
