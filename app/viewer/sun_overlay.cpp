#include "viewer/sun_overlay.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/files_in_use.h"
#include "dem/files_of.h"
#include "figure/horizons.h"
#include "figure/hours.h"
#include "figure/shadow.h"
#include "viewer/export.h"
#include "viewer/sun_model.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// Number of posts of the first result, and limit for DEMs that are in memory only as means.
constexpr double kCoarsePosts = 160e3, kMostPosts = 4e6;
/// Least interval of waking the window for progress.
constexpr auto kProgressInterval = std::chrono::milliseconds(80);

/// Thrown to cancel a computation.
struct OverlayCancelled {};

/// A DEM resampled to fewer posts, with the outer rows and columns in place.
dem::Heightfield thinned(const dem::Heightfield& field, double most) {
    const double posts = double{1} * field.grid.columns() * field.grid.rows();
    const double step = std::max(1.0, std::sqrt(posts / most));
    const auto fewer = [&](int count) {
        return std::clamp(static_cast<int>(std::lround((count - 1) / step)) + 1, 2, count);
    };
    const int columns = fewer(field.grid.columns()), rows = fewer(field.grid.rows());
    const double across = (field.grid.columns() - 1.0) / (columns - 1);
    const double down = (field.grid.rows() - 1.0) / (rows - 1);
    dem::Affine affine = field.grid.affine();
    affine.x_column *= across;
    affine.y_column *= across;
    affine.x_row *= down;
    affine.y_row *= down;
    Array2d<float> height_m(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            height_m.at(column, row) = static_cast<float>(
                field.height_at(std::min(column * across, field.grid.columns() - 1.0),
                                std::min(row * down, field.grid.rows() - 1.0)));
    dem::Heightfield few{
        std::move(height_m), {columns, rows, affine, field.grid.crs()}, field.about, 1};
    few.about.statistics = dem::statistics(few.height_m);
    return few;
}

}  // namespace

/// Computes values for a DEM, first at fewer posts.
class OverlayWork::Levels {
  public:
    explicit Levels(std::shared_ptr<const session::LoadedDem> dem) : dem_(std::move(dem)) {
        const dem::Heightfield& field = dem_->field;
        const double posts = double{1} * field.grid.columns() * field.grid.rows();
        if (posts > 2 * kCoarsePosts) add(thinned(field, kCoarsePosts));
        if (field.reduction == 1)
            levels_.push_back({nullptr, dem::Posts(field), 1});
        else
            add(thinned(field, kMostPosts));
    }

    struct Level {
        std::unique_ptr<const dem::Heightfield> field;  // null: the DEM's own
        dem::Posts posts;
        double every;
    };
    const std::vector<Level>& all() const { return levels_; }
    const session::LoadedDem* dem() const { return dem_.get(); }

  private:
    void add(dem::Heightfield few) {
        const double every = static_cast<double>(dem_->field.reduction) *
                             (dem_->field.grid.columns() - 1.0) / (few.grid.columns() - 1.0);
        auto field = std::make_unique<const dem::Heightfield>(std::move(few));
        dem::Posts posts(*field);
        levels_.push_back({std::move(field), std::move(posts), every});
    }

    std::shared_ptr<const session::LoadedDem> dem_;
    std::vector<Level> levels_;
};

namespace {

/// First and last day of a choice.
std::pair<sun::Date, sun::Date> days_of(const OverlayChoice& choice, const sun::Date& shown) {
    if (!choice.has_period() || choice.period == OverlayPeriod::Day) return {shown, shown};
    if (choice.period == OverlayPeriod::Year) return {{shown.year, 1, 1}, {shown.year, 12, 31}};
    if (choice.period == OverlayPeriod::Range)
        return {choice.first,
                sun::days_between(choice.first, choice.last) < 0 ? choice.first : choice.last};
    // Weeks begin on Monday, like 1 January 1900.
    const sun::Date monday =
        sun::add_days(shown, -((sun::days_between({1900, 1, 1}, shown) % 7 + 7) % 7));
    return {monday, sun::add_days(monday, 6)};
}

/// "21 Dec 2026", "21 Dec to 27 Dec 2026", "2026".
std::string words_of(const sun::Date& first, const sun::Date& last) {
    if (first == last) return fmt::format("{} {}", english_day(first), first.year);
    const bool one_year = first.year == last.year;
    if (one_year && first == sun::Date{first.year, 1, 1} && last == sun::Date{last.year, 12, 31})
        return std::to_string(first.year);
    return fmt::format("{}{} to {} {}", english_day(first),
                       one_year ? "" : fmt::format(" {}", first.year), english_day(last),
                       last.year);
}

}  // namespace

