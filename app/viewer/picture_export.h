#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "image/image.h"
#include "session/session.h"

namespace relevo::viewer {

/// A picture to be written.
struct PictureOrder {
    scene::Scene scene;  ///< with size, samples, transparency and stamps
    std::string path;
    image::Encoding encoding;
};

/// The command line that makes the picture.
std::string command_of(const PictureOrder& order);

/// Draws and writes a picture on a thread and a device of its own, while the window goes on.
class PictureExport {
  public:
    /// @param device     as session::Options
    /// @param dem        the scene's DEM
    /// @param on_change  called on its thread at the end
    PictureExport(PictureOrder order, std::string device,
                  std::shared_ptr<const session::LoadedDem> dem, std::function<void()> on_change);
    PictureExport(const PictureExport&) = delete;
    PictureExport& operator=(const PictureExport&) = delete;
    /// Waits for the picture.
    ~PictureExport();

    bool is_done() const { return is_done_; }
    /// "tyrol.png: picture saved, 1920 x 1080". Requires is_done().
    /// @throws Error why there is no file
    std::string result() const;

  private:
    void run();
    std::string write();

    PictureOrder order_;
    std::string device_;
    std::shared_ptr<const session::LoadedDem> dem_;
    std::function<void()> on_change_;
    std::atomic<bool> is_done_ = false;
    std::string result_;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace relevo::viewer
