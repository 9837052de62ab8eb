#include "effect/json.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/line_counting_iterator.h"
#include "base/text.h"

namespace relevo::effect {
namespace {

/// Builds a Json from the parser's events.
class Builder : public nlohmann::json_sax<nlohmann::json> {
  public:
    Builder(std::string_view who, std::string_view file, const int& line)
        : who_(who), file_(file), line_(line) {}

    Json take() { return std::move(root_); }

    bool null() override { return add({}); }
    bool boolean(bool value) override {
        Json json;
        json.kind = Json::Kind::Bool;
        json.boolean = value;
        return add(std::move(json));
    }
    bool number_integer(number_integer_t value) override {
        return number(static_cast<double>(value));
    }
    bool number_unsigned(number_unsigned_t value) override {
        return number(static_cast<double>(value));
    }
    bool number_float(number_float_t value, const string_t&) override { return number(value); }
    bool string(string_t& value) override {
        Json json;
        json.kind = Json::Kind::String;
        json.text = value;
        return add(std::move(json));
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::Kind::Object); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(Json::Kind::Array); }
    bool end_array() override { return close(); }

    bool key(string_t& value) override {
        const auto [same, fresh] = keys_.back().emplace(value, line_);
        if (!fresh)
            bad_input(fmt::format("{}: {}:{}: {}: given already in line {}", who_, file_, line_,
                                  value, same->second));
        stack_.back().members.emplace_back(value, Json{});
        stack_.back().members.back().second.line = line_;
        return true;
    }

    bool parse_error(std::size_t, const std::string&,
                     const nlohmann::detail::exception& error) override {
        // "[json.exception.parse_error.101] parse error at line 3, column 5: what", or without a
        // place "[json.exception.out_of_range.406] what".
        std::string_view text = error.what();
        if (const std::size_t name = text.find("] "); name != std::string_view::npos)
            text.remove_prefix(name + 2);
        if (const std::size_t column = text.find("column "); column != std::string_view::npos)
            text.remove_prefix(std::min(text.size(), text.find(": ", column) + 2));
        // It quotes the file, whatever its bytes are.
        bad_input(fmt::format("{}: {}:{}: {}", who_, file_, line_, printable(text)));
    }

  private:
    bool number(double value) {
        Json json;
        json.kind = Json::Kind::Number;
        json.number = value;
        return add(std::move(json));
    }

    bool open(Json::Kind kind) {
        // Deeper files are not written by people, and every level costs stack when read.
        constexpr std::size_t kMaxDepth = 64;
        if (stack_.size() >= kMaxDepth)
            bad_input(fmt::format("{}: {}:{}: nested deeper than {} levels", who_, file_, line_,
                                  kMaxDepth));
        Json json;
        json.kind = kind;
        json.line = line_;
        stack_.push_back(std::move(json));
        keys_.emplace_back();
        return true;
    }

    bool close() {
        Json json = std::move(stack_.back());
        stack_.pop_back();
        keys_.pop_back();
        return add(std::move(json));
    }

    bool add(Json json) {
        if (json.line == 0) json.line = line_;
        if (stack_.empty()) {
            root_ = std::move(json);
        } else if (stack_.back().kind == Json::Kind::Array) {
            stack_.back().items.push_back(std::move(json));
        } else {
            Json& member = stack_.back().members.back().second;
            json.line = member.line;
            member = std::move(json);
        }
        return true;
    }

    std::string who_;
    std::string file_;
    const int& line_;
    std::vector<Json> stack_;
    std::vector<std::map<std::string, int>> keys_;  // of each object in stack_, with their lines
    Json root_;
};

}  // namespace

std::string describe(const Json& value) {
    switch (value.kind) {
        case Json::Kind::Null:
            return "null";
        case Json::Kind::Bool:
            return value.boolean ? "true" : "false";
        case Json::Kind::Number:
            return fmt::format("{}", value.number);
        case Json::Kind::String:
            return fmt::format("\"{}\"", printable(value.text));
        case Json::Kind::Array:
            return "a list";
        default:
            return "an object";
    }
}

