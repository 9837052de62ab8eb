#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "shader/params.h"

namespace relevo::shader {

/// A text parameter of an effect. Its native module reads it; no shader does.
struct TextParam {
    std::string address;   ///< "overlay.picture"
    bool is_file = false;  ///< the path of a file
    std::string label, description;
    std::string initial;
};

/// The values of parameters, by address and type. They are independent of programs: a program that
/// fails to compile, or a plugin that is switched off for a while, keeps its values.
class ParamStore {
  public:
    /// Declares all parameters. Values of known addresses are kept, also of addresses that `params`
    /// lacks: they may be declared again. If a parameter's type has changed, or its range excludes
    /// the value, it is reset to the default, with a warning.
    void declare(const std::vector<Param>& params, const std::vector<TextParam>& texts = {});

    /// Null if no such parameter is declared.
    const Param* find(std::string_view address) const;
    /// @throws Error (BadInput) with the nearest address, if there is one
    const Param& param(std::string_view address) const;
    /// Declared parameters, by address.
    std::vector<const Param*> params() const;

    ParamValue value(std::string_view address) const;  ///< throws as param() does

    const TextParam* find_text(std::string_view address) const;  ///< or null
    std::vector<const TextParam*> texts() const;                 ///< declared ones, by address
    std::string text(std::string_view address) const;  ///< throws if there is no such text

    /// Sets a parameter or a text from the text that people write.
    /// @throws Error (BadInput) for an unknown address, a value that the parameter cannot have, or
    ///         a host parameter
    void set(std::string_view address, std::string_view text);
    void set(std::string_view address, const ParamValue& value);
    void reset(std::string_view address);  ///< back to the default

    /// Writes a host parameter. Its native module does so for every frame.
    /// @throws Error (BadInput) for an unknown address or one that is not host
    void write_host(std::string_view address, const ParamValue& value);

  private:
    struct Entry {
        ParamType type;
        ParamValue value;
    };
    [[noreturn]] void refuse_unknown(std::string_view address) const;
    const Param& settable(std::string_view address) const;

    std::map<std::string, Param, std::less<>> params_;
    std::map<std::string, Entry, std::less<>> values_;  // only values other than the default
    std::map<std::string, TextParam, std::less<>> text_params_;
    std::map<std::string, std::string, std::less<>> texts_;  // only texts other than the default
};

/// A parameter's place in the block `Params`.
struct BlockMember {
    Param param;
    std::size_t offset = 0;  ///< bytes
};

/// The std140 block of all parameters that are not constants (OpenGL 4.5 core, 7.6.2.2).
struct BlockLayout {
    std::vector<BlockMember> members;
    std::size_t size = 0;  ///< bytes, a multiple of 16; 0 for no members

    friend bool operator==(const BlockLayout& a, const BlockLayout& b);
};

/// Lays out the parameters in their order.
BlockLayout block_layout(const std::vector<Param>& params);

/// The block's bytes, for the uniform buffer at binding 1.
std::vector<std::byte> pack(const BlockLayout& layout, const ParamStore& store);

}  // namespace relevo::shader
