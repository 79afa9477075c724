// The largest files that are read. Far above what a sound one needs; text of the larger kinds, with what is made of it, fits a gigabyte of
// memory. A file may have any size at no cost (holes), so the size is checked before a byte is read.
#pragma once

#include <cstdint>
#include <string>

namespace pbs {

constexpr std::uintmax_t most_settings_bytes = std::uintmax_t(16) << 20;  // TOML: skeletons, scenes, rules
constexpr std::uintmax_t most_text_bytes = std::uintmax_t(256) << 20;     // weights, clips, records, .msh, .mesh, .node, .ele
constexpr std::uintmax_t most_mesh_bytes = std::uintmax_t(1) << 30;       // .vtu, .vtk, surfaces: read by libraries, in a child process

// An InputError where the file has more bytes.
void require_size(const std::string& path, std::uintmax_t bytes, std::uintmax_t most_bytes);

}  // namespace pbs
