#include "session/batch.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "image/image.h"
#include "session/picture_file.h"
#include "session/picture_maker.h"
#include "session/record.h"
#include "session/shot_session.h"
#include "session/task_queue.h"

namespace relevo::session {
namespace {

/// Open output files of a picture, still without their final names.
struct Outputs {
    OutputFile picture;
    std::optional<OutputFile> sidecar{};
    std::vector<OutputFile> beside{};  ///< of a map: files_beside()
    FileParts parts{};
};

/// @throws Error (BadInput) for a picture that is too large for memory
void refuse_bands(const scene::Shot& shot, const PictureFormat& format, bool linear) {
    if (needs_bands(shot.scene, format, linear))
        bad_input(
            fmt::format("run: {} x {} px take more than 1 GiB; make it by itself with "
                        "relevo capture",
                        shot.scene.width_px, shot.scene.height_px));
}

class Batch {
  public:
    Batch(const BatchOptions& options, bool linear, SceneTimes& times, SceneInputs& inputs,
          FilesInUse& files)
        : options_(options),
          inputs_(inputs),
          files_(files),
          session_of_({.device = options.device,
                       .radiance = linear,
                       .format = options.format,
                       .audited = options.audit},
                      times, files) {}

    std::size_t run(const std::vector<scene::Shot>& shots) {
        const bool linear = image::holds_linear_light(shots.front().output);
        image::load_format(shots.front().output);
        TaskQueue queue(std::clamp(thread_count() - 1, 1, 8));
        for (const scene::Shot& shot : shots) {
            try {
                draw(shot, linear, queue);
            } catch (const Error& error) {
                if (!session_of_.was_opened()) throw;  // nothing can be drawn
                failed(shot, error.what());
            } catch (...) {
                failed(shot, reason_of(std::current_exception()));
            }
        }
        queue.finish();
        return failed_;
    }

  private:
    void draw(const scene::Shot& shot, bool linear, TaskQueue& queue) {
        refuse_bands(shot, options_.format, linear);
        Session& session = session_of_.of(shot);
        const SceneIn scene_is = scene_in(shot.output, shot.scene);
        const bool overwrite = options_.overwrite || options_.parts.contains(shot.output);
        auto outputs =
            std::make_shared<Outputs>(Outputs{files_.open_alone(shot.output, overwrite, "run")});
        if (options_.sidecar || scene_is == SceneIn::Sidecar)
            outputs->sidecar.emplace(
                files_.open_alone(sidecar_to_write(shot.output), overwrite, "--sidecar"));
        for (const std::filesystem::path& path : files_beside(shot.scene, shot.output))
            outputs->beside.push_back(files_.open_alone(path, overwrite, "--ortho"));
        warn_of_files_beside(shot.scene, shot.output);
        inputs_.record(shot.scene);  // before files are read, to notice later changes
        session.show(shot.scene, shot.utc);
        auto picture = std::make_shared<image::Picture>(session.make_picture());
        if (!options_.allow_blank && !session.shows_ground()) return blank(shot);
        outputs->parts = file_parts_of(session);
        std::optional<ShadowAudit> audit;
        if (options_.audit) audit = audit_shadows(session);
        if (audit) options_.audited(shot, *audit);
        if (outputs->sidecar)
            outputs->sidecar->write(
                sidecar_text(session, inputs_, shot.output.filename().string(), audit));
        const image::Metadata metadata = metadata_of(
            session, inputs_, scene_is, format_text(options_.encoding, options_.format));
        queue.add([this, &shot, outputs, metadata, picture] {
            write_files(shot, *outputs, metadata, *picture);
        });
        if (!linear)
            for (const std::string& note : session.stamp_notes())
                log::info(fmt::format("{}: {}", printable(shot.output.string()), note));
    }

    void write_files(const scene::Shot& shot, Outputs& outputs, const image::Metadata& metadata,
                     const image::Picture& picture) {
        try {
            write_picture(outputs.picture, picture, metadata, options_.encoding, outputs.parts);
            std::vector<OutputFile*> all;
            for (OutputFile& file : outputs.beside)
                all.push_back(&file);
            if (outputs.parts.where) write_beside(all, *outputs.parts.where);
            all.push_back(&outputs.picture);
            if (outputs.sidecar) all.push_back(&*outputs.sidecar);
            OutputFile::finish_all(all);
            const std::lock_guard lock(mutex_);
            options_.made(shot);
        } catch (...) {
            failed(shot, reason_of(std::current_exception()));
        }
    }

