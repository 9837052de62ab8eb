#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "render/draw_watch.h"
#include "render/program_cache.h"

namespace relevo::render {

/// Programs of one selection of effects. Each is linked, and first drawn with, under a DrawWatch.
class WatchedPrograms {
  public:
    /// @param texts  must outlive this, like the cache and the snippets
    WatchedPrograms(const StitchedFrames& texts, ProgramCache& cache,
                    std::vector<const shader::Snippet*> snippets);

    const ProgramText& text(const std::string& name) const;
    /// Starts compiling and linking; several programs may be in progress.
    void begin(const std::string& name);
    bool is_linked(const std::string& name);
    /// Links a program if necessary. @throws Error as link_program
    const gl::Program& link(const std::string& name);
    /// True until a draw with the program has finished.
    bool needs_watch(const std::string& name);

    /// Draws with a program, watched if necessary.
    /// @param parts  number of pixels and triangles
    void draw(const std::string& name, double parts, const std::function<void()>& body);
    /// Draws watched, and waits for the device.
    void draw_watched(const std::string& name, double parts, const std::function<void()>& body);
    /// Ends the need for a watch.
    void set_proven(const std::string& name);
    /// True if a linked program needs a watch.
    bool is_watching() const { return watch_.has_value(); }

  private:
    ProgramCache::Entry& entry(const std::string& name);
    DrawWatch& watch();
    void end_watch();

    const StitchedFrames& texts_;
    ProgramCache& cache_;
    std::vector<const shader::Snippet*> snippets_;
    std::map<std::string, std::shared_ptr<ProgramCache::Entry>> linked_;  // by name
    std::optional<DrawWatch> watch_;  // owns a thread; exists only while needed
};

}  // namespace relevo::render
