#include "effect/rising.h"

#include <fmt/format.h>

#include "json/object_reader.h"

namespace relevo::effect {

std::vector<Rising> read_rising(json::ObjectReader& object, const std::string& id) {
    std::vector<Rising> all;
    const json::Value* const lists = object.take("rising");
    if (!lists) return all;
    const auto refuse = [&](const json::Value& value) {
        object.fail(
            value.line, "rising",
            "expected a list of lists of two or more parameters but got " + json::describe(value));
    };
    if (lists->kind != json::Value::Kind::Array) refuse(*lists);
    for (const json::Value& list : lists->items) {
        if (list.kind != json::Value::Kind::Array || list.items.size() < 2) refuse(list);
        Rising& rising = all.emplace_back();
        rising.line = list.line;
        for (const json::Value& name : list.items) {
            if (name.kind != json::Value::Kind::String) refuse(list);
            rising.addresses.push_back(id + '.' + name.text);
        }
    }
    return all;
}

std::string fault_of(const Rising& rising, const shader::ParamStore& values) {
    for (std::size_t i = 1; i < rising.addresses.size(); ++i) {
        const std::string &lower = rising.addresses[i - 1], &upper = rising.addresses[i];
        const double a = values.value(lower)[0], b = values.value(upper)[0];
        if (!(b > a))
            return fmt::format("{}: expected more than {}, {:g}, but got {:g}", upper, lower, a, b);
    }
    return {};
}

}  // namespace relevo::effect
