// A record as it is written to disk: JSON in UTF-8, whatever bytes the names in it contain.
//   analysis::write_text_atomically(path, record_text(run));
#pragma once

#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace analysis {

// Bytes that are not UTF-8 become U+FFFD, so that a record is never lost because of a name.
std::string record_text(const nlohmann::json& record);

bool is_utf8(const std::string& text);

// Writes records as whole files or not at all, by pbs::write_atomically, and removes what killed writers left behind.
//   write_text_atomically("results/run.json", document.dump(2) + "\n");
// InputError with the system's reason if the folder is missing, cannot be written or is full; nothing is left behind in
// that case.
void write_text_atomically(const std::string& path, const std::string& text);

// Checks before long work whether the file can be written: the same InputError if its folder, or an existing entry in
// its place, forbids it.
void require_writable(const std::string& path);

// Checks before long work that no output replaces an input or another output. Two names of one file are recognised by
// its device and inode, so that links count. An output that was not asked for has an empty path. InputError with the
// option and the other file.
//   require_separate({{"--csv", arguments.csv}, {"--junit", arguments.junit}}, {arguments.rest});
struct OutputFile {
    std::string option, path;
};
void require_separate(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs);

// Removes the half-written files that killed writers left in a folder and in those below it: temporary files whose
// process no longer exists. A folder that does not exist holds none.
void remove_abandoned_files(const std::string& folder, bool and_below = true);

// pbs::read_text_file: InputError if the file cannot be read.
std::string read_text(const std::string& path);

// Lists and removes the files of a folder. Where the system refuses, the error names the file and the reason.
//   remove_record(folder / "run.json");  for (const fs::path& file : files_in(folder / "frames")) ...
// Removes a file of an earlier run, so that it does not remain next to the files of the next one; a missing file is no
// error.
void remove_record(const std::filesystem::path& file);

// Makes the folder of records with those above it. Returns whether it is new.
bool make_output_folder(const std::filesystem::path& folder);

// The path of a file in a folder.
std::string path_in(const std::string& folder, const std::string& name);

// The files of a folder, in no particular order.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

// Reads back the record of a run, which may have been changed since it was written.
//   const auto total = [](const auto& run) { return run.at("cost").at("total").get<double>(); };
//   const double total_s = from_record(folder + "/run.json", total);
nlohmann::json read_record(const std::string& path);       // InputError if it is not valid JSON
[[noreturn]] void refuse_record(const std::string& path);  // throws InputError

// The result of `read`; InputError with the file if an entry is missing or has another type.
template <typename Read>
auto from_record(const std::string& path, const Read& read)
{
    const nlohmann::json record = read_record(path);
    try {
        return read(record);
    } catch (const nlohmann::json::exception&) {
        refuse_record(path);
    }
}

// A temporary folder for files that another program reads and writes. It is removed with this object; those that an
// interruption left are removed by a later process.
//   const ScratchFolder folder;  write(folder / "deck.inp");
class ScratchFolder {
public:
    ScratchFolder()
    {
        const std::filesystem::path parent = std::filesystem::temp_directory_path();
        remove_abandoned(parent);
        std::string name = (parent / ("pbskin_" + std::to_string(getpid()) + "_XXXXXX")).string();
        if (!mkdtemp(name.data()))
            throw pbs::InputError(parent.string(), 0, "", "",
                                  "no folder can be made here: " + std::generic_category().message(errno));
        path_ = name;
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

private:
    // A folder has the number of its process in its name.
    static void remove_abandoned(const std::filesystem::path& parent)
    {
        constexpr std::string_view begin = "pbskin_";
        std::error_code ignored;
        for (std::filesystem::directory_iterator entry(parent, ignored), end; entry != end; entry.increment(ignored)) {
            const std::string name = entry->path().filename().string();
            if (!name.starts_with(begin)) continue;
            int process = 0;
            const auto [stop, error] = std::from_chars(name.data() + begin.size(), name.data() + name.size(), process);
            if (error == std::errc() && *stop == '_' && pbs::process_is_gone(process))
                std::filesystem::remove_all(entry->path(), ignored);
        }
    }

    std::filesystem::path path_;
};

}  // namespace analysis
