#include "shader/colour_ramp.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "shader/annotation.h"
#include "shader/tokenizer.h"

namespace relevo::shader {
namespace {

class RampReader {
  public:
    RampReader(ColourRamp& ramp, std::string_view owner) : ramp_(ramp), owner_(owner) {}

    void annotation(const std::vector<AnnotationWord>& words) {
        for (const AnnotationWord& word : words) {
            if (word.name == "ramp" || word.name == "steps" || word.name == "entries")
                meaning(word);
            else
                detail(word);
        }
        if (kind_.empty())
            fail(
                "a constant's annotation has a ramp(from, to), steps(edge, edge, ...) or "
                "entries(name, ...), which is missing");
        if (ramp_.label.empty())
            fail("{} a label(\"Text\"), which is missing",
                 kind_ == "ramp" ? "a ramp has" : kind_ + " have");
        if (kind_ == "entries" && !ramp_.unit.empty()) fail("entries have names and no unit");
    }

    void colours(std::string_view text) {
        text = trimmed(text);
        constexpr std::string_view kHead = "vec3[]";
        if (text.substr(0, kHead.size()) != kHead) fail_colours();
        text = trimmed(text.substr(kHead.size()));
        if (text.size() < 2 || text.front() != '(' || text.back() != ')') fail_colours();
        text = text.substr(1, text.size() - 2);
        while (!(text = trimmed(text)).empty()) {
            const std::size_t end = text.find(')');
            if (text.substr(0, 5) != "vec3(" || end == std::string_view::npos) fail_colours();
            ramp_.colours.push_back(colour(text.substr(5, end - 5)));
            text = trimmed(text.substr(end + 1));
            if (!text.empty() && text.front() != ',') fail_colours();
            if (!text.empty()) text.remove_prefix(1);
        }
        if (ramp_.colours.size() < (kind_ == "ramp" ? 2 : 1)) fail_colours();
        check_count();
    }

  private:
    /// ramp(), steps() or entries().
    void meaning(const AnnotationWord& word) {
        if (!kind_.empty())
            fail("{}", kind_ == word.name ? kind_ + " is given twice"
                                          : "it can be only one of ramp, steps and entries");
        kind_ = word.name;
        if (kind_ == "ramp")
            ends(word);
        else if (kind_ == "steps")
            steps(word);
        else
            entries(word);
    }

    void detail(const AnnotationWord& word) {
        if (word.name == "unit" && word.arguments.size() == 1) {
            ramp_.unit = word.arguments[0];
        } else if (word.name == "label" && word.arguments.size() == 1) {
            ramp_.label = word.arguments[0];
        } else if (word.name == "where" && word.arguments.size() == 2) {
            ramp_.where = fmt::format("{}.{}", owner_, word.arguments[0]);
            ramp_.where_word = word.arguments[1];
        } else {
            fail(
                "expected ramp(from, to), steps(edge, edge, ...), entries(name, ...), "
                "unit(m), label(\"Text\") or where(parameter, word) but got {}",
                word.written());
        }
    }

    void steps(const AnnotationWord& word) {
        for (const std::string& argument : word.arguments) {
            const std::optional<double> edge = parse_number(argument);
            if (!edge || (!ramp_.edges.empty() && !(*edge > ramp_.edges.back())))
                fail("expected steps(edge, edge, ...), rising numbers, but got {}", word.written());
            ramp_.edges.push_back(*edge);
        }
    }

    void entries(const AnnotationWord& word) {
        ramp_.entries = word.arguments;
        for (const std::string& name : ramp_.entries)
            if (name.empty() || std::ranges::count(ramp_.entries, name) > 1)
                fail("expected entries(name, ...), all different, but got {}", word.written());
    }

    /// Steps have an edge more than colours, entries have as many names.
    void check_count() const {
        const std::size_t colours = ramp_.colours.size();
        if (kind_ == "steps" && ramp_.edges.size() != colours + 1)
            fail("expected {} edges for {} colours but got {}", colours + 1, colours,
                 ramp_.edges.size());
        if (kind_ == "entries" && ramp_.entries.size() != colours)
            fail("expected {} names for {} colours but got {}", colours, colours,
                 ramp_.entries.size());
    }

    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> message, Args&&... args) const {
        source_error(
            ramp_.file, ramp_.line,
            fmt::format("{}: {}", ramp_.name, fmt::format(message, std::forward<Args>(args)...)));
    }
    [[noreturn]] void fail_colours() const {
        fail("{}, vec3[](vec3(0.1, 0.2, 0.3), ...), numbers of 0 to 1",
             kind_ == "ramp" ? "a ramp is at least two colours" : kind_ + " are colours");
    }

    std::array<double, 3> colour(std::string_view text) const {
        const std::vector<std::string> parts = split(text, ',');
        std::array<double, 3> result{};
        if (parts.size() != 3) fail_colours();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::optional<double> part = parse_number(trimmed(parts[k]));
            if (!part || !(*part >= 0 && *part <= 1)) fail_colours();
            result[k] = *part;
        }
        return result;
    }

    void ends(const AnnotationWord& word) {
        ramp_.is_ring = word.arguments.size() == 1 && word.arguments[0] == "ring";
        if (ramp_.is_ring) return;
        if (word.arguments.size() != 2)
            fail("expected ramp(from, to) or ramp(ring) but got ramp({})",
                 fmt::join(word.arguments, ", "));
        ramp_.from = end(word.arguments[0]);
        ramp_.to = end(word.arguments[1]);
        const bool numbers = ramp_.from.of == ColourRamp::End::Of::Number &&
                             ramp_.to.of == ColourRamp::End::Of::Number;
        if (numbers && !(ramp_.from.number < ramp_.to.number))
            fail(
                "expected ramp(from, to), the first below the second, but got "
                "ramp({})",
                fmt::join(word.arguments, ", "));
    }

    ColourRamp::End end(const std::string& text) const {
        if (text == "lowest") return {ColourRamp::End::Of::Lowest, 0, {}};
        if (text == "floor") return {ColourRamp::End::Of::Floor, 0, {}};
        if (text == "highest") return {ColourRamp::End::Of::Highest, 0, {}};
        if (const std::optional<double> number = parse_number(text))
            return {ColourRamp::End::Of::Number, *number, {}};
        return {ColourRamp::End::Of::Param, 0, fmt::format("{}.{}", owner_, text)};
    }

    ColourRamp& ramp_;
    std::string_view owner_;
    std::string kind_;  // "ramp", "steps" or "entries"
};

}  // namespace

ColourRamp parse_ramp(std::string_view owner, std::string_view name, std::string_view value,
                      std::string_view annotation, std::string_view file, int line) {
    ColourRamp ramp;
    ramp.name = name;
    ramp.file = file;
    ramp.line = line;
    RampReader reader(ramp, owner);
    reader.annotation(parse_annotation(annotation, file, line));
    reader.colours(value);
    return ramp;
}

}  // namespace relevo::shader
