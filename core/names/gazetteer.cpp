#include "names/gazetteer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>
#include <zlib.h>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "names/fold.h"

namespace relevo::names {
namespace {

constexpr double kEarth_m = 6371008.8;  // mean radius: distances only order and preselect
constexpr std::string_view kHeads[] = {"name\talt\tcc\tlat\tlon\tpop",
                                       "name\talt\tcc\tlat\tlon\tele\tsrc"};

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    bad_input(fmt::format("names: {}: {}; install Relevo again", path, what));
}

/// The text of a gzip file.
std::string unpacked(const std::string& path, std::string_view packed) {
    z_stream stream{};
    constexpr int kGzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream, kGzip) != Z_OK) refuse(path, "no memory to unpack it");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    std::string text(8 * packed.size() + 1024, '\0');
    stream.next_out = reinterpret_cast<Bytef*>(text.data());
    stream.avail_out = static_cast<uInt>(text.size());
    const int status = inflate(&stream, Z_FINISH);
    text.resize(stream.total_out);
    inflateEnd(&stream);
    if (status != Z_STREAM_END) refuse(path, "damaged, or not all of it is there");
    return text;
}

/// A line or field, up to a separator or the end; removes both.
std::string_view take(std::string_view& rest, char separator) {
    const std::string_view piece = rest.substr(0, rest.find(separator));
    rest.remove_prefix(std::min(piece.size() + 1, rest.size()));
    return piece;
}

glm::vec3 on_sphere(const geo::Geodetic& place) {
    const double c = std::cos(place.lat_rad);
    return {c * std::cos(place.lon_rad), c * std::sin(place.lon_rad), std::sin(place.lat_rad)};
}

float chord_of(double distance_m) {
    return static_cast<float>(2 * std::sin(std::min(distance_m / kEarth_m, kPi) / 2));
}

}  // namespace

struct Gazetteer::Hit {
    std::uint32_t entry;
    int fit;  ///< 0: the whole name, 1: its beginning, 2: a later word
};

Gazetteer::Gazetteer(const std::filesystem::path& places, const std::filesystem::path& summits) {
    texts_.reserve(2);  // entries point into them
    if (!places.empty()) read(places, Kind::Place);
    read(summits, Kind::Summit);
}

const Gazetteer& Gazetteer::shipped() {
    static const Gazetteer gazetteer(share_dir() / "data/names/places.tsv.gz",
                                     share_dir() / "data/names/summits.tsv.gz");
    return gazetteer;
}

const Gazetteer& Gazetteer::summits() {
    static const Gazetteer gazetteer({}, share_dir() / "data/names/summits.tsv.gz");
    return gazetteer;
}

void Gazetteer::read(const std::filesystem::path& path, Kind kind) {
    try {
        texts_.push_back(unpacked(path.string(), read_text(path, "names")));
    } catch (const Error& error) {
        const std::string what = error.what();
        bad_input(what.ends_with("again") ? what : what + "; install Relevo again");
    }
    std::string_view rest = texts_.back();
    if (take(rest, '\n') != kHeads[static_cast<int>(kind)])
        refuse(path.string(), "no such list of this version");
    for (std::size_t line = 2; !rest.empty(); ++line) {
        const std::string_view row = take(rest, '\n');
        if (!add_row(row, kind)) refuse(path.string(), fmt::format("line {}: damaged", line));
    }
}

bool Gazetteer::add_row(std::string_view row, Kind kind) {
    Entry entry{.kind = kind, .name = take(row, '\t'), .others = take(row, '\t')};
    entry.country = take(row, '\t');
    const auto lat_deg = parse_number(take(row, '\t')), lon_deg = parse_number(take(row, '\t'));
    const std::string_view size = take(row, '\t');
    const auto number = parse_number(size);
    if (kind == Kind::Summit && row.size() == 1) entry.source = row.front();
    const bool is_whole = !entry.name.empty() && lat_deg && lon_deg && std::abs(*lat_deg) <= 90 &&
                          (number || size.empty()) && row.size() == (kind == Kind::Summit ? 1 : 0);
    if (!is_whole) return false;
    entry.place = geo::geodetic_deg(*lat_deg, *lon_deg);
    if (number) entry.size = static_cast<int>(*number);
    positions_.push_back(on_sphere(entry.place));
    entries_.push_back(entry);
    add_key(entry.name);
    for (std::string_view others = entry.others; !others.empty();)
        add_key(take(others, '|'));
    return true;
}

