// Other people's readers on damaged files: assimp ends the process on one damaged .ply in two, VTK on rarer ones, and both may
// take memory or time without limit. A child process tries first, silent, with limits on memory, processor time and time: far more than
// a sound file needs, and no more than half of the memory that there is. Whatever becomes of the child, the caller gets what was read or an
// InputError that names the file and says how the child died.
//   const TetMesh mesh = read_guarded("arm.vtu", read_vtk);
#pragma once

#include <functional>
#include <string>

namespace pbs {

// read(path) in a child process, of which nothing stays behind; its exceptions come back as InputErrors.
void try_reading(const std::string& path, const std::function<void(const std::string&)>& read);

// read(path) in this process, once it has succeeded in a child.
template <typename Read>
auto read_guarded(const std::string& path, const Read& read)
{
    try_reading(path, [&](const std::string& file) { read(file); });
    return read(path);
}

}  // namespace pbs
