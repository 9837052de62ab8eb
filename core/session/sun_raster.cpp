#include "session/sun_raster.h"

#include <memory>
#include <utility>

#include "figure/about.h"
#include "figure/hours.h"
#include "figure/hours_bands.h"
#include "figure/shadow.h"
#include "figure/sky_view.h"

namespace relevo::session {
namespace {

using figure::Figure;

std::unique_ptr<Figure> hours_of(const SunRasterWanted& wanted) {
    auto hours = std::make_unique<figure::Hours>();
    hours->time = {wanted.begin, wanted.end};
    hours->zone = wanted.zone;
    hours->words = {std::string(hours_word(wanted.figure))};
    hours->refraction = wanted.refraction;
    return hours;
}

std::unique_ptr<Figure> figure_of(const dem::Posts& posts, const SunRasterWanted& wanted) {
    if (wanted.figure == SunFigure::SkyView) return std::make_unique<figure::SkyView>();
    if (is_of_period(wanted.figure)) return hours_of(wanted);
    auto shadow = std::make_unique<figure::Shadow>();
    shadow->suns = {figure::sun_over_middle(posts, wanted.begin, wanted.refraction)};
    shadow->refraction = wanted.refraction;
    return shadow;
}

dem::Window all_of(const dem::Posts& posts) {
    return {0, 0, posts.grid().columns(), posts.grid().rows()};
}

}  // namespace

bool is_of_period(SunFigure figure) {
    return figure < SunFigure::Shadow;
}

std::string_view hours_word(SunFigure figure) {
    switch (figure) {
        case SunFigure::FirstLight:
            return "first";
        case SunFigure::LastLight:
            return "last";
        case SunFigure::Irradiation:
            return "global";
        default:
            return "hours";
    }
}

output::RasterBand band_of(SunFigure figure) {
    if (is_of_period(figure)) return figure::hours_band(hours_word(figure));
    return figure == SunFigure::Shadow ? figure::shadow_band(false) : figure::sky_view_band();
}

std::optional<OverlayTime> time_of(const dem::Posts& posts, const SunRasterWanted& wanted) {
    const output::RasterMetadata about = figure_of(posts, wanted)->metadata(posts);
    return overlay_time({about.begin(), about.end()});
}

bool same_figures(const SunRasterWanted& a, const SunRasterWanted& b) {
    if (a.figure != b.figure) return false;
    if (a.figure == SunFigure::SkyView) return true;
    return a.begin == b.begin && a.refraction == b.refraction &&
           (a.figure == SunFigure::Shadow || (a.end == b.end && a.zone.name() == b.zone.name()));
}

SunRasterMaker sun_raster_maker(const dem::Posts& posts, const SunRasterWanted& wanted,
                                const dem::Window& window,
                                const std::function<void(double)>& done) {
    const std::shared_ptr<const Figure> figure = figure_of(posts, wanted);
    const auto values = std::make_shared<Array2d<float>>();
    const figure::PartMaker make =
        figure->maker({.posts = posts,
                       .window = window,
                       .middle = posts.grid().center(),
                       .put = [values](std::size_t, const dem::Window&,
                                       Array2d<float> made) { *values = std::move(made); },
                       .done = done});
    return [figure, values, make](const dem::Window& part) {
        figure::PartMade made = make(part);
        return SunRaster{std::move(*values), made.holes, std::move(made.definition)};
    };
}

SunRaster sun_raster(const dem::Posts& posts, const SunRasterWanted& wanted,
                     const dem::Window& part, const std::function<void(double)>& done) {
    return sun_raster_maker(posts, wanted, part, done)(part);
}

void write_sun_raster(OutputFile& file, const dem::Posts& posts, const SunRasterWanted& wanted,
                      const SunRaster* whole, std::int64_t most, const std::string& version,
                      const std::function<void(double)>& done) {
    const std::unique_ptr<const Figure> figure = figure_of(posts, wanted);
    output::RasterWriter writer(file, posts.grid(), figure->type(), figure->bands());
    const auto put = [&](std::size_t band, const dem::Window& part, const Array2d<float>& values) {
        if (figure->type() == output::RasterType::Byte)
            writer.put(band, part.column, part.row, figure::mask_of(values));
        else
            writer.put(band, part.column, part.row, values);
    };
    const dem::Window all = all_of(posts);
    figure::PartMade sum;
    if (whole) {
        put(0, all, whole->values);
        sum = {whole->holes, whole->definition};
    } else {
        double share = 1;
        const figure::PartMaker make = figure->maker({.posts = posts,
                                                      .window = all,
                                                      .middle = posts.grid().center(),
                                                      .put = put,
                                                      .done = [&](double of_part) {
                                                          if (done) done(share * of_part);
                                                      }});
        for (const dem::Window& part :
             posts.in_memory() ? std::vector{all} : figure::raster_parts(all, most)) {
            share = double{1} * part.columns * part.rows / all.columns / all.rows;
            figure::PartMade made = make(part);
            sum = {sum.holes + made.holes, std::move(made.definition)};
        }
    }
    output::RasterMetadata about = figure::metadata_of(*figure, posts, version, sum, all);
    for (auto& item : figure->metadata(posts))
        about.push_back(std::move(item));
    if (const auto beyond = figure->beyond(posts, all))
        about.emplace_back("BEYOND_DEM", beyond->text(figure->would()));
    writer.finish(about);
}

}  // namespace relevo::session
