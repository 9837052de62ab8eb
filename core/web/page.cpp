#include "web/page.h"

#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/base64.h"
#include "base/error.h"
#include "base/paths.h"
#include "base/sha256.h"
#include "base/text.h"

namespace relevo::web {
namespace {

/// Scripts in their order: each uses those before it.
constexpr std::array kScripts{"reader.js", "sun.js",  "sweep.js", "point.js",
                              "draw.js",   "view.js", "bar.js",   "page.js"};

std::string part(const std::string& name) {
    const std::filesystem::path path = share_dir() / "web" / name;
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file || text.empty())
        failed(fmt::format("export web: {}: is missing; install Relevo again",
                           printable(path.string())));
    return text;
}

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : text)
        if (c == '<' || c == '&' || c == '"')
            html += fmt::format("&#{};", static_cast<int>(c));
        else
            html += c;
    return html;
}

/// As a policy names a script or a style.
std::string hash(std::string_view text) {
    const std::string digits = sha256_of_text(text);
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2)
        bytes.push_back(static_cast<std::byte>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    return fmt::format("'sha256-{}'", base64(bytes));
}

std::string policy(const std::string& style, const std::string& script, const char* connect) {
    return fmt::format(
        "default-src 'none'; script-src {}; style-src {}; worker-src blob:; img-src blob:; "
        "connect-src {}; base-uri 'none'; form-action 'none'",
        hash(script), hash(style), connect);
}

/// Replaces each {{name}} of a text once: what is put in is not searched.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& parts) {
    std::string result;
    for (;;) {
        const std::size_t begin = text.find("{{");
        if (begin == text.npos) return result += text;
        const std::size_t end = text.find("}}", begin);
        result += text.substr(0, begin);
        result += parts.at(text.substr(begin + 2, end - begin - 2));
        text.remove_prefix(end + 2);
    }
}

/// What differs between a web page of one file and one with files beside it.
struct Differing {
    std::string data, source, card;
    const char* connect;
};

std::string page(const std::string& title, Differing differing) {
    const std::string style = part("page.css"), sweep = part("sweep.js");
    std::string script;
    for (const char* const name : kScripts)
        script += part(name);
    return filled(part("page.html"), {{"title", escaped(title)},
                                      {"policy", policy(style, script, differing.connect)},
                                      {"card", std::move(differing.card)},
                                      {"style", style},
                                      {"sweep", sweep},
                                      {"source", std::move(differing.source)},
                                      {"data", std::move(differing.data)},
                                      {"script", script}});
}

}  // namespace

std::string page(const std::string& title, std::span<const std::byte> data) {
    return page(title, {base64(data), "", "", "'none'"});
}

std::string page(const std::string& title, const Beside& files) {
    return page(title, {"", fmt::format(" data-src=\"{}\"", files.data),
                        fmt::format("\n<meta property=\"og:title\" content=\"{}\">"
                                    "\n<meta property=\"og:image\" content=\"{}\">",
                                    escaped(title), files.picture),
                        "'self'"});
}

double room_for_data(double page_bytes) {
    const std::string empty = page("", std::span<const std::byte>());
    return (page_bytes - static_cast<double>(empty.size())) * 3 / 4;  // base64
}

}  // namespace relevo::web
