#include "dem/gpx.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>

#include <expat.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/input_file.h"
#include "base/text.h"

namespace relevo::dem {
namespace {

constexpr int kBlockBytes = 1 << 16;
// Bounds of what Expat and we hold at once, whatever the file is.
constexpr XML_Index kMostTokenBytes = 1 << 20;
constexpr std::size_t kMostTextBytes = 1 << 16;
constexpr std::size_t kMostElements = 64;

struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

/// Windows-1252, which older programs of GPS makers write; Expat knows UTF and Latin-1 itself.
int windows_1252(void*, const XML_Char* name, XML_Encoding* encoding) {
    if (!equal_ignoring_case(name, "windows-1252")) return XML_STATUS_ERROR;
    constexpr int kUpper[32] = {0x20ac, -1,     0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, -1,     0x017d, -1,
                                -1,     0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, -1,     0x017e, 0x0178};
    for (int i = 0; i < 256; ++i)
        encoding->map[i] = i >= 0x80 && i < 0xa0 ? kUpper[i - 0x80] : i;
    encoding->data = nullptr;
    encoding->convert = nullptr;
    encoding->release = nullptr;
    return XML_STATUS_OK;
}

/// A time of GPX, which is UTC also where it does not say so.
std::string with_zone(std::string_view text) {
    constexpr std::size_t kDateLength = 10;  // its hyphens are no offset
    const bool has_clock = text.find(':') != text.npos;
    const bool has_zone =
        text.size() > kDateLength && text.find_first_of("Zz+-", kDateLength) != text.npos;
    return std::string(text) + (has_clock && !has_zone ? "Z" : "");
}

class Reader {
  public:
    Reader(const FileErrors& errors, GpxKind kind,
           const std::function<void(int, VectorPoint&&)>& visit)
        : errors_(errors), visit_(visit), parser_(XML_ParserCreate(nullptr)) {
        switch (kind) {
            case GpxKind::Waypoints:
                point_path_ = "/gpx/wpt";
                break;
            case GpxKind::Tracks:
                line_path_ = "/gpx/trk";
                point_path_ = "/gpx/trk/trkseg/trkpt";
                break;
            case GpxKind::Routes:
                line_path_ = "/gpx/rte";
                point_path_ = "/gpx/rte/rtept";
                break;
        }
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), on_start, on_end);
        XML_SetCharacterDataHandler(parser_.get(), on_text);
        XML_SetEntityDeclHandler(parser_.get(), on_entity);
        XML_SetUnknownEncodingHandler(parser_.get(), windows_1252, nullptr);
    }

