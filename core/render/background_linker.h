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

/// Links programs on its own thread, in a context that shares objects with the drawing one.
class BackgroundLinker {
  public:
    /// @param context   must outlive this, as must the snippets
    /// @param snippets  of the enabled plugins. If the driver hangs or crashes on one, the process
    ///     ends with a message that names it (DrawWatch)
    BackgroundLinker(const gl::Context& context, std::vector<ProgramText> texts,
                     std::vector<const shader::Snippet*> snippets);
    /// Waits for the program that is being linked.
    ~BackgroundLinker();

    /// Ends the thread after the program that is being linked, without waiting for it.
    void stop() { ends_ = true; }
    /// Programs linked since the last call, by the hash of their source. Programs that failed are
    /// omitted: linking one again in the foreground reports the error.
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
