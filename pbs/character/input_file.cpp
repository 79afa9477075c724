#include "pbs/character/input_file.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/text_file.hpp"

#include <sys/stat.h>

#include <filesystem>

namespace pbs {
namespace {

namespace fs = std::filesystem;

// The files that a glTF refers to. A buffer within the text ("data:...") is no file, and the reader refuses one that does not exist.
std::vector<std::string> referred_files(const std::string& path)
{
    const std::string text = read_text_file(path, most_mesh_bytes), key = "\"uri\"", blank = " \t\r\n";
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

std::string file_name(const std::string& path)
{
    return fs::path(path).filename().string();
}

// `written` holds the file's number and the time of its last change; it is "" where there is no file. The time comes first, so that a
// file written while it is hashed differs the next time.
InputFile::State InputFile::state_of(const std::string& path)
{
    struct stat status = {};
    std::string written;
    if (::stat(path.c_str(), &status) == 0)
        written =
            std::to_string(status.st_ino) + " " + std::to_string(status.st_ctim.tv_sec) + " " + std::to_string(status.st_ctim.tv_nsec);
    return {path, hash_of_file(path), written};
}

InputFile::InputFile(const std::string& path) : path_(path)
{
    try {
        before_ = {state_of(path)};
        for (const std::string& file : companions(path))
            if (std::error_code error; fs::is_regular_file(file, error)) before_.push_back(state_of(file));
    } catch (const std::exception&) {  // its reader says why
    }
}

std::vector<std::pair<std::string, std::string>> InputFile::hashed() const
{
    if (before_.empty()) throw InputError(path_, 0, "", "", "was changed while it was read");
    std::vector<std::pair<std::string, std::string>> named;
    for (const State& before : before_) {
        const State now = state_of(before.path);
        if (now.hash != before.hash || now.written != before.written)
            throw InputError(before.path, 0, "", "", "was changed while it was read");
        named.emplace_back(file_name(before.path), before.hash);
    }
    return named;
}

std::map<std::string, std::string> hashes_by_name(const std::vector<std::pair<std::string, std::string>>& inputs)
{
    std::map<std::string, std::string> hashes;
    for (const auto& [name, hash] : inputs) {
        std::string free = name;
        for (int n = 2; hashes.count(free) > 0 && hashes.at(free) != hash; ++n) free = name + " (" + std::to_string(n) + ")";
        hashes[free] = hash;
    }
    return hashes;
}

}  // namespace pbs
