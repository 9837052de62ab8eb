#include "sun/posix_rule.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "sun/time.h"

namespace relevo::sun {

namespace {

/// A day of the year and the time of that day at which clocks are changed.
struct YearlyMoment {
    char kind =
        'M';  // M: month, week, weekday; J: day 1-365, 29 February not counted; N: day 0-365
    int month = 0, week = 0, weekday = 0;
    int day = 0;
    int time_s = 2 * 3600;  // of the wall clock before the change

    std::int64_t wall_s(int year) const {
        constexpr Date kEpoch{1970, 1, 1};
        const int new_year = days_between(kEpoch, {year, 1, 1});
        int days = 0;
        if (kind == 'M') {
            const int first = days_between(kEpoch, {year, month, 1});
            const int first_weekday = ((first + 4) % 7 + 7) % 7;  // 1970-01-01 was a Thursday
            days = first + (weekday - first_weekday + 7) % 7 + 7 * (week - 1);
            const int next =
                days_between(kEpoch, month == 12 ? Date{year + 1, 1, 1} : Date{year, month + 1, 1});
            if (days >= next) days -= 7;
        } else if (kind == 'J') {
            const bool leap = days_between({year, 2, 1}, {year, 3, 1}) == 29;
            days = new_year + day - 1 + (leap && day >= 60 ? 1 : 0);
        } else {
            days = new_year + day;
        }
        return std::int64_t{days} * 86400 + time_s;
    }
};

class RuleReader {
  public:
    explicit RuleReader(std::string_view text) : rest_(text) {}

    bool at_end() const { return rest_.empty(); }
    bool next_is(char c) const { return rest_.starts_with(c); }
    bool take(char c) {
        if (!next_is(c)) return false;
        rest_.remove_prefix(1);
        return true;
    }

    std::optional<std::string> name() {
        const bool quoted = take('<');
        std::size_t length = 0;
        while (length < rest_.size() &&
               (quoted ? rest_[length] != '>'
                       : std::isalpha(static_cast<unsigned char>(rest_[length])) != 0))
            ++length;
        const std::string found(rest_.substr(0, length));
        rest_.remove_prefix(length);
        if (found.empty() || (quoted && !take('>'))) return std::nullopt;
        return found;
    }

    std::optional<int> number() {
        int value = 0;
        std::size_t length = 0;
        while (length < rest_.size() && length < 4 && rest_[length] >= '0' && rest_[length] <= '9')
            value = 10 * value + (rest_[length++] - '0');
        if (length == 0) return std::nullopt;
        rest_.remove_prefix(length);
        return value;
    }

    /// [+-]hh[:mm[:ss]]
    std::optional<int> time_s() {
        const bool negative = take('-');
        if (!negative) take('+');
        const auto hours = number();
        if (!hours) return std::nullopt;
        int total = *hours * 3600;
        for (int unit = 60; unit >= 1 && take(':'); unit /= 60) {
            const auto part = number();
            if (!part) return std::nullopt;
            total += *part * unit;
        }
        return negative ? -total : total;
    }

    std::optional<YearlyMoment> moment() {
        YearlyMoment moment;
        if (take('M')) {
            const auto month = number();
            if (!month || *month < 1 || *month > 12 || !take('.')) return std::nullopt;
            const auto week = number();
            if (!week || *week < 1 || *week > 5 || !take('.')) return std::nullopt;
            const auto weekday = number();
            if (!weekday || *weekday > 6) return std::nullopt;
            moment.month = *month;
            moment.week = *week;
            moment.weekday = *weekday;
        } else {
            moment.kind = take('J') ? 'J' : 'N';
            const auto day = number();
            if (!day) return std::nullopt;
            moment.day = *day;
        }
        if (take('/')) {
            const auto time = time_s();
            if (!time) return std::nullopt;
            moment.time_s = *time;
        }
        return moment;
    }

  private:
    std::string_view rest_;
};

}  // namespace

std::vector<OffsetChange> posix_rule_changes(std::string_view rule, int first_year, int last_year) {
    RuleReader reader(rule);
    const auto standard = reader.name();
    if (!standard) return {};
    const auto west_s = reader.time_s();
    if (!west_s || reader.at_end()) return {};
    const int standard_s = -*west_s;
    const auto saving = reader.name();
    if (!saving) return {};
    int saving_s = standard_s + 3600;
    if (!reader.next_is(',')) {
        const auto given = reader.time_s();
        if (!given) return {};
        saving_s = -*given;
    }
    if (!reader.take(',')) return {};
    const auto start = reader.moment();
    if (!start || !reader.take(',')) return {};
    const auto end = reader.moment();
    if (!end || !reader.at_end()) return {};

    std::vector<OffsetChange> changes;
    for (int year = first_year; year <= last_year; ++year) {
        changes.push_back({start->wall_s(year) - standard_s, saving_s, *saving});
        changes.push_back({end->wall_s(year) - saving_s, standard_s, *standard});
    }
    std::ranges::sort(
        changes, [](const OffsetChange& a, const OffsetChange& b) { return a.unix_s < b.unix_s; });
    return changes;
}

}  // namespace relevo::sun
