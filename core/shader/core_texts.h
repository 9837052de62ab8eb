#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::shader {

/// Core's own shader texts, by their path under `shaders/`: "terrain.frag.glsl", "lib/noise.glsl".
class CoreTexts {
  public:
    virtual ~CoreTexts() = default;

    /// The whole text; none if there is no such file.
    virtual std::optional<std::string> text(std::string_view name) const = 0;
    /// The file's name for messages.
    virtual std::string file(std::string_view name) const = 0;
    /// The files that plugins may include: "lib/noise.glsl", sorted.
    virtual std::vector<std::string> libraries() const { return {}; }
};

/// The files of a folder, read at every call.
class FolderTexts : public CoreTexts {
  public:
    explicit FolderTexts(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::optional<std::string> text(std::string_view name) const override;
    std::string file(std::string_view name) const override;
    std::vector<std::string> libraries() const override;

  private:
    std::filesystem::path folder_;
};

}  // namespace relevo::shader
