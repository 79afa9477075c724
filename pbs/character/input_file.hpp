// Files that a run is made from, and the hashes of the bytes that were read.
//   const InputFile clip("walk.gltf");  const Clip read = read_clip("walk.gltf");
//   for (const auto& [name, hash] : clip.hashed()) ...
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pbs {

// Records name files, not folders of the machine.
std::string file_name(const std::string& path);

// A file that a library opens by its name, with those that are read along with it: TetGen's other half, a glTF's buffers. Where what is
// asked afterwards is what was there before, these are the bytes that were read.
class InputFile {
public:
    explicit InputFile(const std::string& path);  // what cannot be read is left to its reader, who says why; "": no file

    // Names and hashes, the file itself first. InputError where one of them is another than it was, or gone.
    std::vector<std::pair<std::string, std::string>> hashed() const;

private:
    std::string path_;
    std::vector<std::pair<std::string, std::string>> before_;  // path, hash
};

// By name, for the records; of another file of a name that is taken, "NAME (2)".
std::map<std::string, std::string> hashes_by_name(const std::vector<std::pair<std::string, std::string>>& inputs);

}  // namespace pbs
