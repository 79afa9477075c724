// VTK reports errors as text on a global window. They are collected here instead of printed, a thread at a time.
//   VtkMessages messages;  reader->Update();  messages.throw_if_any(path);
#pragma once

#include <string>

namespace pbs {

// What VTK says on this thread from its construction on.
class VtkMessages {
public:
    VtkMessages();  // forgets what the thread collected before

    // An InputError with VTK's words, its file and line numbers taken off.
    void throw_if_any(const std::string& path) const;
};

}  // namespace pbs
