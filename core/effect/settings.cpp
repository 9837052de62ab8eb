#include <filesystem>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "effect/selection.h"
#include "effect/weather_preset.h"

namespace relevo::effect {
namespace {

/// The value to set. A relative path is relative to the folder of the file that sets it.
std::string text_of(const Setting& setting, const shader::ParamStore& store) {
    const shader::TextParam* const text = store.find_text(setting.address);
    if (!text || !text->is_file || setting.text.empty()) return setting.text;
    return (std::filesystem::path(setting.folder) / setting.text).string();
}

std::string plugin_of(const std::string& address) {
    return address.substr(0, address.find('.'));
}

/// Whether the weather of the scene sets one of the parameters that must rise.
bool is_of_weather(const std::vector<Preset>& presets, const Rising& rising) {
    for (const Preset& preset : presets)
        if (preset.name == kWeatherPreset)
            for (const Setting& setting : preset.settings)
                if (contains(rising.addresses, setting.address)) return true;
    return false;
}

}  // namespace

std::vector<std::string> apply_settings(shader::ParamStore& store, const Registry& registry,
                                        const Selection& selection,
                                        const std::vector<Preset>& presets,
                                        const std::vector<Setting>& command_line) {
    std::vector<std::string> notices;
    for (const Preset& preset : presets) {
        for (const Setting& setting : preset.settings) {
            const std::string plugin = plugin_of(setting.address);
            const std::string place = fmt::format("{}:{}", preset.file, setting.line);
            const bool known = store.find(setting.address) || store.find_text(setting.address);
            if (!known && !registry.find(plugin)) {
                notices.push_back(fmt::format("{}: {} is skipped, there is no plugin {}", place,
                                              setting.address, plugin));
                continue;
            }
            try {
                store.set(setting.address, text_of(setting, store));
            } catch (const Error& error) {
                const std::string_view what = error.what();
                throw Error(error.code(), fmt::format("effects: {}: {}", place,
                                                      what.substr(what.find(": ") + 2)));
            }
        }
    }
    for (const Setting& setting : command_line) {
        store.set(setting.address, text_of(setting, store));
        const std::string plugin = plugin_of(setting.address);
        if (registry.find(plugin) && !selection.has(plugin))
            notices.push_back(fmt::format("{} is set, but {} is off; --enable {} switches it on",
                                          setting.address, plugin, plugin));
    }
    for (const Effect* effect : selection.effects)
        for (const Rising& rising : effect->manifest.rising)
            if (const std::string fault = fault_of(rising, store); !fault.empty())
                bad_input(fmt::format("effects: {}{}", fault,
                                      is_of_weather(presets, rising)
                                          ? "; the weather sets some of them, --set all"
                                          : ""));
    return notices;
}

std::vector<Setting> with_absolute_files(std::vector<Setting> settings,
                                         const shader::ParamStore& store) {
    for (Setting& setting : settings) {
        const shader::TextParam* const text = store.find_text(setting.address);
        if (!text || !text->is_file || setting.text.empty()) continue;
        setting.text = std::filesystem::absolute(text_of(setting, store)).string();
        setting.folder.clear();
    }
    return settings;
}

}  // namespace relevo::effect