const OverlayFigure& overlay_figure(OverlayKind kind) {
    static constexpr OverlayFigure kFigures[] = {
        {tr_later("no overlay"), "", "", ""},
        {tr_later("from the scene"), "", "", ""},
        {tr_later("sun hours"), "Sun hours", "sun hours", "hours"},
        {tr_later("first light of the day"), "First light", "sun hours --bands first", "first"},
        {tr_later("last light of the day"), "Last light", "sun hours --bands last", "last"},
        {tr_later("irradiation"), "Irradiation", "sun hours --bands global", "global"},
        {tr_later("direct sun at this time"), "Direct sun", "sun shadow", ""},
        {tr_later("sky view"), "Sky-view factor", "sun sky-view", ""},
    };
    return kFigures[static_cast<std::size_t>(kind)];
}

std::unique_ptr<const figure::Figure> FigureWanted::of(const dem::Posts& posts) const {
    if (kind == OverlayKind::SkyView) return std::make_unique<figure::SkyView>();
    if (kind == OverlayKind::Mask) {
        auto shadow = std::make_unique<figure::Shadow>();
        shadow->suns = {figure::sun_over_middle(posts, time.begin, refraction)};
        shadow->refraction = refraction;
        return shadow;
    }
    auto hours = std::make_unique<figure::Hours>();
    hours->time = time;
    hours->zone = zone;
    hours->words = {overlay_figure(kind).band};
    hours->refraction = refraction;
    return hours;
}

FigureWanted figure_of(const OverlayChoice& choice, sun::Instant utc, const sun::Zone& zone,
                       const std::string& refraction) {
    if (choice.kind == OverlayKind::SkyView) return {.kind = choice.kind};
    FigureWanted figure{choice.kind, {utc, utc}, zone, refraction};
    if (choice.kind == OverlayKind::Mask) return figure;
    const auto [first, last] = days_of(choice, zone.local(utc).wall.date);
    figure.time = {zone.day(first).begin, zone.day(last).end};
    return figure;
}

std::string title_of(const FigureWanted& figure) {
    const std::string what = overlay_figure(figure.kind).title;
    if (figure.kind == OverlayKind::SkyView) return what;
    const sun::CivilTime from = figure.zone.local(figure.time.begin).wall;
    if (figure.kind == OverlayKind::Mask)
        return fmt::format("{}, {}, {:02}:{:02}", what, words_of(from.date, from.date), from.hour,
                           from.minute);
    constexpr double kWithin_s = 1;  // the end is the midnight after the last day
    const sun::Date last = figure.zone.local(figure.time.end + -kWithin_s).wall.date;
    return fmt::format("{}, {}", what, words_of(from.date, last));
}

bool same_figures(const OverlayWanted& a, const OverlayWanted& b) {
    if (a.dem != b.dem || a.file.has_value() != b.file.has_value()) return false;
    if (a.file)
        return a.file->file == b.file->file && a.file->band == b.file->band &&
               a.file->colours == b.file->colours && a.file->range == b.file->range &&
               a.file->lit == b.file->lit;
    const FigureWanted &x = a.figure, &y = b.figure;
    return x.kind == y.kind && x.time.begin == y.time.begin && x.time.end == y.time.end &&
           x.refraction == y.refraction &&
           (x.kind == OverlayKind::Mask || x.zone.name() == y.zone.name());
}

double OverlayShown::value_at(const geo::Geodetic& place) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (!raster || !grid) return kNone;
    const glm::dvec2 post = grid->post(place);
    const double column = std::round(post.x), row = std::round(post.y);
    if (!(column >= 0 && row >= 0 && column < grid->columns() && row < grid->rows())) return kNone;
    return raster->values.at(static_cast<int>(column), static_cast<int>(row));
}

// The first result is quick and may be displayed while later ones of the same DEM are computed.
OverlayWork::OverlayWork(std::function<void()> on_change)
    : LatestWork(std::move(on_change), [](const OverlayWanted& of, const OverlayWanted& now) {
          return of.dem == now.dem;
      }) {}

OverlayWork::~OverlayWork() {
    end();
}

void OverlayWork::publish(OverlayShown shown, bool done) {
    last_ = std::make_shared<const OverlayShown>(std::move(shown));
    LatestWork::publish(last_, done);
}

namespace {

void colour(OverlayShown& shown) {
    const Array2d<float>& values = shown.raster->values;
    const output::RasterBand& band = shown.band;
    chart::Legend legend{title_of(shown.of.figure), band.unit,
                         session::usual_ramp(values, band.name, band.unit)};
    const std::optional<session::OverlayTime> time = shown.overlay.time;
    if (time) session::show_as_clock(*time, legend);
    shown.overlay = session::overlay_of(values, std::move(legend), shown.of.opacity, shown.of.lit);
    shown.overlay.time = time;
    shown.overlay.has_given_title = true;
}

}  // namespace

