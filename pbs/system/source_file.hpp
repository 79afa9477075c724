// A file that is opened once, however many readers look at it.
//   // one opening in all
//   const SourceFile file("arm.vtu");  if (is_surface_file("arm.vtu")) ... read_surface("arm.vtu") ...
#pragma once

#include "pbs/system/files.hpp"

#include <memory>
#include <string>

namespace pbs {

// While one of these objects exists, those that are made later for the same file, and read_text_file, share its bytes,
// unless the file has been changed in between.
class SourceFile {
public:
    explicit SourceFile(const std::string& path);  // what cannot be opened is refused by text()

    const std::string& path() const { return path_; }
    // Returns the whole file. Throws an InputError if it cannot be read, is larger, or is no regular file: a named pipe
    // would be waited for without end, and a device has no end.
    const std::string& text(std::uintmax_t most_bytes = most_text_bytes) const;
    std::string beginning() const;  // the first 4,096 bytes; empty where it cannot be read
    // since it was opened; its time of change also says so for permissions and new hard links
    bool was_changed() const;

    // Whether a reader, by its name, has read these bytes, which text() has returned, in a child process
    // (guarded_reading.hpp).
    bool is_safe_for(const std::string& reader) const;
    void set_safe_for(const std::string& reader) const;

private:
    struct Content;
    std::string path_;
    std::shared_ptr<Content> content_;
};

}  // namespace pbs
