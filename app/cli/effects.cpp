#include "cli/effects.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "effect/preset.h"

namespace relevo::cli {

bool is_setting(std::string_view word) {
    const std::string_view address = word.substr(0, word.find('='));
    const std::size_t dot = address.find('.');
    const auto is_name = [](std::string_view text) {
        return !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
                                    std::string_view::npos;
    };
    return address.size() < word.size() && dot != std::string_view::npos &&
           is_name(address.substr(0, dot)) && is_name(address.substr(dot + 1));
}

void EffectArguments::check_files(const std::vector<std::string>& files) const {
    if (settings.empty()) return;
    for (const std::string& file : files) {
        std::error_code ignored;
        if (is_setting(file) && !std::filesystem::exists(file, ignored))
            bad_usage(fmt::format("--set: {}: --set takes one value; write --set {} --set {}", file,
                                  settings.back(), file));
    }
}

void EffectArguments::add_to(Verb verb) {
    only_option =
        verb.add_option("--only", only, "Only these effects and what they require (empty: none)")
            .delimiter(',')
            .any_number()
            .group("Effects");
    verb.add_option("--enable", enable, "Effects to switch on").delimiter(',').group("Effects");
    verb.add_option("--disable", disable, "Effects to switch off").delimiter(',').group("Effects");
    verb.add_option(
            "--order", order,
            "Order of effects on the ground, the lowest first; overlay is that of --overlay: "
            "contours,overlay,tracks")
        .delimiter(',')
        .group("Effects");
    verb.add_option("--set", settings, "Value of a parameter: layering.texture_m=8")
        .one_word()
        .group("Effects");
    verb.add_option("--preset", presets, "Preset of switches and values, by name or path: paper")
        .one_word()
        .group("Effects");
    verb.add_option("--plugin-path", plugin_path, "Folder with more plugins")
        .one_word()
        .group("Effects");
}

void EffectArguments::apply_to(scene::Effects& effects) const {
    scene::Effects change;
    if (only_option.count() > 0) {
        change.switches.only.emplace();
        for (const std::string& id : only)
            if (!id.empty()) change.switches.only->push_back(id);
    }
    change.switches.enable = enable;
    change.switches.disable = disable;
    change.switches.order = order;
    change.presets = presets;
    for (const std::string& setting : settings)
        change.settings.push_back(effect::parse_setting(setting));
    change.plugin_path = plugin_path;
    effects = scene::merge(std::move(effects), change);
}

}  // namespace relevo::cli
