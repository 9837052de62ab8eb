#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

namespace relevo::viewer {

/// A list of DEMs to open one from, for desktops without a file dialog.
class OpenPanel {
  public:
    /// Shows the folder of a file. @param dem  empty: the working folder
    void open(const std::string& dem);
    void close() { is_open_ = false; }
    /// Nothing where it is closed. @param size_px  of the window
    void draw(glm::vec2 size_px);
    /// What was chosen since the last call.
    std::optional<std::string> take() { return std::exchange(chosen_, std::nullopt); }

  private:
    void go_to(const std::filesystem::path& folder);
    void choose(const std::filesystem::path& file);
    void list();
    /// Opens what is written, or goes to that folder.
    void enter();

    bool is_open_ = false;
    bool is_written_to_ = false;  // the name takes the keyboard in the next frame
    int visits_ = 0;              // of folders: each has a name of its own to be written
    std::filesystem::path folder_;
    std::vector<std::string> folders_, dems_;
    std::string name_;  // that is being written
    std::optional<std::string> chosen_;
};

}  // namespace relevo::viewer
