#include "cli/exaggeration_argument.h"

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "scene/exaggeration.h"
#include "scene/options.h"

namespace relevo::cli {
namespace {

constexpr std::string_view kAuto = "auto";

}  // namespace

void ExaggerationArgument::add_to(Verb verb) {
    const scene::Option& option = scene::option("--exaggerate");
    verb.add_option("--exaggerate", text,
                    "Vertical exaggeration; auto: chosen by the DEM, if no view, time, overlay or "
                    "effect is given, else 1 (auto)")
        .group(std::string(option.group))
        .type_name("FLOAT")
        .check({[&option](const std::string& word) {
                    return word == kAuto ? std::string()
                                         : scene::fault_of(option, scene::value_of(option, word));
                },
                fmt::format("auto or {} to {}", option.min, option.max)});
}

void ExaggerationArgument::apply_to(scene::Scene& scene, bool is_described) const {
    if (text.empty() && is_described) return;
    const bool is_auto = text.empty() || text == kAuto;
    scene.exaggeration = is_auto ? 1 : *parse_number(text);
    scene.chooses_exaggeration = is_auto && scene::may_exaggerate(scene);
    if (text == kAuto && !scene.chooses_exaggeration)
        log::info("--exaggerate auto: 1, because a view, a time, an overlay or an effect is given");
}

}  // namespace relevo::cli
