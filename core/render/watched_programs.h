#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "render/draw_watch.h"
#include "render/program_cache.h"

namespace relevo::render {

/// The programs of one selection of effects. Each is linked, and drawn with for the first time,
/// under a DrawWatch, whenever that is.
class WatchedPrograms {
  public:
    /// @param texts  must outlive this, as must the cache and the snippets
    WatchedPrograms(const StitchedFrames& texts, ProgramCache& cache,
                    std::vector<const shader::Snippet*> snippets);

    const ProgramText& text(const std::string& name) const;
    /// Has the driver begin to compile and link, so that it may do several at once.
    void begin(const std::string& name);
    /// Links it, if that has not been done yet. @throws Error as link_program
    const gl::Program& link(const std::string& name);
    /// Whether no draw with a program has ended yet.
    bool needs_watch(const std::string& name);

    /// Draws with a program, under a watch while it needs one.
    /// @param parts  pixels and triangles
    void draw(const std::string& name, double parts, const std::function<void()>& body);
    /// Draws under a watch in any case, and waits for the device.
    void draw_watched(const std::string& name, double parts, const std::function<void()>& body);
    /// From now on a program needs no watch.
    void set_proven(const std::string& name);
    /// Whether some program has been linked and needs a watch.
    bool is_watching() const { return watch_.has_value(); }

  private:
    ProgramCache::Entry& entry(const std::string& name);
    DrawWatch& watch();
    void end_watch();

    const StitchedFrames& texts_;
    ProgramCache& cache_;
    std::vector<const shader::Snippet*> snippets_;
    std::map<std::string, std::shared_ptr<ProgramCache::Entry>> linked_;  // by name
    std::optional<DrawWatch> watch_;  // a thread: there while it is needed
};

}  // namespace relevo::render
