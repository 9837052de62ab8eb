#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "session/session.h"
#include "viewer/export_choice.h"

namespace relevo::viewer {

/// Writes a picture, drawn on a device of its own, or a mesh on a thread, while the window goes on.
class FileExport {
  public:
    /// @param device     as session::Options
    /// @param dem        the scene's DEM
    /// @param on_change  called on its thread before each frame and at the end
    FileExport(ExportOrder order, std::string device, std::shared_ptr<const session::LoadedDem> dem,
               std::function<void()> on_change);
    FileExport(const FileExport&) = delete;
    FileExport& operator=(const FileExport&) = delete;
    /// Waits for the file.
    ~FileExport();

    /// The share that is done, 0 to 1.
    double share() const { return share_; }
    bool is_picture() const { return order_.is_picture(); }
    /// Ends it without a file, after the frame or the part of the mesh in work.
    void cancel() { is_cancelled_ = true; }
    bool can_cancel() const { return !is_cancelled_; }

    bool is_done() const { return is_done_; }
    /// "tyrol.png: picture saved, 1920 x 1080", or that it was cancelled. Requires is_done().
    /// @throws Error why there is no file
    std::string result() const;

  private:
    void run();
    /// @throws Cancelled
    void tell(double share);
    std::string write_picture();
    std::string write_mesh();

    ExportOrder order_;
    std::string device_;
    std::shared_ptr<const session::LoadedDem> dem_;
    std::function<void()> on_change_;
    std::atomic<double> share_ = 0;
    std::atomic<bool> is_cancelled_ = false, is_done_ = false;
    std::string result_;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace relevo::viewer