    void blank(const scene::Shot& shot) {
        const std::lock_guard lock(mutex_);
        ++failed_;
        options_.blank(shot);
    }

    void failed(const scene::Shot& shot, const std::string& why) {
        const std::lock_guard lock(mutex_);
        ++failed_;
        options_.failed(shot, why);
    }

    const BatchOptions& options_;
    SceneInputs& inputs_;
    FilesInUse& files_;
    ShotSession session_of_;
    std::mutex mutex_;  // guards the callbacks and failed_
    std::size_t failed_ = 0;
};

}  // namespace

void settle(scene::Shot& shot, SceneTimes& times, SceneInputs& inputs) {
    shot.scene.effects = inputs.settled(shot.scene.effects);
    shot.scene.time.at = sun::exact_iso(shot.utc);
    shot.scene.time.date.clear();
    shot.scene.view = times.settled_view(shot.scene);
    shot.scene = times.with_absolute_paths(std::move(shot.scene));
}

void settle(std::vector<scene::Shot>& shots, SceneTimes& times, SceneInputs& inputs) {
    for (scene::Shot& shot : shots) {
        try {
            inputs.settled(shot.scene.effects);
        } catch (const Error& error) {
            throw Error(error.code(), printable(shot.output.string()) + ": " + error.what());
        }
        settle(shot, times, inputs);
    }
}

void order_for_drawing(std::vector<scene::Shot>& shots) {
    std::map<std::string, std::size_t> dems, maps, effects;
    std::vector<std::array<std::size_t, 3>> places;
    std::vector<std::size_t> order;
    for (const scene::Shot& shot : shots) {
        const std::size_t dem = dems.try_emplace(dem_key(shot.scene), dems.size()).first->second;
        const scene::LandCover& cover = shot.scene.land_cover;
        const std::size_t map =
            maps.try_emplace(fmt::format("{}\n{}\n{}\n{}", cover.file, cover.classes,
                                         cover.climate_alone, cover.surface),
                             maps.size())
                .first->second;
        const std::size_t effect =
            effects.try_emplace(effects_key(shot.scene.effects), effects.size()).first->second;
        order.push_back(places.size());
        places.push_back({dem, map, effect});
    }
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
    std::vector<scene::Shot> ordered;
    ordered.reserve(shots.size());
    for (const std::size_t at : order)
        ordered.push_back(std::move(shots[at]));
    shots = std::move(ordered);
}

std::size_t draw_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                       SceneTimes& times, SceneInputs& inputs, FilesInUse& files) {
    if (shots.empty()) return 0;
    const bool linear = image::holds_linear_light(shots.front().output);
    return Batch(options, linear, times, inputs, files).run(shots);
}

double time_batch(const std::vector<scene::Shot>& shots, const BatchOptions& options,
                  SceneTimes& times) {
    using Clock = std::chrono::steady_clock;
    const auto seconds_since = [](Clock::time_point began) {
        return std::chrono::duration<double>(Clock::now() - began).count();
    };
    const auto opening = Clock::now();
    FilesInUse files;
    PictureFormat format = options.format;
    format.layers.clear();
    ShotSession sessions({.device = options.device, .format = format, .audited = options.audit},
                         times, files);
    const auto draw = [&](const scene::Shot& shot) {
        const auto began = Clock::now();
        refuse_bands(shot, format, /*linear=*/false);
        Session& session = sessions.of(shot);
        session.show(shot.scene, shot.utc);
        session.make_picture();
        if (options.audit) audit_shadows(session);
        return seconds_since(began);
    };
    draw(shots.front());
    const double opening_s = seconds_since(opening);
    double sum_s = 0;
    int count = 0;
    for (const std::size_t quarter : {1, 2, 3}) {
        const scene::Shot& shot = shots[shots.size() * quarter / 4];
        if (dem_key(shot.scene) != dem_key(shots.front().scene)) continue;
        sum_s += draw(shot);
        ++count;
    }
    const double frame_s = count > 0 ? sum_s / count : opening_s;
    return opening_s + frame_s * static_cast<double>(shots.size() - 1);
}

}  // namespace relevo::session
