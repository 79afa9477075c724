// Tet meshes kept between runs. A file's name carries the key (what the mesh was made from) and the hash of its own
// bytes, so that a damaged file is known by its name alone; it is renamed into place whole.
//   TetMesh mesh = cached_mesh("limb-1775", [] { return mesh_limb(1775); });
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/system/source_file.hpp"

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pbs {

std::string content_hash(const std::string& bytes);  // XXH3, 128 bits, 32 hexadecimal digits
std::string content_hash(const TetMesh& mesh);       // of its arrays
// of its bytes; an InputError where it cannot be read or has over 1 GiB
std::string hash_of_file(const std::string& path);

// The folder of cached tet meshes: $PBSKIN_CACHE, else $XDG_CACHE_HOME/pbskin, else ~/.cache/pbskin.
std::string cache_folder();

// The folder of the solved references that come with the program: $PBSKIN_REFERENCES, else share/pbskin/references next
// to its folder. In `tets` it has the meshes of bodies that may be redistributed, under the names that they have in the
// cache, so that every system has the same tets, whatever its mesher makes.
std::string references_folder();

// Reads the mesh from that folder or from the cache, or makes and stores it while other processes wait. Where the cache
// cannot be written, the mesh is made every time. InputError for a file of that folder that is damaged.
TetMesh cached_mesh(const std::string& key, const std::function<TetMesh()>& make);
// From now on, this process makes each mesh that is not in that folder, and stores none.
void make_meshes_anew();

// Records name files, not folders of the machine.
std::string file_name(const std::string& path);

// A file that a run is made from, with those that are read along with it (TetGen's other half, a glTF's buffers), and
// the hash of the bytes that were read: readers that are called while it exists share its bytes.
//   const InputFile clip("walk.gltf");  const Clip read = read_clip("walk.gltf");
//   for (const auto& [name, hash] : clip.hashed()) ...
class InputFile {
public:
    // what cannot be read is left to its reader, who says why; "": no file
    explicit InputFile(const std::string& path);

    // Names and hashes, the file itself first. InputError if a file has been written since, or is gone.
    std::vector<std::pair<std::string, std::string>> hashed() const;

private:
    std::string path_;
    std::vector<SourceFile> files_;
};

// By name, for the records; of another file of a name that is taken, "NAME (2)".
std::map<std::string, std::string> hashes_by_name(const std::vector<std::pair<std::string, std::string>>& inputs);

}  // namespace pbs
