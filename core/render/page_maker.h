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

/// Texels of a page, one vector for each layer.
struct MadePage {
    TileKey key;
    std::vector<std::vector<std::byte>> layers;
};

/// Makes pages on all processors.
/// @param make  called on several threads
std::vector<MadePage> make_pages(std::span<const TileKey> keys,
                                 const std::function<MadePage(const TileKey&)>& make);

/// Makes pages in the background.
class PageMaker {
  public:
    explicit PageMaker(std::function<MadePage(const TileKey&)> make);
    PageMaker(const PageMaker&) = delete;
    PageMaker& operator=(const PageMaker&) = delete;
    /// Waits for pages in progress.
    ~PageMaker();

    /// Replaces the queue of pages to make.
    void want(std::vector<TileKey> keys);
    /// Pages that were made since the last call. @throws what `make` threw
    std::vector<MadePage> take();
    /// True if pages are being made that take() would not return yet.
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
