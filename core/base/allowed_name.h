#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace relevo {

/// Whether a name is that of a file of this machine, whichever library reads it: a plain path; a
/// file in an archive
/// ("/vsizip/a.zip/b.tif") or a compressed file ("/vsigzip/a.gz") of a plain path; or a subdataset
/// of a plain path
/// ("NETCDF:a.nc:z"). A list of what is allowed: other spellings are not.
bool is_of_this_machine(std::string_view name);

/// Whether GDAL would ask the net, or standard input, for a name: "https://...", "/vsis3/...",
/// "WMTS:...". Only for names that a person has written: it lists what is known.
bool is_remote(std::string_view name);

/// Whether a name begins as that of a GDAL file system over files of this machine: "/vsizip/...".
bool is_local_file_system(std::string_view name);

/// Allows a name that a person has written: an argument, an entry of a dialog, an argument of the
/// library. It may be opened as it is written, on the net too, and so may what is below it
/// ("/vsis3/bucket/folder"). Thread-safe, as all here.
void allow_name(const std::string& name);

/// allow_name() for a word of a command line, which may have a name behind a "=": "--set",
/// "drape.file=a.tif".
void allow_word(std::string_view word);

/// Undoes allow_name(): the name is no longer in use.
void forget_name(const std::string& name);

/// Allows every name: `--trust`.
void allow_all_names();

/// Whether a name may be opened: it is of this machine, or a person has written it.
bool is_allowed(const std::string& name);

/// A name that may be opened; readers of files take this type. A name that no person has written
/// may come from a stranger's file, and has to be of this machine.
class AllowedName {
  public:
    /// @throws Error (Usage) `'NAME' is not a file of this machine; name it on the command line, or
    /// add --trust`
    explicit AllowedName(std::string name);

    /// A name that the program has made up, which no file contains: "/vsimem/index_1.gpkg"; or that
    /// of a result.
    static AllowedName of_program(std::string name);

    const std::string& text() const { return text_; }
    const char* c_str() const { return text_.c_str(); }

    /// Whether a person has allowed the net to be asked for it.
    bool asks_net() const { return asks_net_; }

    /// Whether another name that the file of this name contains, or that follows from this name,
    /// may be opened: one of the net only if this one is.
    bool allows(const std::string& other) const;
    /// @throws Error (Usage) as the constructor
    AllowedName derived(std::string other) const;

  private:
    AllowedName(std::string name, bool asks_net) : text_(std::move(name)), asks_net_(asks_net) {}
    std::string text_;
    bool asks_net_ = false;
};

}  // namespace relevo
