#include "sky/shipped.h"

#include <algorithm>
#include <cstring>
#include <future>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/text.h"

namespace relevo::sky {
namespace {

constexpr std::string_view kMark = "relevo atmosphere 3\n";
constexpr std::string_view kWho = "atmosphere";
constexpr int kKept = 4;

/// The airs that were asked for last. Whoever asks first computes, outside of the lock; who asks
/// for the same air meanwhile waits.
class RecentAirs {
  public:
    using Made = std::shared_future<std::shared_ptr<const Atmosphere>>;

    Made find(const Air& air) {
        const std::lock_guard lock(mutex_);
        const auto known = std::ranges::find(airs_, air, &Entry::first);
        if (known != airs_.end()) {
            std::rotate(airs_.begin(), known, known + 1);
        } else {
            if (airs_.size() >= kKept) airs_.pop_back();
            airs_.insert(airs_.begin(), {air, std::async(std::launch::deferred, [air] {
                                                  return std::make_shared<const Atmosphere>(air);
                                              }).share()});
        }
        return airs_.front().second;
    }

  private:
    using Entry = std::pair<Air, Made>;
    std::mutex mutex_;
    std::vector<Entry> airs_;  // the last one asked for first
};

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
    if (air == Air{}) {
        static const auto kDefault = std::make_shared<const Atmosphere>(
            read_atmosphere(share_dir() / "data/sky/air.bin", Air{}));
        return kDefault;
    }
    static RecentAirs recent;
    return recent.find(air).get();
}

}  // namespace relevo::sky
