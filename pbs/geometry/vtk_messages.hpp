// VTK reports errors as text on a global window. They are collected here instead of printed, a thread at a time.
//   VtkMessages messages;  reader->Update();  messages.throw_if_any(path);
#pragma once

#include <string>

namespace pbs {

// Collects what VTK reports on this thread from the construction of the object on.
class VtkMessages {
public:
    VtkMessages();  // forgets what the thread collected before

    // An InputError with VTK's words, its file and line numbers taken off.
    void throw_if_any(const std::string& path) const;
};

}  // namespace pbs
