#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace relevo::viewer {

/// Asks the user for DEM files with the desktop's dialog or, if there is none, with a panel.
class OpenDialog {
  public:
    /// @param dem  the panel lists the folder of this file; empty: the working folder
    void open(const std::string& dem);
    /// Closes the panel. The desktop's dialog stays.
    void close() { is_open_ = false; }
    /// Draws the panel if it is open. @param size_px  of the window
    void draw(glm::vec2 size_px);
    /// The files that were chosen since the last call.
    std::vector<std::string> take();

  private:
    void open_panel(const std::string& dem);
    void go_to(const std::filesystem::path& folder);
    void choose(const std::filesystem::path& file);
    void list();
    /// Chooses the file of the input field, or lists its folder.
    void enter();

    std::optional<std::future<std::vector<std::string>>> desktop_;  // the desktop's dialog
    bool is_open_ = false;                                          // the panel
    bool takes_focus_ = false;  // the input field, in the next frame
    int visits_ = 0;            // of folders: the input field has another identifier in each
    std::filesystem::path folder_;
    std::vector<std::string> folders_, files_;
    std::string name_;                 // in the input field
    std::vector<std::string> chosen_;  // in the panel
};

}  // namespace relevo::viewer
