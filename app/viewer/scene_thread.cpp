#include "viewer/scene_thread.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <future>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/log.h"
#include "gl/texture.h"
#include "session/active_effects.h"
#include "viewer/frame_exchange.h"
#include "viewer/navigation.h"
#include "viewer/picture_queue.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

using Clock = std::chrono::steady_clock;

/// Target duration of a frame while the user moves the camera [ms].
constexpr double kSoon_ms = 30;
/// Fractions of the window's sides to draw at while moving. The largest that meets kSoon_ms is
/// used.
constexpr std::array<double, 5> kScales = {1, 0.8, 0.65, 0.5, 0.34};
constexpr double kLeastScale = 0.5, kLeastScaleOfSun = 0.34;
/// For this long a frame of a preview stays visible while the complete DEM's tile pages are made;
/// until then, new frames would be coarser.
constexpr auto kNewPages = std::chrono::seconds(2);
/// Interval between frames with more tile pages when nothing moves.
constexpr auto kMorePages = std::chrono::milliseconds(400);
constexpr auto kLookAgain = std::chrono::milliseconds(10);
/// Interval between frames of effects that move.
constexpr auto kMoves = std::chrono::milliseconds(50);
/// Greatest age of shadows while the sun is dragged.
constexpr auto kShadowsAge = std::chrono::milliseconds(350);

double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

std::string text_of(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error) ||
        dynamic_cast<const std::length_error*>(&error))
        return tr("out of memory; use a smaller window, a smaller --memory or fewer effects");
    return error.what();
}

}  // namespace

scene::Camera Opened::camera(const scene::View& view, double aspect,
                             const scene::Insets& insets) const {
    return scene::make_camera(view, aim_m, ground.frame, outline, aspect, scene.exaggeration,
                              insets);
}

struct SceneThread::Impl {
    Impl(scene::Scene given, const SceneDevice& on) : scene(std::move(given)), device(on) {}

    const scene::Scene scene;  // as given; read on two threads
    SceneDevice device;
    std::shared_ptr<const session::LoadedDem> dem;
    std::function<void()> on_change;

    mutable std::mutex mutex;
    std::condition_variable changed;
    Wanted wanted;
    bool has_new_wants = false, ends = false, rests = false;
    PictureQueue pictures;
    std::optional<std::string> message;
    std::exception_ptr failure;
    std::shared_ptr<const Opened> opened;
    std::shared_ptr<const session::LoadedDem> all_posts;  // not taken yet
    std::uint64_t wants = 0;

    // Used only on the thread.
    scene::Effects asked_effects;  // of the last request
    scene::Effects effects;        // of the last request whose effects could be drawn
    int effects_read = 0;          // as in Wanted
    bool reads_all_posts = false;  // the complete DEM replaces a preview
    bool awaits_pages = false;     // a frame without motion lacks tile pages
    bool moves = false;            // effects move without requests
    std::unique_ptr<session::Session> session;
    std::optional<FrameExchange> exchange;  // if frames are shared with the window
    std::uint64_t published = 0;
    glm::dvec3 shadows_eye_m{0};
    double ms_a_pixel = 0;
    Clock::time_point opened_at = Clock::now();  // when effects that move began
    Clock::time_point frame_began;               // start of the last published frame
    double frame_px = 0;                         // its pixels, until the device has finished it
    Clock::time_point shadows_at;
    bool shadows_lag = false;
    std::optional<Clock::time_point> new_pages_at;  // set while the complete DEM lacks tile pages
    std::future<void> reading;                      // destroyed before what it writes to

    std::thread thread;

    /// Changes the request and wakes the thread.
    template <typename Change>
    void change(const Change& change) {
        {
            const std::lock_guard lock(mutex);
            change(*this);
            ++wants;
        }
        changed.notify_one();
    }

