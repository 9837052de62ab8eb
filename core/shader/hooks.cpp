#include "shader/hooks.h"

#include <algorithm>
#include <array>

#include "shader/tokenizer.h"

namespace relevo::shader {
namespace {

constexpr auto kVertex = HookStage::Vertex;
constexpr auto kFragment = HookStage::Fragment;
constexpr auto kChain = HookKind::Chain;

constexpr std::array kHooks = {
    Hook{"displace", kVertex, kChain, "void displace(in VertexFrame v, inout vec3 position_m)"},
    Hook{"vertex", kVertex, kChain, "void vertex(in VertexFrame v)"},
    Hook{"albedo", kFragment, kChain, "void albedo(inout Surface s)"},
    Hook{"normal", kFragment, kChain, "void normal(inout Surface s)"},
    Hook{"material", kFragment, kChain, "void material(inout Surface s)"},
    Hook{"facing", kFragment, kChain,
         "void facing(in Surface s, in vec3 to_sun, inout float factor)"},
    Hook{"visibility", kFragment, kChain,
         "void visibility(in Surface s, in vec3 to_sun, inout float factor)"},
    Hook{"brdf", kFragment, HookKind::Exclusive,
         "vec3 brdf(in Surface s, in vec3 to_sun, in vec3 to_eye)"},
    Hook{"ambient", kFragment, kChain, "void ambient(in Surface s, inout vec3 irradiance)"},
    Hook{"lit", kFragment, kChain, "void lit(in Surface s, inout vec3 radiance)"},
    Hook{"atmosphere", kFragment, kChain,
         "void atmosphere(in Surface s, in vec3 view, inout vec3 radiance)"},
    Hook{"display", kFragment, kChain, "void display(in Surface s, inout vec4 overlay)"},
    Hook{"side", kFragment, HookKind::Exclusive, "vec3 side(in Surface s, in float down)"},
    Hook{"backdrop", kFragment, HookKind::Exclusive,
         "vec3 backdrop(in vec3 direction, in vec2 at)"},
    Hook{"beyond", kFragment, HookKind::Exclusive, "vec3 beyond(in Surface s, in vec3 view)"},
    Hook{"image", HookStage::Post, kChain, "void image(in Pixel p, inout vec3 radiance)"},
    Hook{"tonemap", HookStage::Post, HookKind::Exclusive, "void tonemap(inout vec3 colour)"},
    Hook{"finish", HookStage::Post, kChain, "void finish(in Pixel p, inout vec3 colour)"},
    Hook{"overlay", HookStage::Post, kChain, "void overlay(in Pixel p, inout vec4 over)"},
    Hook{"sky", HookStage::Any, kChain,
         "void sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance)",
         /*modifies=*/"background_radiance"},
    Hook{"background_radiance", HookStage::Any, HookKind::Service,
         "vec3 background_radiance(in vec3 direction, in bool with_disc)"},
};

}  // namespace

std::span<const Hook> hooks() {
    return kHooks;
}

const Hook* find_hook(std::string_view name) {
    const auto found = std::ranges::find(kHooks, name, &Hook::name);
    return found == kHooks.end() ? nullptr : &*found;
}

std::string Signature::text() const {
    std::string result = type + ' ' + name + '(';
    for (std::size_t i = 0; i < arguments.size(); ++i)
        result += (i > 0 ? ", " : "") + arguments[i].qualifier + ' ' + arguments[i].type;
    return result + ')';
}

bool Signature::matches(const Signature& other) const {
    return type == other.type &&
           std::equal(arguments.begin(), arguments.end(), other.arguments.begin(),
                      other.arguments.end(), [](const Argument& a, const Argument& b) {
                          return a.qualifier == b.qualifier && a.type == b.type;
                      });
}

Signature parse_signature(std::string_view head) {
    const std::vector<Token> tokens = tokenize(head, "").code;
    const auto word = [&](std::size_t i) { return std::string(text_of(head, tokens[i])); };

    Signature result;
    std::size_t open = 0;
    while (open < tokens.size() && word(open) != "(")
        ++open;
    // Precision qualifiers have no effect in desktop GLSL. The type is before the name, which is
    // last.
    result.name = word(open - 1);
    std::size_t type = 0;
    while (word(type) == "highp" || word(type) == "mediump" || word(type) == "lowp")
        ++type;
    for (; type + 1 < open; ++type)
        result.type += word(type);

    std::size_t i = open + 1;
    while (i + 1 < tokens.size()) {
        Argument argument{"in", "", ""};
        int words = 0;
        int depth = 0;  // of [ ], which may be after the type or the name
        std::string brackets;
        for (; word(i) != "," && i + 1 < tokens.size(); ++i) {
            const std::string text = word(i);
            if (text == "in" || text == "out" || text == "inout") {
                argument.qualifier = text;
            } else if (text == "const" || text == "precise" || text == "highp" ||
                       text == "mediump" || text == "lowp") {
                continue;
            } else if (tokens[i].kind == TokenKind::Word && depth == 0) {
                (words++ == 0 ? argument.type : argument.name) += text;
            } else {
                depth += (text == "[") - (text == "]");
                brackets += text;
            }
        }
        argument.type += brackets;
        if (argument.type != "void" || words > 1) result.arguments.push_back(argument);
        ++i;
    }
    return result;
}

}  // namespace relevo::shader
