// Other people's readers on damaged files: assimp ends the process on one damaged .ply in two, VTK and Gmsh on rarer ones, and all three
// may take memory or time without limit. They run in a child process, silent, with a limit on memory, processor time and time; what they
// read comes back through a pipe, and whatever becomes of the child, the caller gets its bytes or an InputError that names the file and
// says how the child died.
//   const std::string bytes = read_isolated("walk.bvh", [](const std::string& path) { return packed(read_by_library(path)); });
// The bytes come from a process that damage may have led astray: check them (packed_bytes.hpp).
#pragma once

#include <functional>
#include <string>

namespace pbs {

// Asked several times a second while a reader is waited for; what it throws ends the reader and leaves read_isolated. Once, at the start:
//   ask_while_reading(stop_if_interrupted);
void ask_while_reading(std::function<void()> question);

// read(path) in a child process; its exceptions come back as InputErrors.
std::string read_isolated(const std::string& path, const std::function<std::string(const std::string&)>& read);

}  // namespace pbs
