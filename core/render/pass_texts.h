#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shader/core_texts.h"
#include "shader/instance_set.h"
#include "shader/plugin_pass.h"
#include "shader/stitch.h"

namespace relevo::render {

/// Core's shader files, and the main functions of plugins' passes and instances.
class PassTexts : public shader::CoreTexts {
  public:
    /// All arguments must outlive this.
    PassTexts(const shader::CoreTexts& files, const std::vector<shader::PluginPass>& passes,
              const std::vector<shader::InstanceSet>& instances)
        : files_(files), passes_(passes), instances_(instances) {}

    /// Name of the file with a pass's main function.
    static std::string name_of(const shader::PluginPass& pass);
    /// The program of a pass.
    static shader::ProgramRecipe recipe_of(const shader::PluginPass& pass);
    static std::string name_of(const shader::InstanceSet& set);

    std::optional<std::string> text(std::string_view name) const override;
    std::string file(std::string_view name) const override;
    std::vector<std::string> libraries() const override { return files_.libraries(); }

  private:
    const shader::PluginPass* find(std::string_view name) const;
    const shader::InstanceSet* find_instances(std::string_view name) const;

    const shader::CoreTexts& files_;
    const std::vector<shader::PluginPass>& passes_;
    const std::vector<shader::InstanceSet>& instances_;
};

}  // namespace relevo::render
