#include <chrono>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/job_run.h"
#include "session/contact_sheet.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

/// A contact sheet on its way.
class SheetRun {
  public:
    SheetRun(const JobArguments& arguments, JobRun& work)
        : arguments_(arguments),
          work_(work),
          output_(arguments.contact_sheet),
          name_(printable(output_.string())) {}

    void run() {
        refuse_options();
        const scene::Scene& first = work_.shots.front().scene;
        const glm::ivec2 size =
            session::SheetLayout::of(work_.shots.size(), {first.width_px, first.height_px},
                                     arguments_.columns)
                .size_px();
        image::check_encoding(output_, arguments_.format.encoding(),
                              {.width_px = size.x, .height_px = size.y});
        if (work_.begin_file(output_, arguments_, "a contact sheet of " + size_text(size))) draw();
    }

  private:
    void refuse_options() const {
        const auto refuse = [&](bool given, const char* option) {
            if (given)
                bad_usage(
                    fmt::format("{}: not with --contact-sheet, which makes one picture", option));
        };
        refuse(!arguments_.output.empty(), "-o");
        refuse(arguments_.resume, "--resume");
        refuse(!arguments_.shard.empty(), "--shard");
        refuse(arguments_.sidecar, "--sidecar");
        refuse(arguments_.audit, "--audit");
        refuse(arguments_.format.bits.has_value(), "--bits");
        refuse(!arguments_.format.layers.empty(), "--layers");
        if (image::is_picture_name(output_) && image::holds_linear_light(output_))
            bad_usage(
                fmt::format("--contact-sheet: {}: expected png, jpg, webp, avif or tif", name_));
    }

    std::string size_text(const glm::ivec2& size) const {
        return fmt::format("{} pictures on {} x {} px", work_.shots.size(), size.x, size.y);
    }

    /// With the job, if the format has room for it.
    image::Metadata metadata() const {
        image::Metadata metadata{
            {"Software", "Relevo " + work_.inputs.version()},
            {"Description", fmt::format("{} pictures of a job", work_.shots.size())}};
        image::Metadata with_job = metadata;
        with_job["relevo:job"] = scene::job_record(work_.job);
        return image::metadata_fits(output_, with_job, 0) ? with_job : metadata;
    }

    void draw() const {
        const auto began = std::chrono::steady_clock::now();
        session::SheetReport report;
        {
            ProgressBar bar;
            report = session::draw_contact_sheet(
                work_.shots,
                {.device = arguments_.device,
                 .output = output_,
                 .overwrite = arguments_.overwrite,
                 .allow_blank = arguments_.allow_blank,
                 .columns = arguments_.columns,
                 .encoding = arguments_.format.encoding(),
                 .metadata = metadata(),
                 .drawn = [&](std::size_t done) { bar.show(done, work_.shots.size()); }},
                work_.times, work_.files);
        }
        const double took_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        work_.notices.release();
        log::info(fmt::format("{}: {}, made in {}", name_, size_text(report.size_px),
                              duration_text(took_s)));
        if (report.blank > 0)
            log::warning(fmt::format("{} of {} pictures show only sky, the first is picture {}",
                                     report.blank, work_.shots.size(), report.first_blank));
    }

    const JobArguments& arguments_;
    JobRun& work_;
    fs::path output_;
    std::string name_;
};

}  // namespace

void run_contact_sheet(const JobArguments& arguments, JobRun& work) {
    SheetRun(arguments, work).run();
}

}  // namespace relevo::cli
