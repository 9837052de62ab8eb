#include "shader/param_store.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"

namespace relevo::shader {

void ParamStore::declare(const std::vector<Param>& params, const std::vector<TextParam>& texts) {
    text_params_.clear();
    for (const TextParam& text : texts)
        text_params_.insert_or_assign(text.address, text);
    params_.clear();
    for (const Param& param : params) {
        params_.insert_or_assign(param.address, param);
        const auto kept = values_.find(param.address);
        if (kept == values_.end()) continue;
        const Entry& entry = kept->second;
        if (entry.type != param.type) {
            log::warning(fmt::format(
                "{}: the type has changed from {} to {}; the value is reset to {}", param.address,
                glsl_name(entry.type), glsl_name(param.type), format_value(param, param.initial)));
            values_.erase(kept);
        } else if (!param.is_host && !is_valid(param, entry.value)) {
            log::warning(fmt::format("{}: the value is not {}; it is reset to {}", param.address,
                                     describe_values(param), format_value(param, param.initial)));
            values_.erase(kept);
        }
    }
}

const Param* ParamStore::find(std::string_view address) const {
    const auto found = params_.find(address);
    return found == params_.end() ? nullptr : &found->second;
}

const Param& ParamStore::param(std::string_view address) const {
    if (const Param* found = find(address)) return *found;
    refuse_unknown(address);
}

void ParamStore::refuse_unknown(std::string_view address) const {
    std::vector<std::string> addresses;
    for (const auto& [known, param] : params_)
        addresses.push_back(known);
    for (const auto& [known, text] : text_params_)
        addresses.push_back(known);
    const std::optional<std::string> near = nearest(address, addresses);
    bad_input(fmt::format("parameter: {}: no such parameter{}", address,
                          near ? fmt::format("; did you mean {}?", *near) : ""));
}

std::vector<const Param*> ParamStore::params() const {
    std::vector<const Param*> result;
    for (const auto& [address, param] : params_)
        result.push_back(&param);
    return result;
}

ParamValue ParamStore::value(std::string_view address) const {
    const Param& known = param(address);
    const auto found = values_.find(address);
    return found == values_.end() ? known.initial : found->second.value;
}

const TextParam* ParamStore::find_text(std::string_view address) const {
    const auto found = text_params_.find(address);
    return found == text_params_.end() ? nullptr : &found->second;
}

std::vector<const TextParam*> ParamStore::texts() const {
    std::vector<const TextParam*> result;
    for (const auto& [address, text] : text_params_)
        result.push_back(&text);
    return result;
}

std::string ParamStore::text(std::string_view address) const {
    const TextParam* const known = find_text(address);
    if (find(address)) bad_input(fmt::format("parameter: {}: a value, not a text", address));
    if (!known) refuse_unknown(address);
    const auto found = texts_.find(address);
    return found == texts_.end() ? known->initial : found->second;
}

const Param& ParamStore::settable(std::string_view address) const {
    const Param& known = param(address);
    if (known.is_host)
        bad_input(fmt::format(
            "parameter: {}: written by the program for every frame; it cannot be set", address));
    return known;
}

void ParamStore::set(std::string_view address, std::string_view text) {
    if (find_text(address)) {
        if (text.find('\0') != std::string_view::npos)
            bad_input(fmt::format("parameter: {}: expected a text without NUL", address));
        texts_.insert_or_assign(std::string(address), std::string(text));
        return;
    }
    const Param& known = settable(address);
    values_.insert_or_assign(known.address, Entry{known.type, parse_value(known, text)});
}

void ParamStore::set(std::string_view address, const ParamValue& value) {
    const Param& known = settable(address);
    if (!is_valid(known, value))
        bad_input(fmt::format(
            "parameter: {}: expected {} but got {}", address, expected_values(known, value),
            fmt::join(value.begin(), value.begin() + component_count(known.type), ",")));
    values_.insert_or_assign(known.address, Entry{known.type, value});
}

void ParamStore::reset(std::string_view address) {
    if (find_text(address))
        texts_.erase(std::string(address));
    else
        values_.erase(param(address).address);
}

void ParamStore::write_host(std::string_view address, const ParamValue& value) {
    const Param& known = param(address);
    if (!known.is_host)
        bad_input(
            fmt::format("parameter: {}: not a host parameter; modules cannot write it", address));
    // Without a range, but the shader needs a whole number.
    const bool whole = known.type == ParamType::Int || known.type == ParamType::Bool;
    if (whole && !is_valid(known, value))
        bad_input(fmt::format("parameter: {}: expected {} but got {}", address,
                              describe_values(known), value[0]));
    values_.insert_or_assign(known.address, Entry{known.type, value});
}

bool operator==(const BlockLayout& a, const BlockLayout& b) {
    return a.size == b.size &&
           std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                      [](const BlockMember& x, const BlockMember& y) {
                          return x.offset == y.offset && x.param.name == y.param.name &&
                                 x.param.type == y.param.type;
                      });
}

BlockLayout block_layout(const std::vector<Param>& params) {
    BlockLayout layout;
    for (const Param& param : params) {
        const auto count = static_cast<std::size_t>(component_count(param.type));
        // A vec3 has the alignment of a vec4, but the next member may use its last four bytes.
        const std::size_t alignment = 4 * (count == 3 ? 4 : count);
        const std::size_t offset = (layout.size + alignment - 1) / alignment * alignment;
        layout.members.push_back({param, offset});
        layout.size = offset + 4 * count;
    }
    layout.size = (layout.size + 15) / 16 * 16;
    return layout;
}

std::vector<std::byte> pack(const BlockLayout& layout, const ParamStore& store) {
    std::vector<std::byte> bytes(layout.size);
    for (const BlockMember& member : layout.members) {
        const Param& param = member.param;
        // After a reload an older program may have members with other declarations.
        const Param* const known = store.find(param.address);
        const ParamValue value =
            known && known->type == param.type ? store.value(param.address) : param.initial;
        std::byte* const at = bytes.data() + member.offset;
        if (param.type == ParamType::Int || param.type == ParamType::Bool) {
            const auto whole = static_cast<std::int32_t>(value[0]);
            std::memcpy(at, &whole, sizeof whole);
        } else {
            const std::array<float, 4> sent = shader_value(param, value);
            std::memcpy(at, sent.data(), 4 * static_cast<std::size_t>(component_count(param.type)));
        }
    }
    return bytes;
}

}  // namespace relevo::shader
