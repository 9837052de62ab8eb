#include "cli/day_verb.h"

#include <optional>

#include "base/error.h"

namespace relevo::cli {

void DayArguments::add_to(Verb verb, const std::vector<std::string>& endings) {
    terrain.add_to(verb);
    verb.option("DEM").required(false);
    place.add_to(verb);
    points.add_to(verb);
    days.add_to(verb);
    light.add_to(verb);
    light.add_dip_to(verb);
    output.add_to(verb, endings);
}

void run_days(const DayArguments& arguments, const DayFigure& figure) {
    FilesInUse files;
    const OpenResults results = arguments.output.open(files, arguments.terrain.dem);
    std::optional<dem::Posts> posts;
    const auto load = [&]() -> const dem::Posts* {
        if (arguments.terrain.given()) posts.emplace(arguments.terrain.load());
        return posts ? &*posts : nullptr;
    };
    if (arguments.points.given()) {
        arguments.days.parse({}, false);  // what is wrong with them is said before any work
        const auto points = arguments.points.read(files, arguments.output);
        const dem::Posts* const ground = load();
        const auto forms = [&](const dem::NamedPlace& point) {
            return figure.forms(arguments.days.parse(point.at.place, false), point.at, ground)
                .point;
        };
        return deliver_points(
            arguments.points, points, {figure.columns(ground != nullptr), figure.remarks, forms},
            arguments.output, results, sun::is_zone_by_place(arguments.days.zone));
    }
    const geo::PlaceText at = arguments.place.parse();
    const report::Days asked = arguments.days.parse(at.place);
    const DayForms forms = figure.forms(asked, at, load());
    report::warn_of(forms.point.doubt);
    arguments.output.deliver({.drawing = forms.drawing,
                              .csv = forms.csv,
                              .json = forms.point.json,
                              .print = forms.print},
                             results);
}

}  // namespace relevo::cli
