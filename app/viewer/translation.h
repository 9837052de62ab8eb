#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <fmt/format.h>

namespace relevo::viewer {

/// Texts of the window in the user's language. English texts are the keys of the catalogues, which
/// GNU gettext reads; locale/relevo.pot lists them (docs/translating.md). A text without a
/// translation is English.

/// Chooses the language by the environment (LANGUAGE, LC_ALL, LC_MESSAGES, LANG), before other
/// threads start. The locale of the program stays "C": numbers, messages of the system and files
/// do not depend on the language.
/// @param catalogues  the folder of <language>/LC_MESSAGES/relevo.mo
void use_language(const std::filesystem::path& catalogues);

/// The text in the user's language, UTF-8.
const char* tr(const char* english);

/// The label of a widget or window. ImGui identifies it by its English text.
const char* tr_label(const char* english);

/// Marks a text of a table, which tr() or tr_label() translates where it is shown.
constexpr const char* tr_later(const char* english) {
    return english;
}

/// The form of a text for a count, by the rules of the language.
const char* tr_plural(const char* one, const char* many, std::size_t count);

/// Each text of a table.
template <typename Texts>
Texts tr_all(Texts texts) {
    for (const char*& text : texts)
        text = tr(text);
    return texts;
}

/// The translated text with its placeholders filled in; the English one where the placeholders of
/// the translated text do not fit.
std::string format_translated(const char* translated, fmt::string_view english,
                              fmt::format_args arguments);

/// fmt::format() of a text in the user's language.
template <typename... Args>
std::string tr_format(fmt::format_string<Args...> english, Args&&... arguments) {
    const fmt::string_view text = english;
    return format_translated(tr(text.data()), text, fmt::make_format_args(arguments...));
}

/// tr_format() of the form for a count, which is the first argument.
template <typename... Args>
std::string tr_format_plural(fmt::format_string<const std::size_t&, Args...> one,
                             fmt::format_string<const std::size_t&, Args...> many,
                             std::size_t count, Args&&... arguments) {
    const fmt::string_view first = one, second = many;
    return format_translated(tr_plural(first.data(), second.data(), count),
                             count == 1 ? first : second,
                             fmt::make_format_args(count, arguments...));
}

/// Stands for the value in the text of a slider.
constexpr const char* kSliderValue = "\x01";

/// A text with kSliderValue as a format of ImGui's sliders.
/// @param conversion  of the value, such as "%d"
std::string slider_format(const std::string& text, const std::string& conversion);

/// The translated texts that were first shown since the last call, so that fonts have their
/// letters.
std::string take_new_translations();

}  // namespace relevo::viewer
