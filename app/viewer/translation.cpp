#include "viewer/translation.h"

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include <libintl.h>
#include <locale.h>

namespace relevo::viewer {
namespace {

constexpr const char* kDomain = "relevo";

/// Of the messages alone: the other categories are those of "C".
struct FreeLocale {
    using pointer = locale_t;
    void operator()(locale_t locale) const { freelocale(locale); }
};
using Locale = std::unique_ptr<locale_t, FreeLocale>;

struct Language {
    Locale locale;
    std::mutex mutex;                           ///< of what follows
    std::map<std::string, std::string> labels;  ///< by their English texts
    std::set<const char*> shown;
    std::string new_texts;
};

/// None: English. Is set before other threads start.
std::unique_ptr<Language> language;

/// Has gettext read the locale of the messages, on this thread.
class InLocale {
  public:
    explicit InLocale(const Locale& locale) : before_(uselocale(locale.get())) {}
    ~InLocale() { uselocale(before_); }
    InLocale(const InLocale&) = delete;
    InLocale& operator=(const InLocale&) = delete;

  private:
    locale_t before_;
};

/// @param text  of a catalogue, where it stays
const char* noted(const char* text) {
    const std::lock_guard lock(language->mutex);
    if (language->shown.insert(text).second) language->new_texts += text;
    return text;
}

}  // namespace

void use_language(const std::filesystem::path& catalogues) {
    language.reset();
    auto wanted = std::make_unique<Language>();
    wanted->locale.reset(newlocale(LC_MESSAGES_MASK, "", nullptr));
    if (!wanted->locale) return;
    bindtextdomain(kDomain, catalogues.c_str());
    bind_textdomain_codeset(kDomain, "UTF-8");
    const InLocale in(wanted->locale);
    // The translation of "" is the header of a catalogue.
    if (*dgettext(kDomain, "") != '\0') language = std::move(wanted);
}

const char* tr(const char* english) {
    if (!language || *english == '\0') return english;
    const InLocale in(language->locale);
    const char* const text = dgettext(kDomain, english);
    return text == english ? english : noted(text);
}

const char* tr_label(const char* english) {
    const char* const text = tr(english);
    if (text == english) return english;
    const std::lock_guard lock(language->mutex);
    std::string& label = language->labels[english];
    if (label.empty()) label = fmt::format("{}###{}", text, english);
    return label.c_str();
}

const char* tr_plural(const char* one, const char* many, std::size_t count) {
    if (!language) return count == 1 ? one : many;
    const InLocale in(language->locale);
    const char* const text = dngettext(kDomain, one, many, count);
    return text == one || text == many ? text : noted(text);
}

std::string format_translated(const char* translated, fmt::string_view english,
                              fmt::format_args arguments) {
    try {
        return fmt::vformat(translated, arguments);
    } catch (const fmt::format_error&) {
        return fmt::vformat(english, arguments);
    }
}

std::string slider_format(const std::string& text, const std::string& conversion) {
    std::string format;
    for (const char letter : text) {
        if (letter == *kSliderValue)
            format += conversion;
        else
            format += letter == '%' ? std::string("%%") : std::string(1, letter);
    }
    return format;
}

std::string take_new_translations() {
    if (!language) return {};
    const std::lock_guard lock(language->mutex);
    return std::exchange(language->new_texts, {});
}

}  // namespace relevo::viewer
