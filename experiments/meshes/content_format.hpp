// The format of a file by its content, as the extension that files of this format have. Readers are chosen by it, since
// files are renamed and exported under wrong names.
//   format_extension("arm.obj")   ".ply" if the file begins with "ply"
// It knows glTF 2.0 (.glb, .gltf), FBX, COLLADA (.dae, .zae), PLY, OFF, STL, OBJ, VTK's surfaces (.vtp), Gmsh (.msh)
// and MEDIT (.mesh). A zip archive is taken for .zae, the only one of these formats that is packed.
#pragma once

#include <string>

namespace pbs {

// The first bytes of a file, at most 4,096; empty where it cannot be read.
std::string beginning_of(const std::string& path);

// ".msh" of "a/B.MSH".
std::string lower_extension(const std::string& path);

// by the first 4,096 bytes; empty: no known format, or the file cannot be read
std::string content_extension(const std::string& path);
// content_extension if the format is known, otherwise the file's own extension
std::string format_extension(const std::string& path);

// The path if its extension is format_extension, otherwise the path with that extension added: for readers that choose
// by the name. There is no file of this name.
std::string path_by_content(const std::string& path);

// Is `file` a regular file that may be opened in order to read `path`: that file itself, or one below its folder that
// it refers to (a glTF's buffers, an OBJ's materials)? Links are followed first. A named pipe would be waited for
// without end, and no file decides what is read elsewhere on somebody else's machine.
bool may_be_opened_for(const std::string& path, const std::string& file);

}  // namespace pbs
