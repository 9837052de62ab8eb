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
    /// Links it, if that has not been done yet. @throws Error as link_program
    const gl::Program& link(const std::string& name);
    /// Whether no draw with a program has ended yet.
    bool needs_watch(const std::string& name);

    /// Draws under a watch, and waits for the device.
    /// @param parts  pixels and triangles
    void draw_watched(const std::string& name, double parts, const std::function<void()>& draw);
    /// From now on a program needs no watch.
    void set_proven(const std::string& name);

  private:
    ProgramCache::Entry& entry(const std::string& name);
    DrawWatch& watch();

    const StitchedFrames& texts_;
    ProgramCache& cache_;
    std::vector<const shader::Snippet*> snippets_;
    std::map<std::string, std::shared_ptr<ProgramCache::Entry>> linked_;  // by name
    std::optional<DrawWatch> watch_;  // a thread: there while it is needed
};

}  // namespace relevo::render
