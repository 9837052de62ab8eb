#include "cli/sun_points.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/progress.h"
#include "base/text.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

constexpr int kChunk = 16;  // points a thread between two writes, so that memory has room for them
constexpr double kPatience_s = 3;  // of who watches a terminal

/// A field of a CSV: in quotes where it needs them (RFC 4180).
std::string csv_field(const std::string& text) {
    const std::string line = printable(text);
    if (line.find_first_of(",;\"") == line.npos) return line;
    std::string quoted = "\"";
    for (const char c : line)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

/// What is written of one point.
struct Record {
    std::string csv, json, error;
    bool open = false, holes = false;
};

/// The records of a file of points, in its order, to all who want them.
class Writer {
  public:
    Writer(const PointsJob& job, const OutputArguments& output, const OpenResults& results)
        : job_(job), schema_(output.schema) {
        for (const auto& [ending, file] : results)
            (ending == "json" ? json_files_ : csv_files_).push_back(file);
        out_json_ = output.json;
        out_csv_ = output.csv || (results.empty() && !output.json);
    }
    bool csv() const { return !csv_files_.empty() || out_csv_; }
    bool json() const { return !json_files_.empty() || out_json_; }
    const std::string& schema() const { return schema_; }

    void add(const Record& record) {
        // Not before the first record is there: what is wrong with an option is said instead.
        if (first_)
            write_csv(csv_remarks(job_.remarks) + "name,at_lat_deg,at_lon_deg," + job_.columns +
                      ",error\n");
        write_csv(record.csv);
        write_json((first_ ? "[\n  " : ",\n  ") + record.json);
        first_ = false;
    }
    void finish() {
        write_json("\n]\n");
        std::vector<OutputFile*> files = csv_files_;
        files.insert(files.end(), json_files_.begin(), json_files_.end());
        OutputFile::finish_all(files);
    }

  private:
    void write_csv(const std::string& text) {
        for (OutputFile* const file : csv_files_)
            file->write(text);
        if (out_csv_) fmt::print("{}", text);
    }
    void write_json(const std::string& text) {
        for (OutputFile* const file : json_files_)
            file->write(text);
        if (out_json_) fmt::print("{}", text);
    }

    const PointsJob& job_;
    const std::string& schema_;
    std::vector<OutputFile*> csv_files_, json_files_;
    bool out_csv_ = false, out_json_ = false;
    bool first_ = true;
};

Record record_of(const PointsJob& job, const dem::NamedPlace& point, const std::string& name,
                 const Writer& writer) {
    Record record;
    const std::string lat = fmt::format("{}", angle_deg(point.at.place.lat_rad));
    const std::string lon = fmt::format("{}", angle_deg(point.at.place.lon_rad));
    const std::string head = fmt::format("{},{},{}", csv_field(name), lat, lon);
    ordered_json json{{"schema", writer.schema()},
                      {"name", name},
                      {"lat_deg", angle_deg(point.at.place.lat_rad)},
                      {"lon_deg", angle_deg(point.at.place.lon_rad)}};
    try {
        const PointForms forms = job.forms(point);
        record.open = !forms.doubt.open.empty();
        record.holes = !forms.doubt.holes.empty();
        if (writer.csv())
            for (const std::string& row : forms.rows())
                record.csv += head + "," + row + ",\n";
        if (writer.json()) json.update(forms.json());
    } catch (const Error& error) {
        if (error.code() != ErrorCode::BadInput) throw;
        record.error = error.what();
        const auto columns = std::ranges::count(job.columns, ',') + 1;
        record.csv = head + "," + std::string(static_cast<std::size_t>(columns), ',') +
                     csv_field(record.error) + "\n";
        json["error"] = record.error;
    }
    if (!writer.json()) return record;
    for (const char c : json_text(json))
        record.json += c == '\n' ? std::string("\n  ") : std::string(1, c);
    record.json.erase(record.json.find_last_not_of(" \n") + 1);
    return record;
}

/// What warn_of() says of one place, in one word for many.
void warn_of_points(std::size_t open, std::size_t holes, std::size_t all) {
    if (open > 0)
        log::warning(
            fmt::format("{} of {} points: mountains outside the DEM could change the result; --at "
                        "for one of them says where, --highest bounds them",
                        open, all));
    if (holes > 0)
        log::warning(fmt::format(
            "{} of {} points: voids of the DEM may hide ground; use a DEM without voids", holes,
            all));
}

}  // namespace

void PointsArguments::add_to(Verb verb) {
    const Option at = verb.option("--at");
    at.required(false);
    at_ = at;
    verb.add_option("--points", path,
                    "Many places instead of --at: CSV (columns lat, lon, name), GPX or GeoJSON; "
                    "one record for each")
        .excludes(at);
    verb.add_option("--points-crs", crs, "CRS of columns x and y in that CSV: EPSG:n");
}

bool PointsArguments::given() const {
    if (path.empty() && at_.count() == 0)
        bad_usage("--at: missing; pass --at 46.55,8.56, or --points FILE for many places");
    if (path.empty() && !crs.empty()) bad_usage("--points-crs: needs --points");
    return !path.empty();
}

std::vector<dem::NamedPlace> PointsArguments::read(FilesInUse& files,
                                                   const OutputArguments& output) const {
    if (output.has_drawing())
        bad_usage(
            "--points: a drawing is of one place; pass -o with a name that ends in csv, json");
    files.add_input(path, "the file of points");
    return dem::read_points(path, "--points", crs);
}

void deliver_points(const PointsArguments& arguments, const std::vector<dem::NamedPlace>& points,
                    const PointsJob& job, const OutputArguments& output, const OpenResults& results,
                    bool zone_by_place) {
    if (zone_by_place) log::info("times are local times of each point; --tz sets another zone");
    const auto name_of = [&](std::size_t i) {
        return points[i].name.empty() ? std::to_string(i + 1) : points[i].name;
    };
    Writer writer(job, output, results);  // of one point at least
    std::optional<Progress> progress;
    if (isatty(STDERR_FILENO) != 0)
        progress.emplace(arguments.path, static_cast<double>(points.size()), kPatience_s);
    std::size_t failed = 0, open = 0, holes = 0;
    std::string first_error;
    const std::size_t chunk =
        static_cast<std::size_t>(kChunk) * static_cast<std::size_t>(thread_count());
    for (std::size_t begin = 0; begin < points.size(); begin += chunk) {
        std::vector<Record> records(std::min(chunk, points.size() - begin));
        parallel_for(0, static_cast<int>(records.size()), 1, [&](int first, int last) {
            for (int k = first; k < last; ++k) {
                const std::size_t i = begin + static_cast<std::size_t>(k);
                records[static_cast<std::size_t>(k)] =
                    record_of(job, points[i], name_of(i), writer);
                if (progress) progress->add(1);
            }
        });
        for (std::size_t k = 0; k < records.size(); ++k) {
            const Record& record = records[k];
            writer.add(record);
            open += record.open;
            holes += record.holes;
            if (!record.error.empty() && failed++ == 0)
                first_error = fmt::format("\"{}\": {}", name_of(begin + k), record.error);
        }
    }
    writer.finish();
    warn_of_points(open, holes, points.size());
    if (failed > 0)
        bad_input(fmt::format("--points: {}: {} of {} points have no figures; the first, {}",
                              arguments.path, failed, points.size(), first_error));
}

}  // namespace relevo::cli