    void run() {
        try {
            session::Options options;
            options.context = [this] {
                auto [context, shares] = device.open();
                if (shares) exchange.emplace();
                log::debug(shares ? "view: frames stay on the device"
                                  : "view: frames are copied to the window's device");
                return std::move(context);
            };
            options.allow_preview = true;
            options.allow_unmet = true;  // the panel shows what an effect lacks
            reads_all_posts = !dem;
            options.dem = std::move(dem);
            FilesInUse files;
            session = std::make_unique<session::Session>(scene, options, files);
            // The view of the whole DEM depends on the window's size.
            const Wanted first = first_wanted();
            asked_effects = effects = scene.effects;
            effects_read = first.effects_read;
            scene::Scene sized = scene_now();
            sized.width_px = first.width_px;
            sized.height_px = first.height_px;
            session->show(sized, session->time(), {.exact = false});
            publish_opened(first.insets);
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
        on_change();
        if (!failure) draw_until_end();
        // Shared frames must be destroyed in a context.
        pictures.clear();
        exchange.reset();
        session.reset();
    }

    Wanted first_wanted() {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return ends || has_new_wants; });
        return wanted;
    }

    /// Holds the lock only for the hand-over, so that the window does not wait.
    void publish_opened(const scene::Insets& insets) {
        auto anew = std::make_shared<Opened>(
            Opened{session->dem(), session->ground(), session->scene(), session->outline(),
                   session->heights_to_aim_at(), session->time(), session->overlay_legend()});
        // An aerial view keeps its sky once it is turned, and is an eye like any other.
        scene::Scene& now = anew->scene;
        if (scene::backdrop_of(now.backdrop, now.view) == scene::Backdrop::Horizon)
            now.backdrop = scene::Backdrop::Horizon;
        look_at_whole(*anew, insets);
        const std::lock_guard lock(mutex);
        opened = std::move(anew);
    }

    /// Looks at the whole scene until the window requests a view.
    void look_at_whole(const Opened& of, const scene::Insets& insets) {
        scene::Scene whole = of.scene;
        if (whole.view.eye) return;
        const double aspect = static_cast<double>(whole.width_px) / whole.height_px;
        const Land land{&of.ground.frame, whole.exaggeration, {}, {}};
        whole.view = view_of(pose_of(of.camera(whole.view, aspect, insets), land), land);
        whole.effects = effects;
        session->show(whole, session->time(), {.exact = false, .keep_above_m = kClearance_m});
    }

    /// The drawn scene. Its effects are written as the window wrote them, not as the session does.
    scene::Scene scene_now() const {
        scene::Scene now = session->scene();
        now.effects = effects;
        return now;
    }

    /// Reads the complete DEM in the background, after the first frame of a preview.
    void read_all_posts() {
        if (!reads_all_posts || reading.valid() || !session->dem()->is_preview) return;
        reading = std::async(std::launch::async, [this, source = session->dem()->source] {
            std::shared_ptr<const session::LoadedDem> read;
            std::exception_ptr error;
            try {
                read = session::load_dem(source, scene);
            } catch (...) {
                error = std::current_exception();
            }
            {
                const std::lock_guard lock(mutex);
                all_posts = std::move(read);
                if (error) failure = error;
            }
            changed.notify_one();
            if (error) on_change();
        });
    }

    void take(std::shared_ptr<const session::LoadedDem> posts, const scene::Insets& insets) {
        session->take(std::move(posts), scene);
        new_pages_at = Clock::now();
        publish_opened(insets);
    }

    /// Waits until there is something to draw. @param sharp  nothing is left to do for the request
    void wait_for_requests(std::unique_lock<std::mutex>& lock, bool sharp) {
        const auto is_asked = [&] { return ends || has_new_wants || all_posts; };
        // Drawing sooner would slow down the tile pages that it waits for.
        const auto drawn_at = Clock::now();
        while (awaits_pages && !is_asked() && session->is_loading() &&
               Clock::now() - drawn_at < kMorePages)
            changed.wait_for(lock, kLookAgain, is_asked);
        if (!awaits_pages && sharp) {
            rests = !is_asked();
            if (moves)
                changed.wait_until(lock, frame_began + kMoves, is_asked);
            else
                changed.wait(lock, is_asked);
        }
        rests = false;
    }

    void draw_until_end() {
        bool sharp = false;
        std::unique_lock lock(mutex);
        while (!ends) {
            wait_for_requests(lock, sharp);
            if (ends) return;
            const Wanted now = wanted;
            auto new_posts = std::exchange(all_posts, nullptr);
            const std::uint64_t answers = wants;
            has_new_wants = false;
            lock.unlock();
            if (new_posts) {
                try {
                    take(std::move(new_posts), now.insets);
                } catch (...) {
                    fail();
                    return;
                }
            }
            // After a failure the last frame stays until the next request.
            try {
                awaits_pages = false;
                if (!attempt([&] { sharp = draw(now, answers); })) {
                    sharp = true;
                    awaits_pages = moves = false;
                }
                // Limits the queue of the device.
                const std::size_t unfinished = sharp || awaits_pages || !exchange ? 0 : 1;
                pictures.finish(unfinished, [this] { return has_ended(); });
            } catch (const gl::DeviceLost&) {
                fail();
                return;
            }
            if (frame_px > 0) ms_a_pixel = milliseconds_since(frame_began) / frame_px;
            frame_px = 0;
            on_change();
            lock.lock();
        }
    }

    /// Ends the thread with the current exception.
    void fail() {
        {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
        on_change();
    }

    /// @returns false, with a message, if it failed
    /// @throws gl::DeviceLost
    template <typename Do>
    bool attempt(const Do& act) {
        try {
            act();
            return true;
        } catch (const gl::DeviceLost&) {
            throw;
        } catch (const std::exception& error) {
            gl::throw_if_lost();  // which is why, then
            say(text_of(error));
            return false;
        }
    }

    void say(std::string text) {
        const std::lock_guard lock(mutex);
        message = std::move(text);
    }

    /// Takes other effects, or the same from changed files.
    void take_effects(const Wanted& now, session::Hints hints) {
        hints.reload_effects = std::exchange(effects_read, now.effects_read) != now.effects_read;
        if (now.scene->effects == asked_effects && !hints.reload_effects) return;
        asked_effects = now.scene->effects;
        scene::Scene next = session->scene();
        next.effects = asked_effects;
        if (attempt([&] { session->show(next, session->time(), hints); })) effects = asked_effects;
    }

    /// @param scale  of the frame's sides to the window's
    void show(const Wanted& now, double scale, const session::Hints& hints) {
        if (now.scene) take_effects(now, hints);
        scene::Scene next = now.scene.value_or(session->scene());
        next.effects = effects;
        next.width_px = std::max(1, static_cast<int>(std::lround(now.width_px * scale)));
        next.height_px = std::max(1, static_cast<int>(std::lround(now.height_px * scale)));
        moves = session->is_animated() && !now.keeps_seconds;
        if (moves)
            next.seconds =
                std::fmod(scene.seconds + milliseconds_since(opened_at) / 1000, scene::kMaxSeconds);
        const double before = session->scene().exaggeration;
        // A forecast may not have the time: the picture then keeps its own.
        if (!attempt([&] { session->show(next, now.scene ? now.utc : session->time(), hints); }))
            session->show(next, session->time(), hints);
        if (next.exaggeration != before) publish_opened(now.insets);
    }

    /// Fraction of the window's sides at which a frame meets kSoon_ms.
    double scale_for(const Wanted& now) const {
        if (!now.moving && !now.sun_moving) return 1;
        const double least = now.sun_moving ? kLeastScaleOfSun : kLeastScale;
        const double pixels = double{1} * now.width_px * now.height_px;
        for (const double scale : kScales)
            if (scale <= least || pixels * scale * scale * ms_a_pixel <= kSoon_ms) return scale;
        return least;
    }

    /// @returns true if nothing is left to do for the request
    bool draw(const Wanted& now, std::uint64_t answers) {
        const auto began = Clock::now();
        const double scale = scale_for(now);
        if (now.scene && now.utc != session->time())
            shadows_lag = !session->effects().loaded.modules.empty();
        show(now, scale,
             {.exact = false, .keep_above_m = now.keep_above_m, .overlay = now.overlay});
        // Shadow maps depend on the eye.
        const bool keep = now.sun_moving && shadows_lag &&
                          session->camera().eye_m == shadows_eye_m &&
                          Clock::now() - shadows_at < kShadowsAge;
        const bool whole = session->draw_available(keep);
        awaits_pages = !whole && !now.moving && !now.sun_moving;
        if (!keep) {
            shadows_at = Clock::now();
            shadows_eye_m = session->camera().eye_m;
            shadows_lag = false;
        }
        if (whole || now.moving || now.sun_moving ||
            (new_pages_at && Clock::now() - *new_pages_at > kNewPages))
            new_pages_at.reset();
        if (new_pages_at) return false;
        publish(began, answers, whole && scale == 1 && !keep && !session->dem()->is_preview);
        read_all_posts();
        session->link_rest();
        // Coarse and outdated frames are drawn again when motion ends.
        return whole && (scale == 1 || now.moving || now.sun_moving);
    }

    void publish(Clock::time_point began, std::uint64_t answers, bool sharp) {
        auto made = std::make_shared<Picture>();
        const gl::Extent extent = session->texture().extent();
        made->width_px = extent.width;
        made->height_px = extent.height;
        if (exchange)
            share(*made, extent);
        else
            copy(*made);
        made->camera = session->camera();
        made->aim_m = session->heights_to_aim_at();
        made->utc = session->time();
        made->seconds = session->scene().seconds;
        made->legends = session->colour_legends();
        made->marks = session->marks();
        made->sharp = sharp;
        made->answers = answers;
        made->number = ++published;
        frame_began = began;
        frame_px = double{1} * extent.width * extent.height;
        pictures.add(std::move(made));
    }

    /// Keeps the frame on the device, where the window reads it.
    void share(Picture& picture, gl::Extent extent) {
        picture.shared = exchange->take(extent);
        picture.shared->colour.copy_from(session->texture());
        picture.shared->depth.copy_from(session->depth());
        picture.shared->drawn = gl::Fence::insert();
    }

    void copy(Picture& picture) const {
        picture.rgba.resize(4 * static_cast<std::size_t>(picture.width_px) *
                            static_cast<std::size_t>(picture.height_px));
        session->texture().read(0, std::as_writable_bytes(std::span(picture.rgba)));
        session->read_depths(picture.depths_m);
    }

    bool has_ended() {
        const std::lock_guard lock(mutex);
        return ends;
    }
};

