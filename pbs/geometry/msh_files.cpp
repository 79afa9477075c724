// The door of the Gmsh module.

#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/module.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

namespace pbs {
namespace {

constexpr const char* module_name = "pbskin_gmsh";

std::string first_word(const std::string& text)
{
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos) return "";
    return text.substr(begin, std::min<std::size_t>(text.find_first_of(" \t\r\n", begin) - begin, 40));
}

// The sections of a Gmsh file: version 1 has names of its own.
struct MshSections {
    const char *nodes, *end_nodes, *elements, *end_elements;
};

MshSections sections_of(const std::string& text)
{
    if (text.rfind("$NOD", 0) == 0) return {"$NOD", "$ENDNOD", "$ELM", "$ENDELM"};
    return {"$Nodes", "$EndNodes", "$Elements", "$EndElements"};
}

void check_msh(const std::string& path, const std::string& text)
{
    const MshSections sections = sections_of(text);
    if (text.rfind("$MeshFormat", 0) != 0 && text.rfind("$NOD", 0) != 0)
        throw InputError(path, 1, "", "", "expected a Gmsh file beginning with $MeshFormat");
    for (const auto& [begin, end] : {std::pair(sections.nodes, sections.end_nodes), std::pair(sections.elements, sections.end_elements)}) {
        if (("\n" + text).find(std::string("\n") + begin) == std::string::npos)
            throw InputError(path, 0, "", "", std::string("the section ") + begin + " is missing");
        if (text.find(end) == std::string::npos) throw InputError(path, 0, "", "", std::string("truncated: ") + end + " is missing");
    }
}

bool is_number(const std::string& word)
{
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    return end != word.c_str() && *end == '\0';
}

// Gmsh takes what is no number for the number before it: a line holds a keyword and numbers, or numbers alone.
void check_medit_words(const std::string& path, const std::string& text)
{
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream words(line.substr(0, line.find('#')));
        std::string word;
        if (words >> word && !is_number(word) && !(word[0] >= 'A' && word[0] <= 'Z'))
            throw InputError(path, number, "word", word.substr(0, 40), "expected a number or a keyword");
        while (words >> word)
            if (!is_number(word)) throw InputError(path, number, "word", word.substr(0, 40), "expected a number");
    }
}

// The number of entries that a section of a MEDIT file states, and how many numbers follow it.
std::pair<long long, long long> medit_section(const std::string& text, const std::string& name)
{
    std::istringstream lines(text.substr(text.find(name) + name.size()));
    long long entries = -1, numbers = -1;  // the number of entries itself
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        for (std::string word; words >> word; ++numbers) {
            if (!is_number(word)) return {entries, numbers};
            if (numbers < 0) entries = static_cast<long long>(std::strtod(word.c_str(), nullptr));
        }
    }
    return {entries, numbers};
}

void check_medit(const std::string& path, const std::string& text)
{
    if (first_word(text) != "MeshVersionFormatted")
        throw InputError(path, 1, "", "", "expected a MEDIT file beginning with MeshVersionFormatted");
    for (const char* section : {"Vertices", "Tetrahedra"})
        if (text.find(section) == std::string::npos)
            throw InputError(path, 0, "", "", std::string("the section ") + section + " is missing");
    check_medit_words(path, text);
    // Gmsh takes what is missing of the last tet from its memory.
    if (const auto [tets, numbers] = medit_section(text, "Tetrahedra"); numbers < 5 * tets)
        throw InputError(path, 0, "Tetrahedra", std::to_string(tets),
                         "truncated: expected five numbers each, and there are " + std::to_string(numbers));
}

// The text after the line "$Nodes".
std::size_t begin_of_nodes(const std::string& text)
{
    return text.find('\n', ("\n" + text).find(std::string("\n") + sections_of(text).nodes)) + 1;
}

// "4\n" (1, 2.2), "1 4 1 4\n" (4.1: blocks, nodes, ...; binary: the same as size_t).
long long nodes_in_msh(const std::string& text)
{
    double version = 1.0;
    int binary = 0;
    if (text.rfind("$MeshFormat", 0) == 0) {
        std::istringstream header(text.substr(text.find('\n'), 100));
        header.imbue(std::locale::classic());
        header >> version >> binary;
    }
    const std::size_t nodes = begin_of_nodes(text);
    std::size_t numbers[2] = {};
    if (version == 4.1 && binary) {
        if (nodes + sizeof numbers > text.size()) return -1;
        std::memcpy(numbers, text.data() + nodes, sizeof numbers);
        return static_cast<long long>(numbers[1]);
    }
    std::istringstream counts(text.substr(nodes, 100));
    if (version == 4.1) counts >> numbers[0] >> numbers[1];
    if (version < 4.0) counts >> numbers[1];
    return counts && numbers[1] > 0 ? static_cast<long long>(numbers[1]) : -1;
}

long long vertices_in_medit(const std::string& text)
{
    std::istringstream count(text.substr(text.find("Vertices") + 8, 100));
    long long vertices = -1;
    count >> vertices;
    return count ? vertices : -1;
}

