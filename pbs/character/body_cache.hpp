// Tet meshes kept between runs. A file's name carries the key (what the mesh was made from) and the hash of its own bytes, so that a
// damaged file is known by its name alone; it is renamed into place whole.
//   TetMesh mesh = cached_mesh("limb-1775", [] { return mesh_limb(1775); });
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <functional>
#include <string>

namespace pbs {

std::string content_hash(const std::string& bytes);  // XXH3, 128 bits, 32 hexadecimal digits
std::string content_hash(const TetMesh& mesh);       // of its arrays
std::string hash_of_file(const std::string& path);   // of its bytes; an InputError where it cannot be read or has over 1 GiB

// The folder of cached tet meshes: $PBSKIN_CACHE, else $XDG_CACHE_HOME/pbskin, else ~/.cache/pbskin.
std::string cache_folder();

// Reads the mesh from the cache, or makes and stores it while other processes wait. Where the folder cannot be written, the mesh is made
// every time.
TetMesh cached_mesh(const std::string& key, const std::function<TetMesh()>& make);

}  // namespace pbs
