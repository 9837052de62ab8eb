#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "shader/params.h"

namespace relevo::shader {

/// A text that an effect takes, which no shader sees: its native module reads it.
struct TextParam {
    std::string address;   ///< "overlay.picture"
    bool is_file = false;  ///< the path of a file
    std::string label, description;
    std::string initial;
};

/// The values of parameters, kept on the host and keyed by address and type, so that a program
/// that fails to compile, or a plugin that is off for a while, loses nothing.
class ParamStore {
  public:
    /// Makes `params` the parameters there are. Values of addresses known before are kept, also of
    /// those that `params` no longer has, for when they come back. A value whose parameter now has
    /// another type, or a range without it, goes back to the default, with a warning.
    void declare(const std::vector<Param>& params, const std::vector<TextParam>& texts = {});

    /// The declared parameter of that address, or null.
    const Param* find(std::string_view address) const;
    /// @throws Error (BadInput) with the nearest address where there is one
    const Param& param(std::string_view address) const;
    /// Declared parameters, by address.
    std::vector<const Param*> params() const;

    ParamValue value(std::string_view address) const;  ///< throws as param() does

    const TextParam* find_text(std::string_view address) const;  ///< or null
    std::vector<const TextParam*> texts() const;                 ///< declared ones, by address
    std::string text(std::string_view address) const;  ///< throws where there is no such text

    /// Sets a value as people do; of a text, the text itself.
    /// @throws Error (BadInput) for an unknown address, a value that the parameter cannot have, or
    ///         a host parameter
    void set(std::string_view address, std::string_view text);
    void set(std::string_view address, const ParamValue& value);
    void reset(std::string_view address);  ///< back to the default

    /// Writes a host parameter, as the code that owns it does for every frame.
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
    std::map<std::string, Entry, std::less<>> values_;  // only what differs from the default
    std::map<std::string, TextParam, std::less<>> text_params_;
    std::map<std::string, std::string, std::less<>> texts_;  // likewise
};

/// Where a parameter lies in the block `Params`.
struct BlockMember {
    Param param;
    std::size_t offset = 0;  ///< bytes
};

/// The std140 block of all parameters that are not static (OpenGL 4.5 core, 7.6.2.2).
struct BlockLayout {
    std::vector<BlockMember> members;
    std::size_t size = 0;  ///< bytes, a multiple of 16; 0 for no members

    friend bool operator==(const BlockLayout& a, const BlockLayout& b);
};

/// Lays out the parameters in their order, static ones left out.
BlockLayout block_layout(const std::vector<Param>& params);

/// The block's bytes, for the uniform buffer at binding 1.
std::vector<std::byte> pack(const BlockLayout& layout, const ParamStore& store);

}  // namespace relevo::shader
