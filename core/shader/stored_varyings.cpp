#include "shader/stored_varyings.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "shader/stitch.h"

namespace relevo::shader {
namespace {

// Outputs 1 to 7, after the G-buffer: GL guarantees eight.
constexpr int kMaxTargets = 7;

int components(const Varying& varying, const std::string& owner) {
    if (varying.type == "float" || varying.type == "int" || varying.type == "uint") return 1;
    if (varying.type.size() == 4 && varying.type.substr(0, 3) == "vec")
        return varying.type[3] - '0';
    throw AuthorError(owner,
                      fmt::format("shader: {}:{}: {}: expected a varying of type float, int, uint, "
                                  "vec2, vec3 or vec4 but got {}",
                                  varying.file, varying.line, varying.name, varying.type));
}

std::string swizzle(const StoredVaryings::Stored& stored) {
    return std::string("xyzw").substr(static_cast<std::size_t>(stored.first),
                                      static_cast<std::size_t>(stored.count));
}

}  // namespace

StoredVaryings::StoredVaryings(const Stage& shading, const std::string& program) {
    std::vector<int> used;
    for (const Varying* varying : shading.varyings()) {
        if (shading.owner_of(varying->name) == "core") continue;
        const int count = components(*varying, shading.owner_of(varying->name));
        std::size_t target = 0;
        while (target < used.size() && used[target] + count > 4)
            ++target;
        if (target == used.size()) used.push_back(0);
        stored_.push_back({varying, static_cast<int>(target), used[target], count});
        used[target] += count;
    }
    targets_ = static_cast<int>(used.size());
    if (targets_ <= kMaxTargets) return;
    std::vector<std::pair<std::string, int>> shares;
    for (const Stored& stored : stored_) {
        const std::string& owner = shading.owner_of(stored.varying->name);
        if (shares.empty() || shares.back().first != owner) shares.emplace_back(owner, 0);
        shares.back().second += stored.count;
    }
    std::vector<std::string> texts;
    for (const auto& [owner, count] : shares)
        texts.push_back(fmt::format("{} {}", owner, count));
    failed(
        fmt::format("shader: {}: expected varyings that fit into {} textures of 4 "
                    "floats but got {}; switch a plugin off (floats: {})",
                    program, kMaxTargets, targets_, fmt::join(texts, ", ")));
}

bool StoredVaryings::holds(const Varying& varying) const {
    return std::ranges::any_of(
        stored_, [&](const Stored& stored) { return stored.varying->name == varying.name; });
}

void StoredVaryings::write_store(TextBuilder& out) const {
    out.heading("stored varyings");
    for (int i = 0; i < targets_; ++i)
        out.line(fmt::format("layout(location = {}) out vec4 stored_{};", i + 1, i));
    out.line("void store_varyings() {");
    for (int i = 0; i < targets_; ++i)
        out.line(fmt::format("    stored_{} = vec4(0.0);", i));
    for (const Stored& stored : stored_)
        out.line(fmt::format("    stored_{}.{} = {}({});", stored.target, swizzle(stored),
                             stored.count == 1 ? "float" : stored.varying->type,
                             stored.varying->name));
    out.line("}");
}

void StoredVaryings::write_load(TextBuilder& out) const {
    out.heading("stored varyings");
    out.line("void load_varyings(in ivec2 pixel) {");
    for (int i = 0; i < targets_; ++i)
        out.line(fmt::format("    vec4 stored_{0} = texelFetch({1}, ivec3(pixel, {0}), 0);", i,
                             kTexture));
    for (const Stored& stored : stored_)
        out.line(fmt::format("    {} = {}(stored_{}.{});", stored.varying->name,
                             stored.varying->type, stored.target, swizzle(stored)));
    out.line("}");
}

}  // namespace relevo::shader
