#include "tests/architecture/laws.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace architecture {
namespace {

const std::vector<std::string> text_files = {".cpp", ".hpp", ".h",    ".py", ".cmake", ".sh",  ".toml",    ".md",
                                             ".txt", ".cff", ".json", ".js", ".mjs",   ".css", "Snakefile"};
const std::vector<std::string> left_out = {"build/", "results/", ".git/", ".cache/", ".vscode/"};
const std::vector<std::string> commands = {"reproduce", "check", ".ci/run"};

bool belongs(const std::string& path)
{
    if (starts_with_any(path, left_out) || path.find("__pycache__") != std::string::npos) return false;
    if (path.find("node_modules") != std::string::npos || path.starts_with("paper_figures/viewer/dist/")) return false;
    return ends_with_any(path, text_files) || is_command(path);
}

std::string read(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void collect_foreign(const SourceTree& tree, const std::string& path, std::set<std::string>& visited,
                     std::set<std::string>& foreign)
{
    const auto file = tree.find(path);
    if (file == tree.end() || !visited.insert(path).second) return;
    for (const Include& include : includes_of(file->second)) {
        if (!tree.contains(include.target)) foreign.insert(include.target);
        collect_foreign(tree, include.target, visited, foreign);
    }
}

bool contains_any(const std::string& text, const std::vector<std::string>& parts)
{
    return std::ranges::any_of(parts, [&](const std::string& part) { return text.find(part) != std::string::npos; });
}

}  // namespace

SourceTree read_source_tree()
{
    const std::filesystem::path root = PBS_SOURCE_ROOT;
    SourceTree tree;
    for (auto entry = std::filesystem::recursive_directory_iterator(root);
         entry != std::filesystem::recursive_directory_iterator(); ++entry) {
        const std::string path = entry->path().lexically_relative(root).generic_string();
        if (entry->is_directory() && starts_with_any(path + "/", left_out)) entry.disable_recursion_pending();
        if (entry->is_regular_file() && belongs(path)) tree[path] = read(entry->path());
    }
    return tree;
}

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string folder_of(const std::string& path)
{
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash);
}

bool starts_with_any(std::string_view text, const std::vector<std::string>& prefixes)
{
    return std::ranges::any_of(prefixes, [text](const std::string& prefix) { return text.starts_with(prefix); });
}

bool ends_with_any(std::string_view text, const std::vector<std::string>& suffixes)
{
    return std::ranges::any_of(suffixes, [text](const std::string& suffix) { return text.ends_with(suffix); });
}

bool is_cpp(const std::string& path)
{
    return ends_with_any(path, {".cpp", ".hpp"});
}

bool is_cmake_file(const std::string& path)
{
    return ends_with_any(path, {"CMakeLists.txt", ".cmake"});
}

bool is_command(const std::string& path)
{
    return std::ranges::count(commands, path) > 0;
}

std::vector<Include> includes_of(const std::string& text)
{
    static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    std::vector<Include> includes;
    int number = 0;
    for (const std::string& line : lines_of(text)) {
        ++number;
        std::smatch match;
        if (line.find("include") != std::string::npos && std::regex_search(line, match, directive))
            includes.push_back({number, match[2], match[1] == "\""});
    }
    return includes;
}

std::set<std::string> foreign_headers(const SourceTree& tree, const std::string& path)
{
    std::set<std::string> visited, foreign;
    collect_foreign(tree, path, visited, foreign);
    return foreign;
}

std::string at(const std::string& path, int line, const std::string& what)
{
    return path + ":" + std::to_string(line) + ": " + what;
}

Violations in_lines(const SourceTree& tree, const std::function<bool(const std::string&)>& concerns,
                    const std::function<std::string(const std::string&)>& offence)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        int number = 0;
        for (const std::string& line : concerns(path) ? lines_of(text) : std::vector<std::string>{}) {
            ++number;
            if (const std::string what = offence(line); !what.empty()) violations.push_back(at(path, number, what));
        }
    }
    return violations;
}

Violations in_lines(const SourceTree& tree, const std::function<bool(const std::string&)>& concerns,
                    const std::regex& forbidden, const std::string& what, const std::vector<std::string>& parts)
{
    return in_lines(tree, concerns, [&](const std::string& line) {
        std::smatch match;
        return contains_any(line, parts) && std::regex_search(line, match, forbidden) ? what + ": '" + match.str() + "'"
                                                                                      : "";
    });
}

}  // namespace architecture