Json parse_json(std::string_view who, std::string_view file, std::string_view text) {
    // A file of another kind, a DEM for example, has no syntax to be wrong in.
    std::string_view begin = text.substr(0, 512);
    if (begin.starts_with("\xef\xbb\xbf")) begin.remove_prefix(3);
    begin = trimmed(begin);
    if (!begin.empty() && std::string_view("{[\"-0123456789tfn").find(begin[0]) == begin.npos)
        bad_input(fmt::format("{}: {}: not JSON, expected a file that begins with {{", who, file));
    if (text.size() > kMaxJsonBytes)
        bad_input(fmt::format("{}: {}: expected at most {} KiB but got {}", who, file,
                              kMaxJsonBytes >> 10, (text.size() + 1023) >> 10));
    int line = 1;
    Builder builder(who, file, line);
    nlohmann::json::sax_parse(LineCountingIterator(text.data(), &line),
                              LineCountingIterator(text.data() + text.size(), &line), &builder);
    return builder.take();
}

ObjectReader::ObjectReader(std::string_view who, std::string_view file, std::string_view path,
                           const Json& value)
    : who_(who), file_(file), path_(path), object_(value) {
    if (value.kind != Json::Kind::Object)
        fail(value.line, "", fmt::format("expected an object but got {}", describe(value)));
}

void ObjectReader::fail(int line, std::string_view key, std::string_view message) const {
    const std::string dot = path_.empty() || key.empty() ? "" : ".";
    const std::string place = path_ + dot + std::string(key);
    bad_input(fmt::format("{}: {}:{}: {}{}{}", who_, file_, line, place, place.empty() ? "" : ": ",
                          message));
}

int ObjectReader::line_of(std::string_view key) const {
    for (const auto& [name, value] : object_.members)
        if (name == key) return value.line;
    return object_.line;
}

const Json* ObjectReader::take(const std::string& key) {
    if (!contains(known_, key)) known_.push_back(key);
    for (const auto& [name, value] : object_.members)
        if (name == key) return &value;
    return nullptr;
}

bool ObjectReader::has(std::string_view key) const {
    return std::ranges::any_of(object_.members,
                               [&](const auto& member) { return member.first == key; });
}

const Json& ObjectReader::need(const std::string& key) {
    const Json* const value = take(key);
    if (!value) fail(object_.line, "", fmt::format("expected a member \"{}\"", key));
    return *value;
}

std::string ObjectReader::string(const std::string& key, std::optional<std::string> otherwise) {
    const Json* const value = otherwise ? take(key) : &need(key);
    if (!value) return *otherwise;
    if (value->kind != Json::Kind::String || value->text.empty())
        fail(value->line, key, fmt::format("expected a text but got {}", describe(*value)));
    // A terminal would obey them.
    if (value->text != printable(value->text))
        fail(value->line, key,
             fmt::format("expected a text without control characters but got \"{}\"",
                         printable(value->text)));
    return value->text;
}

bool ObjectReader::boolean(const std::string& key, bool otherwise) {
    const Json* const value = take(key);
    if (!value) return otherwise;
    if (value->kind != Json::Kind::Bool)
        fail(value->line, key, fmt::format("expected true or false but got {}", describe(*value)));
    return value->boolean;
}

double ObjectReader::number(const std::string& key, double otherwise, double min, double max,
                            bool whole) {
    const Json* const value = take(key);
    if (!value) return otherwise;
    const double n = value->number;
    if (value->kind != Json::Kind::Number || !(n >= min && n <= max) ||
        (whole && n != std::floor(n)))
        fail(value->line, key,
             fmt::format("expected a {}number in [{}, {}] but got {}", whole ? "whole " : "", min,
                         max, describe(*value)));
    return n;
}

std::vector<std::string> ObjectReader::strings(const std::string& key) {
    std::vector<std::string> result;
    const Json* const value = take(key);
    if (!value) return result;
    if (value->kind != Json::Kind::Array)
        fail(value->line, key,
             fmt::format("expected a list of texts but got {}", describe(*value)));
    for (const Json& item : value->items) {
        if (item.kind != Json::Kind::String || item.text.empty())
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
    const Json* const value = otherwise ? take(key) : &need(key);
    if (!value) return *otherwise;
    const auto found = std::ranges::find(words, value->text);
    if (value->kind != Json::Kind::String || found == words.end()) {
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

}  // namespace relevo::effect
