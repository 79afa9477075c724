#include "experiments/meshes/content_format.hpp"

#include "experiments/meshes/text_words.hpp"
#include "pbs/system/source_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace pbs {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& beginning, const char* text)
{
    return beginning.find(text) != std::string::npos;
}

// The words of the first line that is neither blank nor a comment.
std::vector<std::string> first_words(const std::string& beginning)
{
    std::istringstream lines(beginning);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream text(line.substr(0, line.find('#')));
        std::vector<std::string> words;
        for (std::string word; text >> word;) words.push_back(word);
        if (!words.empty()) return words;
    }
    return {};
}

// OFF, COFF, NOFF, STOFF, ...
bool is_off_keyword(const std::string& word)
{
    return word.ends_with("OFF") && word.find_first_not_of("STCN") == word.size() - 3;
}

bool is_obj_keyword(const std::string& word)
{
    constexpr std::array<std::string_view, 9> keywords = {"v", "vt", "vn", "f", "o", "g", "s", "mtllib", "usemtl"};
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

// A header of any 80 bytes, the number of triangles, and 50 bytes for each of them.
bool is_binary_stl(const std::string& path)
{
    const std::string beginning = beginning_of(path);
    constexpr std::size_t header = 80, before_triangles = 84, of_triangle = 50;
    if (beginning.size() < before_triangles + of_triangle) return false;
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, beginning.data() + header, sizeof triangles);
    std::error_code code;
    return fs::file_size(path, code) == before_triangles + of_triangle * static_cast<std::uintmax_t>(triangles);
}

// USD as text, in binary form, or as a .usdz archive, whose first file is a .usd, .usda or .usdc. No reader here takes
// it.
bool is_usd(const std::string& path, const std::string& beginning)
{
    const bool is_archive = beginning.starts_with("PK\x03\x04");
    constexpr std::size_t of_first_name = 300;
    return beginning.starts_with("#usda") || beginning.starts_with("PXR-USDC") ||
           (is_archive && (holds(beginning.substr(0, of_first_name), ".usd") || lower_extension(path) == ".usdz"));
}

std::string extension_by_first_bytes(const std::string& beginning)
{
    if (beginning.starts_with("glTF")) return ".glb";
    if (beginning.starts_with("Kaydara FBX Binary")) return ".fbx";
    if (beginning.starts_with("PK\x03\x04")) return ".zae";
    if (beginning.starts_with("ply\n") || beginning.starts_with("ply\r")) return ".ply";
    if (beginning.starts_with("$MeshFormat") || beginning.starts_with("$NOD")) return ".msh";
    const std::size_t first = beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first != std::string::npos && beginning[first] == '{' ? ".gltf" : "";
}

bool lies_below(const fs::path& file, const fs::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

std::string lower_extension(const std::string& path)
{
    return in_lower_case(fs::path(path).extension().string());
}

std::string beginning_of(const std::string& path)
{
    return SourceFile(path).beginning();
}

std::string content_extension(const std::string& path)
{
    const SourceFile file(path);
    const std::string beginning = as_utf8(file.beginning());
    if (is_usd(path, beginning)) return ".usd";
    if (const std::string extension = extension_by_first_bytes(beginning); !extension.empty()) return extension;
    if (is_binary_stl(path)) return ".stl";
    if (holds(beginning, "; FBX ") || holds(beginning, "FBXHeaderExtension")) return ".fbx";
    if (holds(beginning, "<COLLADA")) return ".dae";
    if (holds(beginning, "<VTKFile") && holds(beginning, "\"PolyData\"")) return ".vtp";
    if (beginning.starts_with("# vtk DataFile")) return holds(beginning, "DATASET POLYDATA") ? ".vtp" : "";
    const std::vector<std::string> words = first_words(beginning);
    if (words.empty()) return "";
    if (words[0] == "MeshVersionFormatted") return ".mesh";
    if (is_off_keyword(words[0])) return ".off";
    if (in_lower_case(words[0]) == "solid" && holds(in_lower_case(beginning), "facet")) return ".stl";
    return is_obj_keyword(words[0]) && words.size() > 1 ? ".obj" : "";
}

std::string format_extension(const std::string& path)
{
    const std::string extension = content_extension(path);
    return extension.empty() ? lower_extension(path) : extension;
}

std::string path_by_content(const std::string& path)
{
    const std::string extension = format_extension(path);
    return extension == lower_extension(path) ? path : path + extension;
}

bool may_be_opened_for(const std::string& path, const std::string& file)
{
    std::error_code code;
    const fs::path target = fs::canonical(file, code);  // links followed
    if (code || !fs::is_regular_file(target, code)) return false;
    const fs::path own = fs::canonical(path, code),
                   named = fs::weakly_canonical(fs::absolute(path).parent_path(), code);
    return target == own || lies_below(target, own.parent_path()) || lies_below(target, named);
}

}  // namespace pbs
