// .tobj, the tet meshes of HOBAK: lines "v x y z" and "t a b c d", vertices counted from 0; '#' begins a comment, other lines (the
// triangles of the surface) are left out.
#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

namespace pbs {
namespace {

// `count` numbers after the first word of a line.
std::vector<double> numbers_of(const std::string& line, std::size_t count, const std::string& path, int number)
{
    std::istringstream words(line.substr(1));
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
        char* end = nullptr;
        numbers.push_back(std::strtod(word.c_str(), &end));
        if (*end != '\0') throw InputError(path, number, line.substr(0, 1), word, "expected a number");
    }
    if (numbers.size() != count)
        throw InputError(path, number, line.substr(0, 1), line.substr(0, 40), "expected " + std::to_string(count) + " numbers");
    return numbers;
}

bool is_of_kind(const std::string& line, char kind)
{
    return line.size() > 1 && line[0] == kind && (line[1] == ' ' || line[1] == '\t');
}

}  // namespace

TetMesh read_tobj(const std::string& path)
{
    std::ifstream file(path);
    std::vector<double> coordinates;
    std::vector<int> corners, lines;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        if (is_of_kind(line, 'v')) {
            for (const double coordinate : numbers_of(line, 3, path, number)) coordinates.push_back(coordinate);
        } else if (is_of_kind(line, 't')) {
            for (const double index : numbers_of(line, 4, path, number)) {
                if (!(index >= 0.0 && index <= 2e9 && index == std::floor(index)))
                    throw InputError(path, number, "t", number_text(index, 12), "expected the number of a vertex, from 0");
                corners.push_back(static_cast<int>(index));
            }
            lines.push_back(number);
        }
    }
    TetMesh mesh;
    mesh.rest = Eigen::Map<const Positions>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3);
    mesh.tets = Eigen::Map<const Tets>(corners.data(), static_cast<Eigen::Index>(corners.size() / 4), 4);
    require_points(path, mesh.rest.rows());
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (const int vertex : mesh.tets.row(t))
            if (vertex >= mesh.rest.rows())
                throw InputError(path, lines[static_cast<std::size_t>(t)], "t", std::to_string(vertex),
                                 expected_whole("an index", 0, mesh.rest.rows() - 1));
    return mesh;
}

}  // namespace pbs
