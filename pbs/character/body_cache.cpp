#include "pbs/character/body_cache.hpp"

#include "pbs/character/making_lock.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/process.hpp"
#include "pbs/geometry/text_file.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <regex>
#include <vector>

namespace fs = std::filesystem;

namespace pbs {
namespace {

constexpr const char* format = ".vtu";  // Float64, so that what is read is what was made to the bit

std::string hex(const XXH128_hash_t& hash)
{
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text;
}

std::vector<fs::path> files_of_key(const std::string& key)
{
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(cache_folder(), ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(key + "-") && name.ends_with(format) && name.size() == key.size() + 1 + 32 + 4) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool is_whole(const fs::path& file, const std::string& key)
{
    return file.filename().string() == key + "-" + hash_of_file(file.string()) + format;
}

std::optional<TetMesh> read_cached(const std::string& key)
{
    for (const fs::path& file : files_of_key(key)) try {
            if (is_whole(file, key)) return read_tet_frame(file.string());  // checked before it was stored
            fs::remove(file);
        } catch (const std::exception&) {  // unreadable: the mesh is made again
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
        if (std::regex_match(name, match, made) && process_is_gone(std::stoi(match[1]))) abandoned.push_back(entry.path());
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
    return content_hash(read_text_file(path, most_mesh_bytes));
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

TetMesh cached_mesh(const std::string& key, const std::function<TetMesh()>& make)
{
    if (const std::optional<TetMesh> mesh = read_cached(key)) return *mesh;
    std::error_code ignored;
    fs::create_directories(cache_folder(), ignored);
    const MakingLock lock(cache_folder(), key);
    if (const std::optional<TetMesh> mesh = read_cached(key)) return *mesh;  // made while this process waited
    const TetMesh mesh = make();
    store(key, mesh);
    return mesh;
}

}  // namespace pbs
