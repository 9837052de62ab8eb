#include "effect/lines_spec.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::effect {
namespace {

constexpr const char* kWho = "plugin";

}  // namespace

bool is_lines(const json::Value& texture) {
    if (texture.kind != json::Value::Kind::Object) return false;
    return std::ranges::any_of(texture.members, [](const auto& member) {
        return member.first == "kind" && member.second.kind == json::Value::Kind::String &&
               member.second.text == "lines";
    });
}

LinesSpec read_lines_spec(const std::string& file, const std::string& id, const std::string& name,
                          const json::Value& value) {
    json::ObjectReader object(kWho, file, "textures." + name, value);
    object.string("kind");
    LinesSpec spec;
    spec.name = name;
    spec.resource = id + '.' + name;
    spec.line = value.line;
    spec.file = id + '.' + object.string("from");
    spec.attribute = object.string("attribute", "");
    object.finish();
    return spec;
}

void check_lines_spec(const std::string& file, const std::string& id, const LinesSpec& spec,
                      const std::vector<shader::TextParam>& texts) {
    const auto text = std::ranges::find(texts, spec.file, &shader::TextParam::address);
    if (text != texts.end() && text->is_file) return;
    const std::string word = spec.file.substr(id.size() + 1);
    bad_input(
        fmt::format("{}: {}:{}: textures.{}.from: expected a text of kind \"file\"; add "
                    "\"texts\": {{\"{}\": {{\"kind\": \"file\"}}}}",
                    kWho, file, spec.line, spec.name, word));
}

}  // namespace relevo::effect
