#include "json/value.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/line_counting_iterator.h"
#include "base/text.h"

namespace relevo::json {
namespace {

/// Builds a Value from the parser's events.
class Builder : public nlohmann::json_sax<nlohmann::json> {
  public:
    Builder(std::string_view who, std::string_view file, const int& line)
        : who_(who), file_(file), line_(line) {}

    Value take() { return std::move(root_); }

    bool null() override { return add({}); }
    bool boolean(bool value) override {
        Value result;
        result.kind = Value::Kind::Bool;
        result.boolean = value;
        return add(std::move(result));
    }
    bool number_integer(number_integer_t value) override {
        return number(static_cast<double>(value));
    }
    bool number_unsigned(number_unsigned_t value) override {
        return number(static_cast<double>(value));
    }
    bool number_float(number_float_t value, const string_t&) override { return number(value); }
    bool string(string_t& value) override {
        Value result;
        result.kind = Value::Kind::String;
        result.text = value;
        return add(std::move(result));
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Value::Kind::Object); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(Value::Kind::Array); }
    bool end_array() override { return close(); }

    bool key(string_t& value) override {
        const auto [same, fresh] = keys_.back().emplace(value, line_);
        if (!fresh)
            bad_input(fmt::format("{}: {}:{}: {}: given already in line {}", who_, file_, line_,
                                  value, same->second));
        stack_.back().members.push_back({value, Value{}});
        stack_.back().members.back().value.line = line_;
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
        // It quotes the file, which may have any bytes.
        bad_input(fmt::format("{}: {}:{}: {}", who_, file_, line_, printable(text)));
    }

  private:
    bool number(double value) {
        Value result;
        result.kind = Value::Kind::Number;
        result.number = value;
        return add(std::move(result));
    }

    bool open(Value::Kind kind) {
        // People do not write deeper files, and every level needs stack.
        constexpr std::size_t kMaxDepth = 64;
        if (stack_.size() >= kMaxDepth)
            bad_input(fmt::format("{}: {}:{}: nested deeper than {} levels", who_, file_, line_,
                                  kMaxDepth));
        Value result;
        result.kind = kind;
        result.line = line_;
        stack_.push_back(std::move(result));
        keys_.emplace_back();
        return true;
    }

    bool close() {
        Value result = std::move(stack_.back());
        stack_.pop_back();
        keys_.pop_back();
        return add(std::move(result));
    }

    bool add(Value value) {
        if (value.line == 0) value.line = line_;
        if (stack_.empty()) {
            root_ = std::move(value);
        } else if (stack_.back().kind == Value::Kind::Array) {
            stack_.back().items.push_back(std::move(value));
        } else {
            Value& member = stack_.back().members.back().value;
            value.line = member.line;
            member = std::move(value);
        }
        return true;
    }

    std::string who_;
    std::string file_;
    const int& line_;
    std::vector<Value> stack_;
    std::vector<std::map<std::string, int>> keys_;  // of each object in stack_, with their lines
    Value root_;
};

}  // namespace

std::string describe(const Value& value) {
    switch (value.kind) {
        case Value::Kind::Null:
            return "null";
        case Value::Kind::Bool:
            return value.boolean ? "true" : "false";
        case Value::Kind::Number:
            return fmt::format("{}", value.number);
        case Value::Kind::String:
            return fmt::format("\"{}\"", printable(value.text));
        case Value::Kind::Array:
            return "a list";
        default:
            return "an object";
    }
}

Value parse(std::string_view who, std::string_view file, std::string_view text, std::size_t most) {
    // A syntax error in a file of another kind, for example a DEM, would not help.
    std::string_view begin = text.substr(0, 512);
    if (begin.starts_with("\xef\xbb\xbf")) begin.remove_prefix(3);
    begin = trimmed(begin);
    if (!begin.empty() && std::string_view("{[\"-0123456789tfn").find(begin[0]) == begin.npos)
        bad_input(fmt::format("{}: {}: not JSON, expected a file that begins with {{", who, file));
    if (text.size() > most)
        bad_input(fmt::format("{}: {}: expected at most {} KiB but got {}", who, file, most >> 10,
                              (text.size() + 1023) >> 10));
    int line = 1;
    Builder builder(who, file, line);
    nlohmann::json::sax_parse(LineCountingIterator(text.data(), &line),
                              LineCountingIterator(text.data() + text.size(), &line), &builder);
    return builder.take();
}

}  // namespace relevo::json
