// The door of the Gmsh module.
#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/module.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>

namespace pbs {
namespace {

constexpr const char* module_name = "pbskin_gmsh";

std::string first_word(const std::string& text)
{
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos) return "";
    return text.substr(begin, std::min<std::size_t>(text.find_first_of(" \t\r\n", begin) - begin, 40));
}

void check_msh(const std::string& path, const std::string& text)
{
    if (text.rfind("$MeshFormat", 0) != 0) throw InputError(path, 1, "", "", "expected a Gmsh file beginning with $MeshFormat");
    for (const char* section : {"Nodes", "Elements"}) {
        if (text.find(std::string("\n$") + section) == std::string::npos)
            throw InputError(path, 0, "", "", std::string("the section $") + section + " is missing");
        if (text.find(std::string("$End") + section) == std::string::npos)
            throw InputError(path, 0, "", "", std::string("truncated: $End") + section + " is missing");
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

void check_medit(const std::string& path, const std::string& text)
{
    if (first_word(text) != "MeshVersionFormatted")
        throw InputError(path, 1, "", "", "expected a MEDIT file beginning with MeshVersionFormatted");
    for (const char* section : {"Vertices", "Tetrahedra"})
        if (text.find(section) == std::string::npos)
            throw InputError(path, 0, "", "", std::string("the section ") + section + " is missing");
    check_medit_words(path, text);
}

// "$Nodes\n4\n" (2.2), "$Nodes\n1 4 1 4\n" (4.1: blocks, nodes, ...; binary: the same as size_t).
long long nodes_in_msh(const std::string& text)
{
    std::istringstream header(text.substr(text.find('\n')));
    double version = 0.0;
    int binary = 0;
    header.imbue(std::locale::classic());
    header >> version >> binary;
    const std::size_t nodes = text.find('\n', text.find("\n$Nodes") + 1) + 1;
    std::size_t numbers[2] = {};
    if (version == 4.1 && binary) {
        if (nodes + sizeof numbers > text.size()) return -1;
        std::memcpy(numbers, text.data() + nodes, sizeof numbers);
        return static_cast<long long>(numbers[1]);
    }
    std::istringstream counts(text.substr(nodes, 100));
    if (version == 4.1) counts >> numbers[0] >> numbers[1];
    if (version == 2.2) counts >> numbers[1];
    return counts && numbers[1] > 0 ? static_cast<long long>(numbers[1]) : -1;
}

long long vertices_in_medit(const std::string& text)
{
    std::istringstream count(text.substr(text.find("Vertices") + 8, 100));
    long long vertices = -1;
    count >> vertices;
    return count ? vertices : -1;
}

}  // namespace

long long check_gmsh_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (lower_extension(path) == ".msh")
        check_msh(path, text);
    else
        check_medit(path, text);
    load_module(module_name);
    return lower_extension(path) == ".msh" ? nodes_in_msh(text) : vertices_in_medit(text);
}

IndexedPoints read_gmsh(const std::string& path)
{
    IndexedPoints mesh;
    load_module(module_name).function<void(const std::string&, IndexedPoints&)>("pbskin_gmsh_read")(path, mesh);
    return mesh;
}

}  // namespace pbs
