#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json/value.h"

namespace relevo::json {

/// Reads the members of an object. Members that are not read are an error.
class ObjectReader {
  public:
    /// @param path  of the object in the file: "" at the top, "textures.noise" inside
    /// @throws Error (BadInput) if it is no object
    ObjectReader(std::string_view who, std::string_view file, std::string_view path,
                 const Value& value);

    /// The member, or null. The key is known from now on.
    const Value* take(const std::string& key);
    /// Whether there is such a member. Does not read it.
    bool has(std::string_view key) const;
    /// @throws Error (BadInput) if the member is missing
    const Value& need(const std::string& key);

    std::string string(const std::string& key, std::optional<std::string> otherwise = {});
    bool boolean(const std::string& key, bool otherwise);
    /// A number in [min, max], whole if `whole`.
    double number(const std::string& key, double otherwise, double min, double max, bool whole);
    /// A list of strings; none if the member is missing.
    std::vector<std::string> strings(const std::string& key);
    /// One of the words, as its index.
    std::size_t choice(const std::string& key, const std::vector<std::string>& words,
                       std::optional<std::size_t> otherwise = {});

    /// @throws Error (BadInput) for the first member that was not read, with the nearest known key
    void finish() const;

    /// A reader of an object inside, for messages as `path.key`.
    ObjectReader inner(std::string_view key, const Value& value) const;

    /// Throws `Error(BadInput, "who: file:line: path.key: message")`.
    [[noreturn]] void fail(int line, std::string_view key, std::string_view message) const;
    int line() const { return object_.line; }
    /// The line of a member, or of the object if there is no such member.
    int line_of(std::string_view key) const;

  private:
    std::string who_;
    std::string file_;
    std::string path_;
    const Value& object_;
    std::vector<std::string> known_;
};

}  // namespace relevo::json
