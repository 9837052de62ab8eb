#include "sky/shipped.h"

#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/text.h"

namespace relevo::sky {
namespace {

constexpr std::string_view kMark = "relevo atmosphere 1\n";
constexpr std::string_view kWho = "atmosphere";
constexpr int kKept = 4;

std::size_t table_bytes() {
    return std::size_t{DiffuseTable::kHeights} * DiffuseTable::kSuns * sizeof(Diffuse);
}

}  // namespace

void write_atmosphere(const std::filesystem::path& path, const Atmosphere& air) {
    std::string bytes(kMark);
    bytes.append(reinterpret_cast<const char*>(air.diffuse().nodes().data()), table_bytes());
    write_text(path, bytes, true, kWho);
}

Atmosphere read_atmosphere(const std::filesystem::path& path, const Air& air) {
    const std::string bytes = read_text(path, kWho);
    if (bytes.size() != kMark.size() + table_bytes() || !bytes.starts_with(kMark))
        bad_input("atmosphere: " + path.string() +
                  ": not the atmosphere of this version; install Relevo again");
    DiffuseTable table;
    std::memcpy(table.nodes().data(), bytes.data() + kMark.size(), table_bytes());
    return {air, std::move(table)};
}

std::shared_ptr<const Atmosphere> atmosphere_of(const Air& air) {
    static std::mutex mutex;
    static std::vector<std::pair<Air, std::shared_ptr<const Atmosphere>>> kept;
    const std::lock_guard lock(mutex);
    for (const auto& [one, made] : kept)
        if (one == air) return made;
    auto made = std::make_shared<const Atmosphere>(
        air == Air{} ? read_atmosphere(share_dir() / "data/sky/air.bin", air) : Atmosphere(air));
    if (kept.size() >= kKept) kept.erase(kept.begin());
    kept.emplace_back(air, made);
    return made;
}

}  // namespace relevo::sky
