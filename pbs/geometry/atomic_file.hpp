// Whole files or none: bytes are written to a new file next to the target, .NAME.PROCESS.RANDOM, flushed to disk and renamed over it, so
// that a killed writer leaves no torn file.
//   write_atomically("results/run.json", document.dump(2) + "\n");
//   AtomicFile file("large.glb");  file.write(beginning);  file.write(rest);  file.finish();
#pragma once

#include <string>
#include <string_view>

namespace pbs {

// An InputError where a device or a named pipe is there: renaming would leave a file in its place.
void require_no_device(const std::string& path);

// An InputError with the system's reason where the folder is missing, cannot be written or is full; nothing is left behind then. And as
// require_no_device.
void write_atomically(const std::string& path, const std::string& bytes);

// A whole file that is written in parts. Without finish() nothing stays behind.
class AtomicFile {
public:
    // The InputErrors of all functions are those of write_atomically.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    void finish();  // flushes and renames; once

    const std::string& temporary() const { return temporary_; }  // what was written so far

private:
    [[noreturn]] void refuse(int reason) const;

    std::string path_, temporary_;
    int file_ = -1;
};

}  // namespace pbs