SceneThread::SceneThread(scene::Scene scene, const SceneDevice& device,
                         std::function<void()> on_change,
                         std::shared_ptr<const session::LoadedDem> dem)
    : impl_(std::make_unique<Impl>(std::move(scene), device)) {
    impl_->on_change = std::move(on_change);
    impl_->dem = std::move(dem);
    impl_->thread = std::thread([this] { impl_->run(); });
}

SceneThread::~SceneThread() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->ends = true;
    }
    impl_->changed.notify_one();
    impl_->thread.join();
}

std::shared_ptr<const Opened> SceneThread::opened() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->opened;
}

void SceneThread::check() const {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->failure) std::rethrow_exception(impl_->failure);
}

void SceneThread::want(const Wanted& wanted) {
    impl_->change([&](Impl& my) {
        my.wanted = wanted;
        my.has_new_wants = true;
    });
}

void SceneThread::want_dem(std::shared_ptr<const session::LoadedDem> dem) {
    impl_->change([&](Impl& my) { my.all_posts = std::move(dem); });
}

bool SceneThread::rests() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->rests && !impl_->has_new_wants;
}

std::uint64_t SceneThread::wants() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->wants;
}

std::shared_ptr<const Picture> SceneThread::newer_than(std::uint64_t number) const {
    return impl_->pictures.newer_than(number);
}

std::optional<std::string> SceneThread::take_message() {
    const std::lock_guard lock(impl_->mutex);
    return std::exchange(impl_->message, std::nullopt);
}

}  // namespace relevo::viewer
