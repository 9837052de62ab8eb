#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "json/value.h"

namespace relevo::mesh {

/// A member of a JSON object; null if there is none.
const json::Value* find(const json::Value& object, std::string_view key);

/// A glTF file taken apart: its JSON, and the bytes of its buffers.
struct GltfParts {
    json::Value root;
    std::vector<std::string> buffers;
};

/// Splits .glb into its chunks and loads buffers: the chunk BIN, base64 of data URIs, and files of
/// the folder.
/// @throws Error (BadInput) `mesh: file: ...`
GltfParts gltf_parts(const std::filesystem::path& file, std::string_view bytes);

}  // namespace relevo::mesh
