#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "gl/program.h"
#include "render/programs.h"

namespace relevo::render {

/// Linked programs of a context by the hash of their source, so that toggling an effect twice links
/// nothing again. Keeps the most recently used ones.
class ProgramCache {
  public:
    struct Entry {
        gl::Program program;
        /// A draw with it has finished, so that no watch is needed.
        bool proven = false;
        std::uint64_t used = 0;
    };

    /// The linked program of a source, or null.
    std::shared_ptr<Entry> find(const ProgramText& text);
    /// Starts compiling and linking unless this was already done; link() waits for the result.
    void begin(const ProgramText& text);
    /// Links and caches the program. @throws Error as link_program
    std::shared_ptr<Entry> link(const ProgramText& text);
    /// Adds a program that another context of the share group has linked, unless it exists.
    void add(const std::string& hash, gl::Program program);

    /// Number of programs linked so far.
    int links() const { return links_; }

  private:
    static constexpr std::size_t kMost = 96;  // about ten selections of effects

    std::shared_ptr<Entry> keep(const std::string& hash, gl::Program program);

    std::map<std::string, std::shared_ptr<Entry>> entries_;
    std::map<std::string, gl::Program::Pending> pending_;
    std::uint64_t uses_ = 0;
    int links_ = 0;
};

}  // namespace relevo::render