    std::vector<std::string> read() {
        const InputFile file(AllowedName(errors_.path), errors_.who);
        for (bool ended = false; !ended;) {
            void* const buffer = XML_GetBuffer(parser_.get(), kBlockBytes);
            if (!buffer) errors_.refuse("no memory to read it in");
            const ssize_t count = ::read(file.descriptor(), buffer, kBlockBytes);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) errors_.refuse(fmt::format("cannot be read, {}", std::strerror(errno)));
            ended = count == 0;
            fed_ += count;
            parse(static_cast<int>(count), ended);
        }
        return std::move(names_);
    }

  private:
    using Parser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, FreeParser>;

    static Reader& of(void* self) { return *static_cast<Reader*>(self); }
    // No exception may pass through Expat: what fails is kept and thrown behind XML_ParseBuffer.
    template <typename Do>
    static void guarded(void* self, Do what) {
        Reader& reader = of(self);
        if (reader.failure_) return;
        try {
            what(reader);
        } catch (...) {
            reader.failure_ = std::current_exception();
            XML_StopParser(reader.parser_.get(), XML_FALSE);
        }
    }
    static void XMLCALL on_start(void* self, const XML_Char* name, const XML_Char** attributes) {
        guarded(self, [&](Reader& reader) { reader.start(name, attributes); });
    }
    static void XMLCALL on_end(void* self, const XML_Char*) {
        guarded(self, [](Reader& reader) { reader.end(); });
    }
    static void XMLCALL on_text(void* self, const XML_Char* text, int length) {
        guarded(self, [&](Reader& reader) {
            reader.text({text, static_cast<std::size_t>(length)});
        });
    }
    static void XMLCALL on_entity(void* self, const XML_Char*, int, const XML_Char*, int,
                                  const XML_Char*, const XML_Char*, const XML_Char*,
                                  const XML_Char*) {
        guarded(self, [](Reader& reader) { reader.refuse("it declares an entity"); });
    }

    std::size_t line() const { return XML_GetCurrentLineNumber(parser_.get()); }
    [[noreturn]] void refuse(std::string_view what) const { errors_.refuse(line(), what); }

    void parse(int bytes, bool ended) {
        const XML_Status status = XML_ParseBuffer(parser_.get(), bytes, ended);
        if (failure_) std::rethrow_exception(failure_);
        if (status != XML_STATUS_OK)
            refuse(fmt::format("no well-formed XML, {}; the file is damaged or cut off",
                               XML_ErrorString(XML_GetErrorCode(parser_.get()))));
        if (!ended && fed_ - XML_GetCurrentByteIndex(parser_.get()) > kMostTokenBytes)
            refuse(fmt::format("a tag of more than {} MiB", kMostTokenBytes >> 20));
    }

    void start(std::string_view name, const XML_Char** attributes) {
        if (levels_.size() >= kMostElements)
            refuse(fmt::format("nested deeper than {} levels", kMostElements));
        if (levels_.empty() && name != "gpx")
            refuse(fmt::format("begins with <{}>, expected <gpx>; export it as GPX, GeoJSON or CSV",
                               name.substr(0, 40)));
        levels_.push_back(path_.size());
        path_.append("/").append(name.substr(0, kMostTextBytes));
        if (path_ == line_path_) {
            names_.emplace_back();
        } else if (path_ == point_path_) {
            point_ = {};
            point_.line = line();
            point_.lat_deg = degrees_of(attributes, "lat");
            point_.lon_deg = degrees_of(attributes, "lon");
        }
        text_ = text_of(path_);
        if (text_) text_->clear();
    }

    double degrees_of(const XML_Char** attributes, std::string_view wanted) const {
        for (; attributes[0]; attributes += 2) {
            if (wanted != attributes[0]) continue;
            const std::string_view text = trimmed(attributes[1]);
            if (const std::optional<double> number = parse_number(text)) return *number;
            refuse(fmt::format("{}=\"{}\", expected degrees such as {}", wanted, text.substr(0, 40),
                               wanted == "lat" ? "46.91 or -33.9" : "8.05 or -122.4"));
        }
        refuse(fmt::format("a point without {}, expected degrees such as {}=\"{}\"", wanted, wanted,
                           wanted == "lat" ? "46.91" : "8.05"));
    }

    /// What the text of an element is kept in; null where it is not.
    std::string* text_of(std::string_view path) {
        const auto is = [&](std::string_view parent, std::string_view child) {
            return !parent.empty() && path.size() == parent.size() + child.size() &&
                   path.starts_with(parent) && path.ends_with(child);
        };
        if (is(point_path_, "/name")) return &point_.name;
        if (is(point_path_, "/time")) return &point_.time;
        if (is(line_path_, "/name")) return &names_.back();
        return nullptr;
    }

    void text(std::string_view piece) {
        if (!text_) return;
        if (text_->size() + piece.size() > kMostTextBytes)
            refuse(fmt::format("a text of more than {} bytes", kMostTextBytes));
        *text_ += piece;
    }

    void end() {
        if (path_ == point_path_) {
            point_.name = trimmed(point_.name);
            point_.time = with_zone(trimmed(point_.time));
            visit_(static_cast<int>(names_.size()), std::move(point_));
        } else if (path_ == line_path_) {
            names_.back() = trimmed(names_.back());
        }
        path_.resize(levels_.back());
        levels_.pop_back();
        text_ = nullptr;
    }

    const FileErrors& errors_;
    const std::function<void(int, VectorPoint&&)>& visit_;
    Parser parser_;
    std::string line_path_, point_path_;  // line_path_ empty: waypoints
    std::string path_;                    // of the element that is open: "/gpx/trk/name"
    std::vector<std::size_t> levels_;     // where path_ ends without each open element
    VectorPoint point_;
    std::string* text_ = nullptr;
    std::vector<std::string> names_;
    std::exception_ptr failure_;
    XML_Index fed_ = 0;
};

}  // namespace

std::vector<std::string> read_gpx(const FileErrors& errors, GpxKind kind,
                                  const std::function<void(int, VectorPoint&&)>& visit) {
    return Reader(errors, kind, visit).read();
}

}  // namespace relevo::dem
