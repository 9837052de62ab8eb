#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "gl/program.h"
#include "render/programs.h"

namespace relevo::render {

/// Linked programs of a context, by the hash of their texts: programs that an effect's toggle needs
/// again are not linked again. Keeps the most recently used.
class ProgramCache {
  public:
    struct Entry {
        gl::Program program;
        /// A draw with it has ended: it needs no watch any more.
        bool proven = false;
        std::uint64_t used = 0;
    };

    /// The program of a text; null where none has been linked.
    std::shared_ptr<Entry> find(const ProgramText& text);
    /// Has the driver begin to compile and link, if nobody has: link() then waits for it.
    void begin(const ProgramText& text);
    /// Links and keeps it. @throws Error as link_program
    std::shared_ptr<Entry> link(const ProgramText& text);
    /// Keeps a program that was linked elsewhere in the share group, unless there is one.
    void add(const std::string& hash, gl::Program program);

    /// How many programs have been linked so far.
    int links() const { return links_; }

  private:
    static constexpr std::size_t kMost = 96;  // some ten selections of effects

    std::shared_ptr<Entry> keep(const std::string& hash, gl::Program program);

    std::map<std::string, std::shared_ptr<Entry>> entries_;
    std::map<std::string, gl::Program::Pending> pending_;
    std::uint64_t uses_ = 0;
    int links_ = 0;
};

}  // namespace relevo::render
