#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "render/lod.h"

namespace relevo::render {

/// The texels of a page in each of its layers.
struct MadePage {
    TileKey key;
    std::vector<std::vector<std::byte>> layers;
};

/// Makes pages on all processors.
/// @param make  texels of a page in each layer; called on several threads at once
std::vector<MadePage> make_pages(std::span<const TileKey> keys,
                                 const std::function<MadePage(const TileKey&)>& make);

/// Makes pages beside the thread that draws.
class PageMaker {
  public:
    explicit PageMaker(std::function<MadePage(const TileKey&)> make);
    PageMaker(const PageMaker&) = delete;
    PageMaker& operator=(const PageMaker&) = delete;
    /// Waits for the pages that are being made.
    ~PageMaker();

    /// What to make from now on, first things first, in place of what was wanted before.
    void want(std::vector<TileKey> keys);
    /// What has been made since the last call. @throws what `make` threw
    std::vector<MadePage> take();
    /// Whether there is more to come than take() would give now.
    bool is_at_work() const;

  private:
    void run();

    std::function<MadePage(const TileKey&)> make_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<TileKey> wanted_, in_work_;
    std::vector<MadePage> made_;
    std::exception_ptr error_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace relevo::render
