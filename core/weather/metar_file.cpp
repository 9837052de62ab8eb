#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/log.h"
#include "base/text.h"
#include "weather/metar.h"
#include "weather/metar_groups.h"

namespace relevo::weather {
namespace {

constexpr std::size_t kMostTried = 1000;  // lines from the end; errors take time

/// "2026/06/01 11:50", which NOAA's files have before each report.
bool is_date_line(std::string_view line) {
    std::vector<std::string> words = split(line, ' ');
    std::erase(words, "");
    return std::ranges::all_of(words, groups::archive_date);
}

/// Reports of a file: lines, with those joined that go on after blanks.
std::vector<std::string> reports_of(const std::string& text) {
    std::vector<std::string> reports;
    for (const std::string& line : split(text, '\n')) {
        const std::string_view content = trimmed(line);
        if (content.empty() || is_date_line(content) || content.front() == '#') continue;
        const bool goes_on = (line[0] == ' ' || line[0] == '\t') && !reports.empty();
        if (goes_on)
            reports.back() += " " + std::string(content);
        else
            reports.emplace_back(content);
    }
    return reports;
}

}  // namespace

namespace {

/// What is wrong with a report, without words of it: a scene may name any file.
std::string without_text(std::string_view fault) {
    const std::size_t end = fault.rfind("\": ");
    return "weather: METAR: " +
           std::string(end == fault.npos ? "cannot be read" : fault.substr(end + 3));
}

}  // namespace

bool is_forecast_file(const std::string& text_or_file) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(text_or_file, unknown)) return false;
    InputStream file = input_stream(AllowedName(text_or_file));
    std::string head(1024, ' ');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    return head.find('\0') != std::string::npos || head.starts_with("<VRTDataset");
}

std::string report_of(const std::string& text_or_file) {
    std::error_code unknown;
    if (is_report(text_or_file) || (text_or_file.find(' ') != std::string::npos &&
                                    !std::filesystem::exists(text_or_file, unknown)))
        return parse_metar(text_or_file).text;
    const std::vector<std::string> reports = reports_of(read_text(text_or_file, "weather"));
    if (reports.empty())
        bad_input(fmt::format("weather: {}: expected a METAR but found none", text_or_file));
    std::string fault;
    const std::size_t first = reports.size() - std::min(reports.size(), kMostTried);
    for (std::size_t i = reports.size(); i-- > first;) {
        try {
            const Metar report = parse_metar(reports[i]);
            if (!fault.empty())
                log::warning(fmt::format("{}; {}: the report of day {}, {:02}:{:02}, is used",
                                         fault, text_or_file, report.day, report.hour,
                                         report.minute));
            return report.text;
        } catch (const Error& error) {
            if (fault.empty()) fault = without_text(error.what());
        }
    }
    bad_input(fmt::format("{}; in {}{}", fault, text_or_file,
                          reports.size() > 1 ? ", whose other lines are no METAR either" : ""));
}

}  // namespace relevo::weather
