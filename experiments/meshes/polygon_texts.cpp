// The words and counts of .ply, .off and .stl as texts. CGAL, which reads these files, stops within a word, so
// that 1.5.2 is 1.5 and an index 1.5 is 1, and leaves out what lies behind a count that is too small. A text that ends
// early is left to CGAL, which says so. Formats: G. Turk, The PLY polygon file format (1994); Geomview's manual on OFF;
// M. Burns, Automated Fabrication (1993), Sec. 6.5, on STL.
#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/meshes/text_words.hpp"

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

constexpr long long most = std::numeric_limits<int>::max();

void skip_numbers(TextWords& words, long long count, const char* field)
{
    for (; count > 0 && !words.at_end(); --count) words.number(field);
}

// A polygon: the number of its corners, and their indices, whose range is checked later.
void skip_polygon(TextWords& words)
{
    if (words.at_end()) return;
    for (long long corners = words.whole("corners of a face", 0, most); corners > 0 && !words.at_end(); --corners)
        words.whole("vertex of a face", -most, most);
}

void require_end(TextWords& words, const char* counts)
{
    if (words.at_end()) return;
    const std::string word(words.next(counts));
    words.fail(counts, word,
               "expected the numbers of points and faces that are listed; this word follows the last of them");
}

struct PlyProperty {
    bool is_list = false, is_index = false;
};

struct PlyElement {
    long long count = 0;
    std::vector<PlyProperty> properties = {};
};

std::vector<PlyElement> ply_header(TextWords& words)
{
    std::vector<PlyElement> elements;
    while (!words.at_end()) {
        const std::string_view word = words.next("header");
        if (word == "end_header") break;
        if (word == "element") {
            words.next("element");
            elements.push_back({words.whole("element", 0, most)});
        } else if (word == "property" && !elements.empty()) {
            const bool is_list = words.next("property") == "list";
            if (is_list) {
                words.next("property");
                words.next("property");
            }
            const std::string_view name = words.next("property");
            elements.back().properties.push_back({is_list, is_list && name.starts_with("vertex_ind")});
        } else if (word == "comment" || word == "obj_info") {
            words.skip_line();
        }
    }
    return elements;
}

void check_ply(TextWords words)
{
    for (const PlyElement& element : ply_header(words))
        for (long long row = 0; row < element.count && !words.at_end(); ++row)
            for (const PlyProperty& property : element.properties) {
                if (property.is_index)
                    skip_polygon(words);
                else
                    skip_numbers(words, property.is_list && !words.at_end() ? words.whole("property list", 0, most) : 1,
                                 "property");
            }
    require_end(words, "element");
}

// CGAL alone reads a file whose header announces normals, colours or texture coordinates.
void check_off(TextWords words)
{
    if (words.peek() == "OFF") words.next("OFF");
    if (!number_in(words.peek())) return;
    const long long points = words.whole("#points", 0, most),
                    faces = words.at_end() ? 0 : words.whole("#faces", 0, most);
    skip_numbers(words, 1, "#edges");
    skip_numbers(words, 3 * points, "point");
    for (long long face = 0; face < faces && !words.at_end(); ++face) {
        skip_polygon(words);
        words.skip_line();  // its colour
    }
    require_end(words, "#faces");
}

void check_stl(TextWords words)
{
    while (!words.at_end()) {
        const std::string_view word = words.next("keyword");
        if (word == "solid" || word == "endsolid")
            words.skip_line();  // its name
        else if (word == "vertex" || word == "normal")
            skip_numbers(words, 3, "coordinate");
    }
}

}  // namespace

void check_polygon_text(const std::string& path, const std::string& text, const std::string& extension)
{
    if (extension == ".ply") return check_ply(TextWords(path, text));
    if (extension == ".stl") return check_stl(TextWords(path, text));
    check_off(TextWords(path, text, '#'));
}

}  // namespace pbs
