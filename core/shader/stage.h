#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "shader/conditions.h"
#include "shader/core_texts.h"
#include "shader/snippet.h"
#include "shader/stitch.h"
#include "shader/uses.h"

/// One stage of a program during stitching: its files, and the items that `main` reaches.
namespace relevo::shader {

enum class StageKind { Vertex, Fragment, Compute };

/// "vertex"
std::string_view word_of(StageKind kind);

/// The kinds of files, in their order in the text.
enum class UnitRole { Types, Frame, Lib, Defaults, Snippet, Main };

struct Unit {
    UnitRole role;
    const Source* source;
    std::string title;  ///< "lib/noise.glsl"; the file's name for a snippet
    Conditions conditions;
    std::vector<bool> kept;  ///< per item
};

/// Core's files, each parsed once.
class CoreLibrary {
  public:
    explicit CoreLibrary(const CoreTexts& texts) : texts_(texts) {}

    /// Null if there is no such file.
    const Source* find(SourceKind kind, const std::string& name);
    /// The file of lib/ that defines a function; empty without one.
    std::string library_of(const std::string& function);
    /// The file of lib/ with the nearest name.
    std::optional<std::string> nearest_library(const std::string& name) const;

  private:
    const CoreTexts& texts_;
    std::optional<std::map<std::string, std::string>> functions_;  // and their files
    std::map<std::string, std::unique_ptr<Source>> sources_;
};

class Stage {
  public:
    Stage(CoreLibrary& library, const ProgramRecipe& program, const StitchInput& input,
          StageKind kind);

    /// Finds the items that `main` reaches.
    /// @param readers  the fragment stages, if this is a vertex stage: hooks that only fill
    ///                 varyings that no reader needs are not called
    void reach(std::vector<const Stage*> readers);

    StageKind kind() const { return kind_; }
    const std::vector<Unit>& units() const { return units_; }
    const Unit& unit(UnitRole role) const;  ///< the only one of that role

    /// Whether a global of that name is needed.
    bool reaches(std::string_view name) const { return parents_.count(name) > 0; }
    /// The chain of names that needs it: "main -> hook_lit -> haze_on_lit".
    std::string trail(const std::string& name) const;
    const std::string& owner_of(const std::string& name) const;  ///< of a lifted declaration

    struct OwnedSampler {
        const Sampler* sampler;
        std::string owner;
    };
    std::vector<OwnedSampler> samplers() const;    ///< the needed ones, in order of the files
    std::vector<const Varying*> varyings() const;  ///< the needed ones, in order of the files
    const Varying* find_varying(std::string_view name) const;  ///< any declared one, or null
    std::vector<Define> has_macros() const;                    ///< the needed HAS_<word>
    static bool is_foreign(const Sampler& sampler);  ///< reads a texture of another plugin

    bool calls(const Hook& hook) const { return hooks_.count(hook.name) > 0; }
    bool needs_prototype(const Hook& hook) const;
    std::string head(const Hook& hook) const;  ///< of the generated function
    /// Functions that it calls, in order. core_on_<hook> of a chain, if there is one, draws the
    /// scene's overlay.
    std::vector<std::string> called_functions(const Hook& hook) const;
    /// The chain that modifies what a service returns; null if it has none, or no provider.
    const Hook* chain_after(const Hook& service) const;
    std::vector<std::string> providers(const Hook& hook) const;  ///< ids of the plugins among them

  private:
    /// How many of a chain's providers draw under the scene's overlay.
    std::ptrdiff_t place_of_overlay(const Hook& hook, const std::vector<std::string>& ids) const;
    struct Place {
        std::size_t unit;
        std::size_t item;
    };
    const Source* core_source(SourceKind kind, const std::string& name);
    void add_includes(const Source& source, std::vector<std::string>& pending);
    std::string no_library(const Source& source, const Include& include) const;
    void add_unit(UnitRole role, const Source* source, std::string title);
    void index(Macros macros);
    void lift(const Lifted& lifted);

    const Item& item(const Place& place) const;
    const Unit& unit_of(const Place& place) const { return units_[place.unit]; }
    const Place& definition(const std::string& function) const;  ///< not a prototype
    [[noreturn]] void fail(const Place& place, std::string_view message) const;

    void need(const std::string& name, const std::string& by);
    void keep(const Place& place);
    void keep_conditionals(const Place& place);
    void read(const Place& place);
    void call_hook(const Hook& hook, const Place& from, const std::string& by);
    void check_name(const Place& place, const std::string& name, bool called) const;
    void check_stage(const Place& place, const Uses& uses) const;
    void check_output(const Place& place, const std::string& name) const;
    void check_shared(const Place& place) const;
    void check_shared_size() const;
    void check_recursion() const;
    void check_displace() const;
    void check_default(const std::string& function, const Hook& hook) const;

    CoreLibrary& library_;
    const StitchInput& input_;
    StageKind kind_;
    std::string output_;  // of a compute program
    std::vector<const Stage*> readers_;
    std::vector<Unit> units_;
    std::set<std::string, std::less<>> libs_;                        // already in units_
    std::map<std::string, std::set<std::string>> includes_;          // owner -> its included libs
    std::map<std::string, std::vector<Place>, std::less<>> places_;  // of globals in the text
    std::map<std::string, Lifted, std::less<>> lifted_;              // of globals lifted out
    std::map<std::string, std::string, std::less<>>
        parents_;                             // needed name -> the name that needs it
    std::set<std::string_view> hooks_;        // called by core or snippets
    std::set<std::string_view> early_hooks_;  // before their definition
    UsesOf functions_;                        // names that kept functions use
    std::deque<Place> queue_;
};

}  // namespace relevo::shader
