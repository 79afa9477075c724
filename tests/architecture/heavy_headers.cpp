#include "tests/architecture/heavy_headers.hpp"

#include <set>

namespace architecture {
namespace {

struct HeavyLibrary {
    std::string header;                // the beginning of its includes
    std::vector<std::string> at_home;  // the places whose files may see it
    std::size_t most_files;            // limit for the number of .cpp files outside tests that see it
};

const std::vector<HeavyLibrary> heavy = {
    {"deal.II/", {"reference_fem/"}, 5}, {"mpi.h", {"reference_fem/"}, 1},
    {"ml_", {"reference_fem/"}, 2},      {"Epetra_", {"reference_fem/"}, 1},
    {"CGAL/", {"pbs/geometry/"}, 4},     {"vtk", {"pbs/geometry/"}, 3},
    {"gmsh.h", {"pbs/geometry/"}, 1},    {"assimp/", {"pbs/geometry/", "pbs/rig/", "pbs/character/"}, 4},
};

bool is_heavy(const std::string& target, const HeavyLibrary& library)
{
    // vtk*.h are in no folder of their own; a folder "vtk..." of this project would be.
    return target.starts_with(library.header) && (library.header != "vtk" || target.find('/') == std::string::npos);
}

// Whether the file includes the library, directly or through headers of this project.
bool sees(const SourceTree& tree, const std::string& path, const HeavyLibrary& library, std::set<std::string>& visited)
{
    const auto file = tree.find(path);
    if (file == tree.end() || !visited.insert(path).second) return false;
    for (const Include& include : includes_of(file->second))
        if (is_heavy(include.target, library) || sees(tree, include.target, library, visited)) return true;
    return false;
}

}  // namespace

Violations heavy_headers(const SourceTree& tree)
{
    Violations violations;
    for (const HeavyLibrary& library : heavy) {
        std::size_t files = 0;
        for (const auto& [path, text] : tree) {
            std::set<std::string> visited;
            if (!is_cpp(path) || path.starts_with("tests/") || !sees(tree, path, library, visited)) continue;
            files += path.ends_with(".cpp");
            if (!starts_with_any(path, library.at_home)) violations.push_back(at(path, 1, "sees " + library.header + " outside its place"));
        }
        if (files > library.most_files)
            violations.push_back(library.header + " is seen by " + std::to_string(files) + " .cpp files; at most " +
                                 std::to_string(library.most_files) + " may");
    }
    return violations;
}

}  // namespace architecture
