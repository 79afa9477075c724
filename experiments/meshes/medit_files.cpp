// MEDIT's .mesh, a text of keywords, counts and numbers: keywords and counts stand on one line or on two, '#' begins a
// comment. Format: Frey, "MEDIT: an interactive mesh visualization software" (INRIA, 2001); Marechal, "libMeshb"
// (INRIA, 2018).

#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

bool is_keyword(std::string_view word)
{
    return std::isupper(static_cast<unsigned char>(word.front())) != 0 && !number_in(word);
}

void require_end_of_section(TextWords& words, const char* section, long long count)
{
    const std::string_view word = words.peek();
    if (word.empty() || is_keyword(word)) return;
    words.next(section);
    if (!number_in(word)) words.fail(section, std::string(word), "expected a keyword or a number");
    words.fail(section, std::to_string(count),
               "expected the number of those that are listed; more numbers follow the last of them");
}

struct MeditContent {
    std::vector<double> coordinates;  // [m], 3 #V
    std::vector<int> corners;         // from 1, 4 #T
    bool has_vertices = false, has_tets = false;
};

long long count_of(TextWords& words, const char* section)
{
    return words.whole(section, 0, static_cast<long long>(words.text().size()));  // each takes a byte or more
}

void read_vertices(TextWords& words, MeditContent& content)
{
    const long long vertices = count_of(words, "Vertices");
    for (long long i = 0; i < vertices; ++i) {
        for (int axis = 0; axis < 3; ++axis) content.coordinates.push_back(words.number("vertex"));
        words.number("reference of a vertex");
    }
    require_end_of_section(words, "Vertices", vertices);
    content.has_vertices = true;
}

void read_tetrahedra(TextWords& words, MeditContent& content)
{
    constexpr int most = 2'000'000'000;
    const long long tets = count_of(words, "Tetrahedra");
    for (long long t = 0; t < tets; ++t) {
        for (int corner = 0; corner < 4; ++corner)
            content.corners.push_back(static_cast<int>(words.whole("tet vertex", 1, most)));
        words.number("reference of a tet");
    }
    require_end_of_section(words, "Tetrahedra", tets);
    content.has_tets = true;
}

// Skips a section that is not needed: numbers and texts up to the next keyword.
void skip_section(TextWords& words, const std::string& section)
{
    constexpr std::array volumes = {"Hexahedra", "Prisms", "Pyramids", "TetrahedraP2"};
    if (std::find(volumes.begin(), volumes.end(), section) != volumes.end() && count_of(words, section.c_str()) > 0)
        words.fail("elements", section, "expected four-node tetrahedra");
    while (!words.at_end() && !is_keyword(words.peek())) {
        const std::string_view word = words.next(section.c_str());
        if (word.front() != '"' && !number_in(word))
            words.fail("word", std::string(word), "expected a number or a keyword");
    }
}

MeditContent content_of(const std::string& path)
{
    TextWords words(path, as_utf8(read_text_file(path)), '#');
    if (words.at_end() || words.next("MeshVersionFormatted") != "MeshVersionFormatted")
        throw InputError(path, 1, "", "", "expected a MEDIT file beginning with MeshVersionFormatted");
    words.whole("MeshVersionFormatted", 1, 4);
    MeditContent content;
    while (!words.at_end()) {
        const std::string keyword(words.next("keyword"));
        if (keyword == "End") break;
        if (keyword == "Dimension")
            words.whole("Dimension", 3, 3);
        else if (keyword == "Vertices")
            read_vertices(words, content);
        else if (keyword == "Tetrahedra")
            read_tetrahedra(words, content);
        else
            skip_section(words, keyword);
    }
    if (!content.has_vertices) throw InputError(path, 0, "", "", "the section Vertices is missing");
    if (!content.has_tets) throw InputError(path, 0, "", "", "the section Tetrahedra is missing");
    return content;
}

}  // namespace

TetMesh read_medit(const std::string& path)
{
    const MeditContent content = content_of(path);
    const auto points = static_cast<Eigen::Index>(content.coordinates.size() / 3);
    const auto tets = static_cast<Eigen::Index>(content.corners.size() / 4);
    for (std::size_t k = 0; k < content.corners.size(); ++k)
        if (content.corners[k] > points)
            throw InputError(path, 0, "tet " + std::to_string(k / 4 + 1) + " vertex",
                             std::to_string(content.corners[k]), expected_whole("a whole number", 1, points));
    return {Eigen::Map<const Positions>(content.coordinates.data(), points, 3),
            (Eigen::Map<const Tets>(content.corners.data(), tets, 4).array() - 1).matrix()};
}

}  // namespace pbs
