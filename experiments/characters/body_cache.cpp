#include "experiments/characters/body_cache.hpp"

#include "experiments/meshes/mesh_io.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"
#include "pbs/system/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <regex>

namespace pbs {

namespace fs = std::filesystem;

namespace {

// One process at a time makes the mesh of a key; the others wait, and find it in the cache.
// A lock on one byte of the folder's file `making.lock`, chosen by the key's hash (fcntl(2), open file description
// locks), so that it ends with its process, however that one ends. Where the folder cannot be written, and after a
// signal, nothing is locked: then two make the same.
void wait_for_turn(int lock_file, const std::string& key)
{
    if (lock_file < 0) return;
    struct flock byte = {};
    byte.l_type = F_WRLCK;
    byte.l_whence = SEEK_SET;
    byte.l_start = static_cast<off_t>(std::hash<std::string>()(key) & std::numeric_limits<int>::max());
    byte.l_len = 1;
    if (::fcntl(lock_file, F_OFD_SETLK, &byte) == 0) return;
    const Stage waiting("waiting for another process that makes the same tets");
    ::fcntl(lock_file, F_OFD_SETLKW, &byte);
}

bool makes_meshes_anew = false;

constexpr const char* format = ".vtu";  // Float64, so that what is read is what was made to the bit

std::string hex(const XXH128_hash_t& hash)
{
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text;
}

std::vector<fs::path> files_of_key(const std::string& folder, const std::string& key)
{
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(key + "-") && name.ends_with(format) && name.size() == key.size() + 1 + 32 + 4)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool is_whole(const fs::path& file, const std::string& key)
{
    return file.filename().string() == key + "-" + hash_of_file(file.string()) + format;
}

// The tets that came with the program are never made anew in silence, since another system's mesher would make others.
std::optional<TetMesh> read_kept(const std::string& key)
{
    for (const fs::path& file : files_of_key(references_folder() + "/tets", key)) {
        const SourceFile bytes(file.string());
        if (is_whole(file, key)) return read_tet_frame(file.string());  // checked before it was stored
        throw InputError(file.string(), 0, "", "",
                         "is damaged: the hash in its name is not that of its bytes; install the program anew, or "
                         "fetch the file again "
                         "with git");
    }
    return std::nullopt;
}

// What is damaged in the cache is removed, and the mesh is made again.
std::optional<TetMesh> read_cached(const std::string& key)
{
    for (const fs::path& file : files_of_key(cache_folder(), key)) try {
            const SourceFile bytes(file.string());
            if (is_whole(file, key)) return read_tet_frame(file.string());
            fs::remove(file);
        } catch (const std::exception&) {  // unreadable
        }
    return std::nullopt;
}

// making-KEY-PROCESS.vtu and the writer's own .making-..., of processes that were killed.
void remove_abandoned(const fs::path& folder)
{
    static const std::regex made(R"(\.?making-.*-([0-9]{1,9})(\.[0-9]+)?\.vtu)");
    std::error_code ignored;
    std::vector<fs::path> abandoned;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        std::smatch match;
        const std::string name = entry.path().filename().string();
        if (std::regex_match(name, match, made) && process_is_gone(std::stoi(match[1])))
            abandoned.push_back(entry.path());
    }
    for (const fs::path& file : abandoned) fs::remove(file, ignored);
}

void store(const std::string& key, const TetMesh& mesh)
{
    std::error_code ignored;
    const fs::path folder = cache_folder();
    const fs::path made = folder / ("making-" + key + "-" + std::to_string(::getpid()) + format);
    try {
        fs::create_directories(folder);
        remove_abandoned(folder);
        write_tet_mesh(made.string(), mesh);
        fs::rename(made, folder / (key + "-" + hash_of_file(made.string()) + format));
    } catch (const std::exception&) {
        fs::remove(made, ignored);  // a cache that cannot be written is none
    }
}

// The files that a glTF refers to. A buffer within the text ("data:...") is no file, and the reader refuses one that
// does not exist.
std::vector<std::string> referred_files(const std::string& path)
{
    const SourceFile file(path);
    const std::string &text = file.text(most_mesh_bytes), key = "\"uri\"", blank = " \t\r\n";
    std::vector<std::string> files;
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
        const std::size_t colon = text.find_first_not_of(blank, at + key.size());
        if (colon == std::string::npos || text[colon] != ':') continue;
        const std::size_t begin = text.find_first_not_of(blank, colon + 1);
        if (begin == std::string::npos || text[begin] != '"') continue;
        const std::string uri = text.substr(begin + 1, text.find('"', begin + 1) - begin - 1);
        if (!uri.starts_with("data:")) files.push_back((fs::path(path).parent_path() / uri).string());
    }
    return files;
}

