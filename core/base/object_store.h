#pragma once

#include <string>
#include <string_view>

namespace relevo {

/// Where results go whose names are not of a file system: "/vsis3/bucket/a.tif". Whoever knows such
/// stores installs one; without one such names are those of files.
class ObjectStore {
  public:
    virtual ~ObjectStore() = default;

    /// Whether a name is that of an object. Asks no net.
    virtual bool has_name(std::string_view name) const = 0;
    /// @throws Error (BadInput) where nothing can be written to it
    virtual void check_writable(const std::string& name) const = 0;
    /// @throws Error (BadInput) where the store does not say
    virtual bool exists(const std::string& name) const = 0;
    /// Makes an object of a file from its beginning to its end, whole or not at all.
    /// @throws Error (Failed) `NAME: cannot be written, why`
    virtual void put(int descriptor, const std::string& name) const = 0;
    /// Copies an object into a file, from its beginning.
    /// @returns false where there is no such object
    /// @throws Error (BadInput) where the store gives no answer or not all of it, (Failed) where
    ///     the disk refuses
    virtual bool get(const std::string& name, int descriptor) const = 0;
    /// Does nothing where it cannot.
    virtual void remove(const std::string& name) const noexcept = 0;
};

/// @param store  lives as long as the process; null: none
void install_object_store(const ObjectStore* store);

/// The store that has a name; null where it is that of a file.
const ObjectStore* object_store_of(std::string_view name);

}  // namespace relevo
