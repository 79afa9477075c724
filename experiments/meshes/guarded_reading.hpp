// Other people's readers on damaged files: assimp ends the process on one damaged .ply in two, VTK on rarer ones, and
// both may take memory or time without limit. A child process tries first, silent, with limits on memory, processor
// time and time: far more than a sound file needs, and no more than half of the memory that there is. Whatever becomes
// of the child, the caller gets what was read or an InputError that names the file and says how the child died.
//   const TetMesh mesh = read_guarded("arm.vtu", "tets", read_vtk);
#pragma once

#include "pbs/system/source_file.hpp"

#include <functional>
#include <string>

namespace pbs {

// read(path) in a child process, of which nothing stays behind; its exceptions come back as InputErrors.
void try_reading(const std::string& path, const std::function<void(const std::string&)>& read);

// read(path) in this process, once it has succeeded in a child. A child tries the same bytes only once for each reader,
// which is known by its name, while a SourceFile of the path exists. Files to which this one refers, such as a glTF's
// .bin, are not compared: a caller that reads again after a change of these reads unguarded.
template <typename Read>
auto read_guarded(const std::string& path, const std::string& reader, const Read& read)
{
    const SourceFile file(path);
    if (!file.is_safe_for(reader)) try_reading(path, [&](const std::string& same) { read(same); });
    file.set_safe_for(reader);
    return read(path);
}

}  // namespace pbs
