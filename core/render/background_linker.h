#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gl/context.h"
#include "render/draw_watch.h"

namespace relevo::render {

/// Links programs on a thread of its own, in a context that shares with the one that will draw with
/// them.
class BackgroundLinker {
  public:
    /// @param context   must outlive this, as must the snippets
    /// @param snippets  of the enabled plugins: a driver that compiles without end, or crashes,
    /// ends
    ///                  the program with a message that names them (DrawWatch)
    BackgroundLinker(const gl::Context& context, std::vector<ProgramText> texts,
                     std::vector<const shader::Snippet*> snippets);
    /// Waits for the program in work.
    ~BackgroundLinker();

    /// Has the thread end after the program in work, without waiting for it.
    void stop() { ends_ = true; }
    /// What has been linked since the last call, by the hash of its text. A program that the driver
    /// refuses is left out: whoever needs it gets the error.
    std::vector<std::pair<std::string, gl::Program>> take();

  private:
    void run();
    void link(const ProgramText& text, gl::Context& context, DrawWatch& watch);

    const gl::Context& context_;
    std::vector<ProgramText> texts_;
    std::vector<const shader::Snippet*> snippets_;
    std::mutex mutex_;
    std::vector<std::pair<std::string, gl::Program>> linked_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

}  // namespace relevo::render
