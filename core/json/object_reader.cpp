#include "json/object_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"

namespace relevo::json {

ObjectReader::ObjectReader(std::string_view who, std::string_view file, std::string_view path,
                           const Value& value)
    : who_(who), file_(file), path_(path), object_(value) {
    if (value.kind != Value::Kind::Object)
        fail(value.line, "", fmt::format("expected an object but got {}", describe(value)));
}

void ObjectReader::fail(int line, std::string_view key, std::string_view message) const {
    const std::string dot = path_.empty() || key.empty() ? "" : ".";
    const std::string place = path_ + dot + std::string(key);
    bad_input(fmt::format("{}: {}:{}: {}{}{}", who_, file_, line, place, place.empty() ? "" : ": ",
                          message));
}

ObjectReader ObjectReader::inner(std::string_view key, const Value& value) const {
    const std::string dot = path_.empty() ? "" : ".";
    return {who_, file_, path_ + dot + std::string(key), value};
}

int ObjectReader::line_of(std::string_view key) const {
    for (const auto& [name, value] : object_.members)
        if (name == key) return value.line;
    return object_.line;
}

const Value* ObjectReader::take(const std::string& key) {
    if (!contains(known_, key)) known_.push_back(key);
    for (const auto& [name, value] : object_.members)
        if (name == key) return &value;
    return nullptr;
}

bool ObjectReader::has(std::string_view key) const {
    return std::ranges::any_of(object_.members,
                               [&](const auto& member) { return member.name == key; });
}

const Value& ObjectReader::need(const std::string& key) {
    const Value* const value = take(key);
    if (!value) fail(object_.line, "", fmt::format("expected a member \"{}\"", key));
    return *value;
}

std::string ObjectReader::string(const std::string& key, std::optional<std::string> otherwise) {
    const Value* const value = otherwise ? take(key) : &need(key);
    if (!value) return *otherwise;
    if (value->kind != Value::Kind::String || value->text.empty())
        fail(value->line, key, fmt::format("expected a text but got {}", describe(*value)));
    // A terminal would execute them.
    if (value->text != printable(value->text))
        fail(value->line, key,
             fmt::format("expected a text without control characters but got \"{}\"",
                         printable(value->text)));
    return value->text;
}

bool ObjectReader::boolean(const std::string& key, bool otherwise) {
    const Value* const value = take(key);
    if (!value) return otherwise;
    if (value->kind != Value::Kind::Bool)
        fail(value->line, key, fmt::format("expected true or false but got {}", describe(*value)));
    return value->boolean;
}

double ObjectReader::number(const std::string& key, double otherwise, double min, double max,
                            bool whole) {
    const Value* const value = take(key);
    if (!value) return otherwise;
    const double n = value->number;
    if (value->kind != Value::Kind::Number || !(n >= min && n <= max) ||
        (whole && n != std::floor(n)))
        fail(value->line, key,
             fmt::format("expected a {}number in [{}, {}] but got {}", whole ? "whole " : "", min,
                         max, describe(*value)));
    return n;
}

std::vector<std::string> ObjectReader::strings(const std::string& key) {
    std::vector<std::string> result;
    const Value* const value = take(key);
    if (!value) return result;
    if (value->kind != Value::Kind::Array)
        fail(value->line, key,
             fmt::format("expected a list of texts but got {}", describe(*value)));
    for (const Value& item : value->items) {
        if (item.kind != Value::Kind::String || item.text.empty())
            fail(item.line, key,
                 fmt::format("expected a list of texts but got {} in it", describe(item)));
        if (item.text != printable(item.text))
            fail(item.line, key,
                 fmt::format("expected a list of texts without control characters but got {} in it",
                             describe(item)));
        if (contains(result, item.text))
            fail(item.line, key, fmt::format("\"{}\" is listed twice", item.text));
        result.push_back(item.text);
    }
    return result;
}

std::size_t ObjectReader::choice(const std::string& key, const std::vector<std::string>& words,
                                 std::optional<std::size_t> otherwise) {
    const Value* const value = otherwise ? take(key) : &need(key);
    if (!value) return *otherwise;
    const auto found = std::ranges::find(words, value->text);
    if (value->kind != Value::Kind::String || found == words.end()) {
        const std::optional<std::string> near = nearest(value->text, words);
        fail(value->line, key,
             fmt::format("expected one of {} but got {}{}", fmt::join(words, ", "),
                         describe(*value), near ? fmt::format("; did you mean {}?", *near) : ""));
    }
    return static_cast<std::size_t>(found - words.begin());
}

void ObjectReader::finish() const {
    for (const auto& [name, value] : object_.members) {
        if (contains(known_, name)) continue;
        const std::optional<std::string> near = nearest(name, known_);
        fail(value.line, name,
             near ? fmt::format("no such key; did you mean \"{}\"?", *near)
                  : fmt::format("no such key; there are {}", fmt::join(known_, ", ")));
    }
}

}  // namespace relevo::json