std::vector<std::string> companions(const std::string& path)
{
    const std::string extension = fs::path(path).extension().string();
    if (extension == ".node") return {fs::path(path).replace_extension(".ele").string()};
    if (extension == ".ele") return {fs::path(path).replace_extension(".node").string()};
    if (extension == ".gltf") return referred_files(path);
    return {};
}

}  // namespace

std::string content_hash(const std::string& bytes)
{
    return hex(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string content_hash(const TetMesh& mesh)
{
    std::string bytes(reinterpret_cast<const char*>(mesh.rest.data()), mesh.rest.size() * sizeof(double));
    bytes.append(reinterpret_cast<const char*>(mesh.tets.data()), mesh.tets.size() * sizeof(int));
    return content_hash(bytes);
}

std::string hash_of_file(const std::string& path)
{
    return content_hash(SourceFile(path).text(most_mesh_bytes));
}

std::string cache_folder()
{
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    if (const std::string folder = variable("PBSKIN_CACHE"); !folder.empty()) return folder;
    if (const std::string folder = variable("XDG_CACHE_HOME"); !folder.empty()) return folder + "/pbskin";
    if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/pbskin";
    return (fs::temp_directory_path() / "pbskin").string();
}

std::string references_folder()
{
    if (const char* folder = std::getenv("PBSKIN_REFERENCES"); folder && *folder) return folder;
    return (fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "pbskin" / "references")
        .string();
}

TetMesh cached_mesh(const std::string& key, const std::function<TetMesh()>& make)
{
    if (const std::optional<TetMesh> mesh = read_kept(key)) return *mesh;
    if (makes_meshes_anew) return make();
    if (const std::optional<TetMesh> mesh = read_cached(key)) return *mesh;
    std::error_code ignored;
    fs::create_directories(cache_folder(), ignored);
    const OpenFile lock{
        ::open((cache_folder() + "/making.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666)};
    wait_for_turn(lock.number, key);
    if (const std::optional<TetMesh> mesh = read_cached(key)) return *mesh;  // made while this process waited
    const TetMesh mesh = make();
    store(key, mesh);
    return mesh;
}

void make_meshes_anew()
{
    makes_meshes_anew = true;
}

std::string file_name(const std::string& path)
{
    return fs::path(path).filename().string();
}

InputFile::InputFile(const std::string& path) : path_(path)
{
    try {
        const auto add = [&](const std::string& file) { files_.emplace_back(file).text(most_mesh_bytes); };
        add(path);
        for (const std::string& file : companions(path))
            if (std::error_code error; fs::is_regular_file(file, error)) add(file);
    } catch (const std::exception&) {  // its reader says why
        files_.clear();
    }
}

std::vector<std::pair<std::string, std::string>> InputFile::hashed() const
{
    if (files_.empty()) throw InputError(path_, 0, "", "", "was changed while it was read");
    std::vector<std::pair<std::string, std::string>> named;
    for (const SourceFile& file : files_) {
        if (file.was_changed()) throw InputError(file.path(), 0, "", "", "was changed while it was read");
        named.emplace_back(file_name(file.path()), content_hash(file.text(most_mesh_bytes)));
    }
    return named;
}

std::map<std::string, std::string> hashes_by_name(const std::vector<std::pair<std::string, std::string>>& inputs)
{
    std::map<std::string, std::string> hashes;
    for (const auto& [name, hash] : inputs) {
        std::string free = name;
        for (int n = 2; hashes.count(free) > 0 && hashes.at(free) != hash; ++n)
            free = name + " (" + std::to_string(n) + ")";
        hashes[free] = hash;
    }
    return hashes;
}

}  // namespace pbs
