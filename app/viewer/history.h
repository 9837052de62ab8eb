#pragma once

#include <string>
#include <vector>

#include "viewer/document.h"

namespace relevo::viewer {

/// The states of a document for undo and redo.
class History {
  public:
    /// Adds a state after a change and removes all states that were undone.
    void add(const Document& document);
    /// Whether camera or time differ from the current state.
    bool differs(const Document& document) const;
    /// Replaces the current state.
    void amend(const Document& document);
    /// Adds a state if camera or time differ from the current one.
    void end_step(const Document& document);
    /// What undo() would change: "time", "view" ...; empty: nothing.
    /// @param document  as it is now, with what is no state yet; null: as its last state
    std::string undo_name(const Document* document) const;
    std::string redo_name() const;  ///< what redo() would change
    bool can_undo() const { return at_ > 0; }
    bool can_redo() const { return at_ + 1 < states_.size(); }
    const Document& undo();  ///< the previous state; requires can_undo()
    const Document& redo();  ///< the next state; requires can_redo()

  private:
    std::vector<Document> states_;
    std::size_t at_ = 0;
};

}  // namespace relevo::viewer
