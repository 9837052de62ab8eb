#include "shader/texture_units.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"

namespace relevo::shader {
namespace {

/// The name of a texture on the device.
const std::string& same_as(const std::string& resource, const StitchInput& input) {
    const auto found = input.same_textures.find(resource);
    return found == input.same_textures.end() ? resource : found->second;
}

/// The index of a plugin in the calling order, and of a sampler in its file.
std::pair<std::size_t, std::size_t> place_of(const Sampler& sampler, const StitchInput& input) {
    for (std::size_t i = 0; i < input.snippets.size(); ++i) {
        const std::vector<Sampler>& samplers = input.snippets[i]->source.samplers;
        for (std::size_t k = 0; k < samplers.size(); ++k)
            if (&samplers[k] == &sampler) return {i, k};
    }
    return {input.snippets.size(), 0};
}

}  // namespace

TextureUnits::TextureUnits(const std::vector<const Stage*>& stages, const StitchInput& input) {
    std::vector<Read> reads;
    for (const Stage* stage : stages)
        for (const auto& [sampler, owner] : stage->samplers())
            reads.push_back({sampler, owner, same_as(sampler->resource, input), false});
    for (Read& read : reads)
        read.shared = std::ranges::any_of(reads, [&](const Read& other) {
            return other.resource == read.resource && Stage::is_foreign(*other.sampler);
        });
    const auto rank = [&](const Read& read) {
        const int kind = read.owner == "core" ? 0 : read.shared ? 1 : 2;
        return std::tuple(
            kind, kind == 1 ? read.resource : std::string(),
            kind == 2 ? place_of(*read.sampler, input) : std::pair<std::size_t, std::size_t>());
    };
    std::ranges::stable_sort(reads,
                             [&](const Read& a, const Read& b) { return rank(a) < rank(b); });
    for (const Read& read : reads)
        add(read);
    for (std::size_t i = 0; i < textures_.size(); ++i)
        textures_[i].unit.unit = static_cast<int>(i);
}

void TextureUnits::add(const Read& read) {
    const Sampler& sampler = *read.sampler;
    const auto same = std::ranges::find_if(
        textures_, [&](const Texture& texture) { return texture.unit.resource == read.resource; });
    if (same == textures_.end()) {
        textures_.push_back(
            {{0, sampler.name, sampler.type, read.resource, read.owner, {}}, {&sampler}});
        return;
    }
    const Sampler& first = *same->samplers.front();
    if (sampler.type != first.type)
        throw AuthorError(read.owner,
                          fmt::format("shader: {}:{}: {}: expected a {} for the texture {}, "
                                      "as in {}:{}, but got a {}",
                                      sampler.file, sampler.line, sampler.name, first.type,
                                      first.resource, first.file, first.line, sampler.type));
    const bool known = std::ranges::any_of(
        same->samplers, [&](const Sampler* other) { return other->name == sampler.name; });
    if (known) return;
    same->samplers.push_back(&sampler);
    if (sampler.resource != read.resource) same->unit.also.push_back(sampler.resource);
}

void TextureUnits::add_core(const std::string& name, const std::string& type) {
    textures_.push_back({{static_cast<int>(textures_.size()), name, type, name, "core", {}}, {}});
}

void TextureUnits::check(const std::string& program, int max_units) const {
    if (static_cast<int>(textures_.size()) <= max_units) return;
    std::string list;
    for (const Texture& texture : textures_)
        list += fmt::format("\n  unit {}: {} of {}{}", texture.unit.unit, texture.unit.resource,
                            texture.unit.owner,
                            texture.unit.also.empty()
                                ? ""
                                : fmt::format(", also {}", fmt::join(texture.unit.also, ", ")));
    failed(
        fmt::format("shader: {}: expected at most {} textures, as many as this "
                    "device has units, but got {}; switch a plugin off:{}",
                    program, max_units, textures_.size(), list));
}

std::vector<TextureUnit> TextureUnits::units() const {
    std::vector<TextureUnit> result;
    for (const Texture& texture : textures_)
        result.push_back(texture.unit);
    return result;
}

void TextureUnits::write(TextBuilder& out, const Stage& stage) const {
    out.heading("textures");
    for (const auto& [unit, samplers] : textures_) {
        const auto line =
            fmt::format("layout(binding = {}) uniform {} {};", unit.unit, unit.type, unit.name);
        if (samplers.empty() && stage.kind() == StageKind::Fragment) out.line(line);
        const bool used = std::ranges::any_of(
            samplers, [&](const Sampler* sampler) { return stage.reaches(sampler->name); });
        if (!used) continue;
        out.line(line, {unit.owner, samplers[0]->file, samplers[0]->line});
        for (std::size_t i = 1; i < samplers.size(); ++i) {
            const Sampler& sampler = *samplers[i];
            if (stage.reaches(sampler.name))
                out.line(fmt::format("#define {} {}", sampler.name, unit.name),
                         {stage.owner_of(sampler.name), sampler.file, sampler.line});
        }
    }
    out.heading("");
}

}  // namespace relevo::shader
