// The largest files that are read. Far above what a sound one needs; text of the larger kinds, with what is made of it,
// fits a gigabyte of memory. A file may have any size at no cost (holes), so the size is checked before a byte is read.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace pbs {

constexpr std::uintmax_t most_settings_bytes = std::uintmax_t(16) << 20;  // TOML: skeletons, scenes, rules
// weights, clips, records, .msh, .mesh, .node, .ele
constexpr std::uintmax_t most_text_bytes = std::uintmax_t(256) << 20;
// .vtu, .vtk, surfaces: read by libraries, in a child process
constexpr std::uintmax_t most_mesh_bytes = std::uintmax_t(1) << 30;

// Is closed with this; below 0: it could not be opened.
struct OpenFile {
    ~OpenFile()
    {
        if (number >= 0) ::close(number);
    }

    int number;
};

// An InputError where the file has more bytes.
void require_size(const std::string& path, std::uintmax_t bytes, std::uintmax_t most_bytes);

// A text file whole: the one reader of scenes, skeletons, weights, clips and records. An InputError where it cannot be
// read, is larger or is no file: a named pipe would be waited for without end, a device has none.
std::string read_text_file(const std::string& path, std::uintmax_t most_bytes = most_text_bytes);

// An InputError that names the line where a key of the text has more than 64 parts or a bare word has other characters
// than ASCII. toml++ ends the process on keys nested some ten thousand deep (a.a.a. ...) and, with assertions, on
// control characters and letters outside ASCII in bare words.
void check_toml_keys(const std::string& text, const std::string& file);

// An InputError where a device or a named pipe is there: renaming would leave a file in its place.
void require_no_device(const std::string& path);

// Whole files or none: bytes are written to a new file next to the target, .NAME.PROCESS.RANDOM, flushed to disk and
// renamed over it, so that a killed writer leaves no torn file.
//   write_atomically("results/run.json", document.dump(2) + "\n");
//   AtomicFile file("large.glb");  file.write(beginning);  file.write(rest);  file.finish();
// An InputError with the system's reason where the folder is missing, cannot be written or is full; nothing is left
// behind then. And as require_no_device.
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

    // Removes what all AtomicFiles of this process have written so far. For a signal handler that ends the process.
    static void remove_unfinished();

private:
    [[noreturn]] void refuse(int reason) const;

    std::string path_, temporary_;
    int file_ = -1;
};

}  // namespace pbs