void Gazetteer::add_key(std::string_view name) {
    const auto add = [&](const std::string& key) {
        keys_ += key;
        keys_ += '\n';
        key_ends_.push_back(static_cast<std::uint32_t>(keys_.size()));
        key_entries_.push_back(static_cast<std::uint32_t>(entries_.size() - 1));
    };
    add(fold(name));
    if (const std::string spelled = with_spelled_umlauts(name); spelled != name) add(fold(spelled));
}

std::vector<Gazetteer::Hit> Gazetteer::hits(const std::string& key) const {
    std::vector<Hit> hits;
    std::size_t k = 0;
    for (std::size_t at = 1; (at = keys_.find(key, at)) != keys_.npos;) {
        const char before = keys_[at - 1], after = keys_[at + key.size()];
        if (before != '\n' && before != ' ') {
            ++at;
            continue;
        }
        while (key_ends_[k] <= at)
            ++k;
        const int fit = before == ' ' ? 2 : after == '\n' ? 0 : 1;
        if (!hits.empty() && hits.back().entry == key_entries_[k])
            hits.back().fit = std::min(hits.back().fit, fit);
        else
            hits.push_back({key_entries_[k], fit});
        at = key_ends_[k];
    }
    return hits;
}

std::vector<const Entry*> Gazetteer::find(std::string_view text, const std::optional<Near>& near,
                                          std::size_t most) const {
    const std::string key = fold(text);
    if (key.empty()) return {};
    const glm::vec3 from = near ? on_sphere(near->centre) : glm::vec3(0);
    const float reach = near ? chord_of(near->radius_m) : 0;
    struct Ranked {
        bool is_far;
        int fit;
        float measure;
        std::uint32_t entry;
        auto order() const { return std::tuple(is_far, fit, measure, entry); }
    };
    std::vector<Ranked> ranked;
    for (const Hit& hit : hits(key)) {
        const float measure = near ? glm::distance(positions_[hit.entry], from)
                                   : -static_cast<float>(entries_[hit.entry].size.value_or(0));
        ranked.push_back({near && measure > reach, hit.fit, measure, hit.entry});
    }
    const auto end = ranked.begin() + static_cast<std::ptrdiff_t>(std::min(most, ranked.size()));
    std::ranges::partial_sort(ranked, end, {}, &Ranked::order);
    std::vector<const Entry*> found;
    for (auto at = ranked.begin(); at != end; ++at)
        found.push_back(&entries_[at->entry]);
    return found;
}

const Entry* Gazetteer::nearest_place(const Near& near) const {
    const glm::vec3 from = on_sphere(near.centre);
    float reach = chord_of(near.radius_m);
    const Entry* nearest = nullptr;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const float away = glm::distance(positions_[i], from);
        if (entries_[i].kind != Kind::Place || away > reach) continue;
        reach = away;
        nearest = &entries_[i];
    }
    return nearest;
}

std::vector<const Entry*> Gazetteer::within(Kind kind, const Near& near) const {
    const glm::vec3 from = on_sphere(near.centre);
    // The sphere's distances differ from the ellipsoid's by less than this.
    const float reach = chord_of(1.01 * near.radius_m);
    std::vector<const Entry*> found;
    for (std::size_t i = 0; i < entries_.size(); ++i)
        if (entries_[i].kind == kind && glm::distance(positions_[i], from) <= reach)
            found.push_back(&entries_[i]);
    return found;
}

}  // namespace relevo::names
