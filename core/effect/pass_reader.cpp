#include "effect/pass_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "effect/manifest.h"

namespace relevo::effect {
namespace {

using shader::PassSize;
using shader::PluginPass;
using Kind = PluginPass::Kind;
using Output = PluginPass::Output;

constexpr int kMaxPassSide = 4096;
constexpr std::size_t kMaxPasses = 32, kMaxPassBytes = std::size_t{256} << 20;
constexpr double kMinPassScale = 1.0 / 64;
/// Of a fixed number of work groups: as many as texels of the largest textures of fixed size.
constexpr double kMaxInvocations = 1 << 27;
constexpr std::string_view kWholeFrame = "frame";

/// Keys that only some kinds have.
struct KindKey {
    const char* key;
    bool full, volume, compute;
};
constexpr std::array kKindKeys{
    KindKey{"scale", true, false, true},       KindKey{"width", true, false, true},
    KindKey{"height", true, false, true},      KindKey{"size", false, true, true},
    KindKey{"writes", false, false, true},     KindKey{"count", false, false, true},
    KindKey{"local_size", false, false, true}, KindKey{"over", false, false, true},
    KindKey{"work_groups", false, false, true}};

class PassReader {
  public:
    PassReader(json::ObjectReader& object, const std::string& id, const std::string& name)
        : object_(object) {
        pass_.name = name;
        pass_.resource = id + '.' + name;
        pass_.function = id + "_pass_" + name;
        pass_.line = object.line();
    }

    PluginPass run(const std::string& id) {
        pass_.kind = static_cast<Kind>(object_.choice("kind", {"full", "3d", "compute"}, 0));
        check_keys();
        if (pass_.kind == Kind::Compute)
            compute();
        else if (pass_.kind == Kind::Volume)
            volume();
        else
            flat_size();
        texels();
        when(id);
        return std::move(pass_);
    }

  private:
    void check_keys() {
        for (const KindKey& each : kKindKeys) {
            object_.take(each.key);  // known, for the list in messages
            const bool fits = pass_.kind == Kind::Full     ? each.full
                              : pass_.kind == Kind::Volume ? each.volume
                                                           : each.compute;
            if (fits || !object_.has(each.key)) continue;
            std::vector<std::string> kinds;
            if (each.full) kinds.emplace_back("full");
            if (each.volume) kinds.emplace_back("3d");
            if (each.compute) kinds.emplace_back("compute");
            fail(each.key, fmt::format("only passes of kind {} have this, but the kind is {}",
                                       fmt::join(kinds, " or "), word_of(pass_.kind)));
        }
    }

    [[noreturn]] void fail(const char* key, std::string_view message) {
        object_.fail(object_.line_of(key), key, message);
    }

    /// A list of whole numbers from 1, one an axis; 1 for those that are missing at the end.
    /// @param least  that have to be there
    std::array<int, 3> axes(const char* key, std::size_t least, const std::array<int, 3>& most) {
        const json::Value& list = object_.need(key);
        const auto good = [&] {
            if (list.kind != json::Value::Kind::Array || list.items.size() < least ||
                list.items.size() > most.size())
                return false;
            for (std::size_t i = 0; i < list.items.size(); ++i) {
                const json::Value& item = list.items[i];
                if (item.kind != json::Value::Kind::Number || item.number < 1 ||
                    item.number > most[i] || item.number != std::floor(item.number))
                    return false;
            }
            return true;
        };
        if (!good())
            fail(key, fmt::format("expected {} whole numbers from 1 to {}, {} and {}",
                                  least == most.size() ? "3" : fmt::format("{} to 3", least),
                                  most[0], most[1], most[2]));
        std::array<int, 3> result{1, 1, 1};
        for (std::size_t i = 0; i < list.items.size(); ++i)
            result[i] = static_cast<int>(list.items[i].number);
        return result;
    }

    void volume_size() {
        constexpr int kSide = shader::kMaxVolumeSide;
        const auto [width, height, depth] = axes("size", 3, {kSide, kSide, kSide});
        pass_.size = {0, width, height, depth};
        pass_.output = Output::Texture3D;
    }

    void volume() {
        volume_size();
        pass_.local_size = {4, 4, 4};
        pass_.over = pass_.size;
    }

    /// A fraction of the frame's size, or a fixed size.
    void flat_size() {
        PassSize& size = pass_.size;
        if (object_.has("width") || object_.has("height")) {
            if (object_.has("scale"))
                fail("scale",
                     "expected a scale of the frame's size, or width and height, not both");
            object_.need("width");
            object_.need("height");
            size.scale = 0;
            size.width = static_cast<int>(object_.number("width", 1, 1, kMaxPassSide, true));
            size.height = static_cast<int>(object_.number("height", 1, 1, kMaxPassSide, true));
            return;
        }
        size.scale = object_.number("scale", 1, kMinPassScale, 1, false);
        int exponent = 0;
        if (std::frexp(size.scale, &exponent) != 0.5)
            fail("scale", fmt::format("expected 1, 0.5, 0.25 or another half of these down to {} "
                                      "but got {}",
                                      kMinPassScale, size.scale));
    }

