#include "tests/architecture/kernel_laws.hpp"

#include <algorithm>
#include <set>
#include <sstream>

namespace architecture {
namespace {

const std::vector<std::string> headers_of_kernels = {"array",   "cmath",       "cstddef",           "cstdint",    "limits",
                                                     "utility", "type_traits", "experimental/simd", "immintrin.h"};
const std::vector<std::string> headers_of_registers = {"experimental/simd", "immintrin.h", "x86intrin.h", "arm_neon.h"};

// Targets built for the machine, and the definition that records this. Those of the benchmark are not in the library.
const std::vector<std::string> built_for_the_machine = {"target_compile_options(pbs_kernels ",
                                                        "target_compile_options(pbskin_native_plain ", "\"PBS_KERNEL_FLAGS="};

// The sources of an add_library(NAME ...), with paths from the root.
std::vector<std::string> sources_of(const SourceTree& tree, const std::string& library)
{
    std::vector<std::string> sources;
    for (const auto& [path, text] : tree) {
        const std::size_t begin = is_cmake_file(path) ? text.find("add_library(" + library + " ") : std::string::npos;
        if (begin == std::string::npos) continue;
        std::istringstream words(text.substr(begin, text.find(')', begin) - begin));
        for (std::string word; words >> word;)
            if (word.ends_with(".cpp")) sources.push_back(folder_of(path) + "/" + word);
    }
    return sources;
}

// Headers of other projects that the file includes, directly or through headers of this project.
void collect_foreign(const SourceTree& tree, const std::string& path, std::set<std::string>& visited, std::set<std::string>& foreign)
{
    const auto file = tree.find(path);
    if (file == tree.end() || !visited.insert(path).second) return;
    for (const Include& include : includes_of(file->second)) {
        if (!tree.contains(include.target)) foreign.insert(include.target);
        collect_foreign(tree, include.target, visited, foreign);
    }
}

std::set<std::string> foreign_headers(const SourceTree& tree, const std::string& path)
{
    std::set<std::string> visited, foreign;
    collect_foreign(tree, path, visited, foreign);
    return foreign;
}

bool names(const std::vector<std::string>& list, const std::string& entry)
{
    return std::ranges::count(list, entry) > 0;
}

}  // namespace

Violations kernel_includes(const SourceTree& tree)
{
    Violations violations;
    const std::vector<std::string> sources = sources_of(tree, "pbs_kernels");
    if (sources.empty()) violations.push_back("pbs_kernels has no sources");
    for (const std::string& path : sources)
        for (const std::string& header : foreign_headers(tree, path))
            if (!names(headers_of_kernels, header)) violations.push_back(at(path, 1, "a kernel sees <" + header + ">"));
    return violations;
}

Violations machine_flags(const SourceTree& tree)
{
    Violations violations;
    for (const auto& [path, text] : tree) {
        if (!is_cmake_file(path)) continue;
        const std::vector<std::string> lines = lines_of(text);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const std::string code = lines[i].substr(0, lines[i].find('#'));
            const auto says = [&](const std::string& part) { return code.find(part) != std::string::npos; };
            if ((says("-march") || says("-mtune") || says("-mavx")) && std::ranges::none_of(built_for_the_machine, says))
                violations.push_back(at(path, static_cast<int>(i) + 1, "built for one machine, and no kernel"));
        }
    }
    return violations;
}

Violations registers_at_home(const SourceTree& tree)
{
    const std::vector<std::string> kernels = sources_of(tree, "pbs_kernels");
    Violations violations;
    for (const auto& [path, text] : tree)
        if (path.ends_with(".cpp") && !names(kernels, path))
            for (const std::string& header : foreign_headers(tree, path))
                if (names(headers_of_registers, header)) violations.push_back(at(path, 1, "no kernel, and sees <" + header + ">"));
    return violations;
}

}  // namespace architecture