void OverlayWork::work_out(const OverlayWanted* wanted) {
    progress_ = 0;
    if (!wanted) {
        levels_.reset();  // also frees data of a DEM that may be closed
        last_.reset();
        return;
    }
    const OverlayWanted& now = *wanted;
    OverlayShown shown;
    shown.of = now;
    try {
        if (now.file) {
            shown.overlay = session::read_overlay(*now.file, now.dem->to_draw().grid);
            publish(std::move(shown), true);
        } else if (last_ && last_->error.empty() && same_figures(last_->of, now) && is_final()) {
            shown.raster = last_->raster;
            shown.grid = last_->grid;
            shown.every = last_->every;
            shown.band = last_->band;
            shown.overlay.time = last_->overlay.time;
            colour(shown);
            publish(std::move(shown), true);
        } else {
            measure(now);
        }
    } catch (const OverlayCancelled&) {
        return;
    } catch (const std::exception& error) {
        shown.error = error.what();
        publish(std::move(shown), true);
    }
}

bool OverlayWork::is_final() const {
    return levels_ && levels_->dem() == last_->of.dem.get() &&
           last_->every == levels_->all().back().every;
}

void OverlayWork::measure(const OverlayWanted& now) {
    if (!levels_ || levels_->dem() != now.dem.get()) levels_ = std::make_unique<Levels>(now.dem);
    constexpr double kLong_s = 2 * 86400;
    const bool is_long = now.figure.time.length_s() > kLong_s;
    for (const Levels::Level& level : levels_->all()) {
        const bool is_last = &level == &levels_->all().back();
        const auto is_cancelled = [&] {
            return is_last || is_long ? is_given_up() : is_of_no_use(now);
        };
        double share = 0;
        OverlayShown shown;
        shown.of = now;
        const std::unique_ptr<const figure::Figure> figure = now.figure.of(level.posts);
        shown.raster = std::make_shared<const figure::Raster>(
            figure::raster_of(*figure, level.posts, [&](double more) {
                share += more;
                if (is_cancelled()) throw OverlayCancelled();
                if (is_last) tell(share);
            }));
        if (is_cancelled()) return;
        shown.grid = level.posts.grid();
        shown.every = level.every;
        shown.band = figure->bands().front();
        const output::RasterMetadata about = figure->metadata(level.posts);
        shown.overlay.time = session::overlay_time({about.begin(), about.end()});
        colour(shown);
        publish(std::move(shown), is_last);
        if (is_given_up()) return;
    }
}

void OverlayWork::tell(double share) {
    progress_ = share;
    const auto now = std::chrono::steady_clock::now();
    if (now - reported_at_ < kProgressInterval) return;
    reported_at_ = now;
    tell_of_change();
}

OverlaySave::OverlaySave(OverlayWanted wanted, std::shared_ptr<const figure::Raster> whole,
                         std::function<void()> on_change, std::string path, bool overwrite)
    : wanted_(std::move(wanted)),
      on_change_(std::move(on_change)),
      path_(std::move(path)),
      overwrite_(overwrite) {
    thread_ = std::thread([this, whole = std::move(whole)] { run(whole.get()); });
}

OverlaySave::~OverlaySave() {
    is_cancelled_ = true;
    thread_.join();
}

std::string OverlaySave::result() const {
    if (failure_) std::rethrow_exception(failure_);
    return name_;
}

void OverlaySave::run(const figure::Raster* whole) {
    try {
        const dem::Posts posts = wanted_.dem->field.reduction == 1
                                     ? dem::Posts(wanted_.dem->field)
                                     : dem::Posts::load(wanted_.dems, wanted_.options);
        const auto write = [&](OutputFile& file) {
            double share = 0;
            figure::write_raster(file, *wanted_.figure.of(posts), posts, wanted_.options.memory,
                                 RELEVO_VERSION, whole, [&](double more) { tell(share += more); });
        };
        if (path_.empty()) {
            name_ = write_under_free_name("tif", write);
        } else {
            FilesInUse files;
            dem::add_named(wanted_.dems, files);
            OutputFile& file = files.open_output(path_, overwrite_, "export");
            dem::add_all(wanted_.dems, files);
            write(file);
            name_ = path_;
        }
    } catch (const OverlayCancelled&) {
        return;
    } catch (...) {
        failure_ = std::current_exception();
    }
    is_done_ = true;
    on_change_();
}

void OverlaySave::tell(double share) {
    if (is_cancelled_) throw OverlayCancelled();
    const bool is_worth_it = share - progress_ > 0.01;
    if (!is_worth_it) return;
    progress_ = share;
    on_change_();
}

}  // namespace relevo::viewer
