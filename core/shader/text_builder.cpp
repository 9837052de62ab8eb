#include "shader/text_builder.h"

#include <algorithm>

namespace relevo::shader {

void TextBuilder::line(std::string_view text, LineOrigin origin) {
    if (!heading_.empty()) {
        stage_.text += "\n// " + heading_ + '\n';
        stage_.lines.insert(stage_.lines.end(), 2, {});
        heading_.clear();
    }
    stage_.text += text;
    stage_.text += '\n';
    stage_.lines.push_back(std::move(origin));
}

void TextBuilder::item(const Source& source, const Item& item) {
    const std::string_view text = source.text;
    // Spaces replace the other text before it on its line, so that columns stay.
    std::size_t start = item.begin;
    while (start > 0 && text[start - 1] != '\n')
        --start;
    std::string indent(text.substr(start, item.begin - start));
    for (char& c : indent)
        if (c != '\t') c = ' ';
    const std::string piece = indent + std::string(text.substr(item.begin, item.end - item.begin));

    if (heading_.empty() && start >= 2 && text.substr(start - 2, 2) == "\n\n")
        line("", {source.owner, source.file, item.line - 1});
    int number = item.line;
    for (std::size_t at = 0; at <= piece.size(); ++number) {
        const std::size_t end = std::min(piece.find('\n', at), piece.size());
        line(std::string_view(piece).substr(at, end - at), {source.owner, source.file, number});
        at = end + 1;
    }
}

}  // namespace relevo::shader