    void compute() {
        constexpr std::array kOutputs{Output::Texture, Output::Floats, Output::Uints};
        pass_.output = kOutputs[object_.choice("writes", {"texture", "floats", "uints"}, 0)];
        if (pass_.is_buffer())
            buffer();
        else if (object_.has("count"))
            fail("count", "only \"writes\": \"floats\" or \"uints\" has a count");
        else if (object_.has("size"))
            compute_volume();
        else
            flat_size();
        work_groups();
    }

    void compute_volume() {
        for (const char* key : {"scale", "width", "height"})
            if (object_.has(key)) fail(key, "expected either this or a \"size\" of three sides");
        volume_size();
    }

    void buffer() {
        for (const char* key : {"scale", "width", "height", "size", "format", "filter"})
            if (object_.has(key)) fail(key, "a buffer has no such key; its length is \"count\"");
        object_.need("count");
        const double count = object_.number("count", 1, 1, shader::kMaxBufferElements, true);
        pass_.size = {0, static_cast<int>(count), 1, 1};
    }

    void work_groups() {
        constexpr int kSide = shader::kMaxLocalSide, kGroups = shader::kMaxWorkGroups;
        pass_.local_size = axes("local_size", 1, {kSide, kSide, shader::kMaxLocalDepth});
        const auto& [x, y, z] = pass_.local_size;
        if (double{1} * x * y * z > shader::kMaxLocalInvocations)
            fail("local_size",
                 fmt::format(
                     "expected at most {} invocations in a work group, which every device has, but "
                     "got {} x {} x {}",
                     shader::kMaxLocalInvocations, x, y, z));
        pass_.over = pass_.size;
        if (object_.has("work_groups")) {
            if (object_.has("over")) fail("over", "expected this or \"work_groups\", not both");
            pass_.work_groups = axes("work_groups", 1, {kGroups, kGroups, kGroups});
            const auto& [across, up, deep] = pass_.work_groups;
            const double all = double{1} * across * up * deep * x * y * z;
            if (all > kMaxInvocations)
                fail("work_groups",
                     fmt::format("expected at most {} million invocations but got {:.0f} million",
                                 kMaxInvocations / 1e6, all / 1e6));
        } else if (object_.has("over")) {
            pass_.over_name = object_.string("over");
        }
    }

    void texels() {
        std::vector<std::string> formats;
        for (const shader::PassFormat& format : shader::kPassFormats)
            formats.emplace_back(format.word);
        pass_.format = shader::kPassFormats[object_.choice("format", formats, 0)].format;
        pass_.linear = object_.choice("filter", {"linear", "nearest"}, 0) == 0;
    }

    void when(const std::string& id) {
        using When = PluginPass::When;
        pass_.when =
            static_cast<When>(object_.choice("when", {"frame", "sun", "changed", "dem"}, 0));
        for (const std::string& word : object_.strings("parameters")) {
            if (!is_word(word))
                fail("parameters",
                     fmt::format("expected words of a-z, 0-9 and _ but got \"{}\"", word));
            pass_.parameters.push_back(id + '.' + word);
        }
        if ((pass_.when == When::Changed) == pass_.parameters.empty())
            fail("parameters",
                 "expected the parameters that change it with \"when\": "
                 "\"changed\", and only then");
    }

    json::ObjectReader& object_;
    PluginPass pass_;
};

/// Bytes of what has a fixed size.
std::size_t bytes_of(const PluginPass& pass) {
    const std::size_t texel =
        pass.is_buffer() ? sizeof(float) : static_cast<std::size_t>(layout_of(pass.format).bytes());
    return static_cast<std::size_t>(pass.size.width) * static_cast<std::size_t>(pass.size.height) *
           static_cast<std::size_t>(pass.size.depth) * texel;
}

}  // namespace

PluginPass read_pass(json::ObjectReader& object, const std::string& id, const std::string& name) {
    return PassReader(object, id, name).run(id);
}

void complete_passes(const json::ObjectReader& object, std::vector<PluginPass>& passes) {
    std::size_t bytes = 0;
    for (PluginPass& pass : passes) {
        bytes += bytes_of(pass);
        if (pass.over_name.empty()) continue;
        if (pass.over_name == kWholeFrame) {
            pass.over = {};
            continue;
        }
        const auto other = std::ranges::find(passes, pass.over_name, &PluginPass::name);
        if (other == passes.end())
            object.fail(pass.line, "passes." + pass.name + ".over",
                        fmt::format("expected \"{}\" or the name of a pass but got \"{}\"",
                                    kWholeFrame, pass.over_name));
        pass.over = other->size;
    }
    if (passes.size() > kMaxPasses || bytes > kMaxPassBytes)
        object.fail(object.line_of("passes"), "passes",
                    fmt::format("expected at most {} passes and {} MiB of fixed size but got "
                                "{} and {}",
                                kMaxPasses, kMaxPassBytes >> 20, passes.size(),
                                (bytes + (1 << 20) - 1) >> 20));
}

}  // namespace relevo::effect
