#include "weather/metar.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "weather/metar_groups.h"

namespace relevo::weather {
namespace {

constexpr std::size_t kMostCharacters = 2000;

[[noreturn]] void fail(const Metar& report, std::string_view group, std::string_view why) {
    bad_input(fmt::format("weather: METAR{}{}: \"{}\": {}", report.station.empty() ? "" : " ",
                          report.station, group.substr(0, 40), why));
}

std::vector<std::string> words_of(std::string_view text) {
    std::string plain(text);
    std::ranges::replace_if(
        plain, [](unsigned char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    std::vector<std::string> words = split(plain, ' ');
    std::erase(words, "");
    return words;
}

bool is_station(std::string_view word) {
    return word.size() == 4 && word[0] >= 'A' && word[0] <= 'Z' &&
           std::ranges::all_of(
               word, [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

/// From here on a report is a forecast or remarks.
bool ends_the_report(std::string_view word) {
    static constexpr std::array<std::string_view, 7> kEnds = {"RMK",   "NOSIG", "BECMG", "TEMPO",
                                                              "TREND", "=",     "$"};
    const auto time_after = [&](std::string_view prefix) {
        return word.size() == 6 && word.starts_with(prefix) &&
               std::ranges::all_of(word.substr(2), [](char c) { return c >= '0' && c <= '9'; });
    };
    return std::ranges::find(kEnds, word) != kEnds.end() || word.starts_with("PROB") ||
           time_after("FM") || time_after("AT") || time_after("TL");
}

class Reader {
  public:
    explicit Reader(std::string_view text) : words_(words_of(text)) {
        report_.text = fmt::format("{}", fmt::join(words_, " "));
    }

    Metar run() {
        if (!words_.empty() && words_.back().size() > 1 && words_.back().back() == '=')
            words_.back().pop_back();
        header();
        while (at_ < words_.size() && !ends_the_report(words_[at_]))
            group();
        return std::move(report_);
    }

  private:
    void header() {
        bool named = false;
        while (at_ < words_.size() && groups::archive_date(words_[at_]))
            ++at_;
        for (; at_ < words_.size(); ++at_) {
            if (words_[at_] == "METAR" || words_[at_] == "SPECI")
                named = true;
            else if (words_[at_] == "COR")
                report_.is_corrected = true;
            else
                break;
        }
        if (at_ == words_.size())
            bad_input("weather: METAR: expected a station, a time and groups of weather but got " +
                      std::string(named ? "no more" : "nothing"));
        if (!is_station(words_[at_]))
            fail(report_, words_[at_],
                 "expected a station of four letters or digits, such as LSZB");
        report_.station = words_[at_++];
        if (at_ < words_.size() && words_[at_] == "NIL") nil();
        if (at_ == words_.size()) fail(report_, report_.station, "expected a time after it");
        try {
            if (!groups::time(words_[at_], report_))
                fail(report_, words_[at_], "expected day, hour and minute such as 011150Z");
        } catch (const groups::Impossible& impossible) {
            fail(report_, words_[at_], impossible.why);
        }
        ++at_;
    }

    [[noreturn]] void nil() const { fail(report_, "NIL", "the station has sent no report"); }

    /// Reads the next group, or two that belong together.
    void group() {
        const std::string& word = words_[at_];
        if (word == "NIL") nil();
        if (word == "AUTO")
            report_.is_auto = true;
        else if (word == "COR" || (word.size() == 3 && word.starts_with("CC")))
            report_.is_corrected = true;
        else if (!miles_and_fraction() && !known(word))
            fail(report_, word, "it is no group of a METAR that has a meaning here");
        ++at_;
    }

    /// "1 1/2SM": takes both if they are there, but for the last word.
    bool miles_and_fraction() {
        if (at_ + 1 >= words_.size() || !groups::is_whole_miles(words_[at_], words_[at_ + 1]))
            return false;
        const double whole = std::stod(words_[at_]);
        if (!known(words_[at_ + 1])) return false;
        *report_.visibility_m += 1609.344 * whole;
        ++at_;
        return true;
    }

    bool known(const std::string& word) {
        try {
            return groups::wind(word, report_) || groups::visibility(word, report_) ||
                   groups::clouds(word, report_) || groups::present_weather(word, report_) ||
                   groups::skipped(word) || groups::temperatures(word, report_) ||
                   groups::pressure(word, report_);
        } catch (const groups::Impossible& impossible) {
            fail(report_, word, impossible.why);
        }
    }

    std::vector<std::string> words_;
    std::size_t at_ = 0;
    Metar report_;
};

}  // namespace

Metar parse_metar(std::string_view text) {
    if (text.size() > kMostCharacters)
        bad_input(fmt::format("weather: METAR: expected at most {} characters but got {}",
                              kMostCharacters, text.size()));
    return Reader(text).run();
}

bool is_report(std::string_view text) {
    std::vector<std::string> words = words_of(text);
    words.erase(words.begin(), std::ranges::find_if_not(words, groups::archive_date));
    if (words.size() < 2) return false;
    if (words[0] == "METAR" || words[0] == "SPECI" || words[1] == "NIL") return true;
    return is_station(words[0]) && words[1].size() == 7 && words[1].back() == 'Z';
}

}  // namespace relevo::weather
