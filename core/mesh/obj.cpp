#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "mesh/builder.h"
#include "mesh/mesh.h"

namespace relevo::mesh {
namespace {

constexpr std::size_t kMaxCorners = 64;  // of a polygon

/// Reads Wavefront OBJ line by line.
class ObjReader {
  public:
    explicit ObjReader(const std::filesystem::path& file) : file_(file) {}

    Mesh read(std::string_view text) {
        std::size_t begin = 0;
        while (begin < text.size()) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            ++line_;
            read_line(text.substr(begin, end - begin));
            begin = end + 1;
        }
        return finished(file_, std::move(mesh_), has_normals_);
    }

  private:
    [[noreturn]] void fail_line(std::string_view message) const {
        fail(file_.string() + ":" + std::to_string(line_), message);
    }

    void read_line(std::string_view line) {
        line = line.substr(0, line.find('#'));
        const std::string_view kind = next_word(line);
        if (kind == "v") {
            read_position(line);
        } else if (kind == "vn") {
            normals_.push_back(turned(vector(line)));
        } else if (kind == "f") {
            read_face(line);
        }
    }

    /// The first word; the line becomes the rest.
    static std::string_view next_word(std::string_view& line) {
        constexpr std::string_view kBlanks = " \t\r";
        const std::size_t begin = std::min(line.find_first_not_of(kBlanks), line.size());
        const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
        const std::string_view word = line.substr(begin, end - begin);
        line.remove_prefix(end);
        return word;
    }

    template <typename Number>
    Number number(std::string_view word) const {
        Number value{};
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty() || error != std::errc() || end != word.data() + word.size())
            fail_line(fmt::format("expected a number but got \"{}\"",
                                  printable(std::string(word.substr(0, 40)))));
        return value;
    }

    glm::vec3 vector(std::string_view& line) const {
        glm::vec3 v;
        for (int i = 0; i < 3; ++i)
            v[i] = number<float>(next_word(line));
        return v;
    }

    void read_position(std::string_view line) {
        if (positions_.size() >= 4 * kMaxVertices)
            fail_line(fmt::format("expected at most {} positions", 4 * kMaxVertices));
        Vertex vertex;
        vertex.position_m = turned(vector(line));
        std::string_view rest = line;
        if (!next_word(rest).empty() && !next_word(rest).empty()) vertex.colour = vector(line);
        positions_.push_back(vertex);
    }

    /// Place in a list of `count`, from 1; negative numbers count from the end.
    std::size_t place(std::string_view word, std::size_t count) const {
        const auto given = number<long>(word);
        const long at = given < 0 ? static_cast<long>(count) + given : given - 1;
        if (given == 0 || at < 0 || at >= static_cast<long>(count))
            fail_line(fmt::format("expected a number from 1 to {} but got {}", count, given));
        return static_cast<std::size_t>(at);
    }

    /// A corner "position", "position/texture", "position//normal" or all three.
    std::uint16_t corner(std::string_view word) {
        const std::size_t first = word.find('/');
        const std::size_t position = place(word.substr(0, first), positions_.size());
        std::optional<std::size_t> normal;
        if (first != word.npos)
            if (const std::size_t second = word.find('/', first + 1); second != word.npos)
                normal = place(word.substr(second + 1), normals_.size());
        if (!normal) has_normals_ = false;
        const auto [known, fresh] =
            corners_.try_emplace({position, normal ? *normal + 1 : 0},
                                 static_cast<std::uint16_t>(mesh_.vertices.size()));
        if (!fresh) return known->second;
        if (mesh_.vertices.size() >= kMaxVertices)
            fail_line(fmt::format("expected at most {} vertices", kMaxVertices));
        Vertex vertex = positions_[position];
        if (normal) vertex.normal = normals_[*normal];
        mesh_.vertices.push_back(vertex);
        return known->second;
    }

    void read_face(std::string_view line) {
        std::vector<std::uint16_t> face;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
            if (face.size() >= kMaxCorners)
                fail_line(fmt::format("expected at most {} corners", kMaxCorners));
            face.push_back(corner(word));
        }
        if (face.size() < 3)
            fail_line(fmt::format("expected at least 3 corners but got {}", face.size()));
        for (std::size_t i = 2; i < face.size(); ++i) {
            for (const std::uint16_t index : {face[0], face[i - 1], face[i]})
                mesh_.indices.push_back(index);
            if (mesh_.indices.size() > 3 * kMaxTriangles)
                fail_line(fmt::format("expected at most {} triangles", kMaxTriangles));
        }
    }

    const std::filesystem::path& file_;
    int line_ = 0;
    std::vector<Vertex> positions_;
    std::vector<glm::vec3> normals_;
    std::map<std::pair<std::size_t, std::size_t>, std::uint16_t> corners_;
    bool has_normals_ = true;  // all corners have one
    Mesh mesh_;
};

}  // namespace

Mesh parse_obj(const std::filesystem::path& file, std::string_view text) {
    return ObjReader(file).read(text);
}

}  // namespace relevo::mesh