// Whether a text file has as many lines of nodes as it states. Those of a binary file cannot be counted like this.
bool has_all_nodes(const std::string& text, long long nodes)
{
    const std::size_t begin = begin_of_nodes(text);
    std::istringstream lines(text.substr(begin, text.find(sections_of(text).end_nodes) - begin));
    long long count = -1;  // the line of the number itself
    for (std::string line; std::getline(lines, line);) count += !first_word(line).empty();
    return count == nodes;
}

// Gmsh leaves out the nodes that no element uses. If the file numbers its nodes from 1 without gaps, each gets its place back; those that
// were left out are put at the origin, and no tet names them.
void restore_unused(const std::vector<std::size_t>& tags, Eigen::Index nodes, TetMesh& mesh)
{
    if (tags.empty() || tags.front() < 1 || static_cast<Eigen::Index>(tags.back()) > nodes) return;
    Positions points = Positions::Zero(nodes, 3);
    for (std::size_t p = 0; p < tags.size(); ++p)
        points.row(static_cast<Eigen::Index>(tags[p]) - 1) = mesh.rest.row(static_cast<Eigen::Index>(p));
    mesh.tets = mesh.tets.unaryExpr([&](int p) { return static_cast<int>(tags[static_cast<std::size_t>(p)]) - 1; }).eval();
    mesh.rest = std::move(points);
}

bool is_msh(const std::string& path)
{
    return format_extension(path) == ".msh";
}

// Gmsh 4.1 and MEDIT, both ASCII with 17 digits, one entity (3, 1) holding all tets.
// Formats: Gmsh reference manual 4.8, "MSH file format"; MEDIT, Frey, "MEDIT: an interactive mesh visualization software" (INRIA, 2001).

// 17 significant digits name a double exactly. Whatever the locale of the program that uses this library.
void write_text(const std::string& path, const std::function<void(std::ostringstream&)>& write)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(17);
    write(text);
    write_atomically(path, text.str());
}

void write_point(std::ostringstream& file, const Positions& points, Eigen::Index i)
{
    file << points(i, 0) << ' ' << points(i, 1) << ' ' << points(i, 2);
}

void write_corners(std::ostringstream& file, const Tets& tets, Eigen::Index t)
{
    for (int corner = 0; corner < 4; ++corner) file << tets(t, corner) + 1 << ' ';
}

void write_msh_entities(std::ostringstream& file, const Positions& points)
{
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    if (points.rows() > 0) {
        low = points.colwise().minCoeff().transpose();
        high = points.colwise().maxCoeff().transpose();
    }
    file << "$Entities\n0 0 0 1\n1 " << low.transpose() << ' ' << high.transpose() << " 0 0\n$EndEntities\n";
}

}  // namespace

long long check_gmsh_file(const std::string& path)
{
    const std::string text = read_text_file(path);
    is_msh(path) ? check_msh(path, text) : check_medit(path, text);
    load_module(module_name);
    return is_msh(path) ? nodes_in_msh(text) : vertices_in_medit(text);
}

TetMesh read_gmsh(const std::string& path, const std::string& named)
{
    TetMesh mesh;
    std::vector<std::size_t> tags;
    load_module(module_name)
        .function<void(const std::string&, const std::string&, TetMesh&, std::vector<std::size_t>&)>("pbskin_gmsh_read")(path, named, mesh,
                                                                                                                         tags);
    const std::string text = read_text_file(path);
    const bool msh = is_msh(path);
    const long long nodes = msh ? nodes_in_msh(text) : vertices_in_medit(text);
    if (nodes > mesh.rest.rows() && (msh ? has_all_nodes(text, nodes) : medit_section(text, "Vertices").second == 4 * nodes))
        restore_unused(tags, nodes, mesh);
    return mesh;
}

void write_msh(const std::string& path, const TetMesh& mesh)
{
    write_text(path, [&](std::ostringstream& file) {
        const Eigen::Index points = mesh.rest.rows(), tets = mesh.tets.rows();
        file << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
        write_msh_entities(file, mesh.rest);
        file << "$Nodes\n1 " << points << " 1 " << points << "\n3 1 0 " << points << '\n';
        for (Eigen::Index i = 0; i < points; ++i) file << i + 1 << '\n';
        for (Eigen::Index i = 0; i < points; ++i) {
            write_point(file, mesh.rest, i);
            file << '\n';
        }
        file << "$EndNodes\n$Elements\n1 " << tets << " 1 " << tets << "\n3 1 4 " << tets << '\n';
        for (Eigen::Index t = 0; t < tets; ++t) {
            file << t + 1 << ' ';
            write_corners(file, mesh.tets, t);
            file << '\n';
        }
        file << "$EndElements\n";
    });
}

void write_medit(const std::string& path, const TetMesh& mesh)
{
    write_text(path, [&](std::ostringstream& file) {
        file << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.rest.rows() << '\n';
        for (Eigen::Index i = 0; i < mesh.rest.rows(); ++i) {
            write_point(file, mesh.rest, i);
            file << " 1\n";
        }
        file << "Tetrahedra\n" << mesh.tets.rows() << '\n';
        for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
            write_corners(file, mesh.tets, t);
            file << "1\n";
        }
        file << "End\n";
    });
}

}  // namespace pbs
