// Which files may be opened in order to read one file: that file, and those below its folder that it refers to (a glTF's buffers, an OBJ's
// materials). A named pipe would be waited for without end, and no file decides what is read elsewhere on somebody else's machine.
#pragma once

#include <string>

namespace pbs {

// Is `file` a regular file that may be opened in order to read `path`? Links are followed first.
bool may_be_opened_for(const std::string& path, const std::string& file);

}  // namespace pbs
