// Wavefront .obj: points, polygons and the names of their objects and groups, in double precision. tinyobjloader, in
// Debian 12 and 13, reads 2.9D-01 as 2.9 and 1.#QNAN as 1, loses the first point behind a byte order mark and all of
// UTF-16 without an error, and fails at comments behind faces and at lines that a backslash continues; assimp reads in
// single precision. Format: Wavefront Technologies, "Advanced Visualizer Manual", appendix B1, "Object files (.obj)".

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pbs {
namespace {

// The words of the lines that hold any. A line of points or corners that ends in a backslash goes on in the next one;
// behind names and comments a backslash is a part of them.
class Statements {
public:
    explicit Statements(std::string_view text) : text_(text) {}

    bool next()
    {
        words_.clear();
        for (bool goes_on = true; at_ < text_.size() && (goes_on || words_.empty());) goes_on = add_line();
        return !words_.empty();
    }
    const std::vector<std::string_view>& words() const { return words_; }
    int line() const { return line_; }  // the last one of the statement

private:
    bool add_line()
    {
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        std::string_view line = text_.substr(at_, end - at_);
        at_ = std::min(end + 1, text_.size());
        ++line_;
        constexpr std::string_view blanks = " \t\r\v\f", blanks_and_comment = " \t\r\v\f#";
        for (std::size_t begin = 0;
             (begin = line.find_first_not_of(blanks, begin)) != std::string_view::npos && line[begin] != '#';) {
            const std::size_t end_of_word =
                std::min(line.find_first_of(is_face() ? blanks_and_comment : blanks, begin), line.size());
            words_.push_back(line.substr(begin, end_of_word - begin));
            begin = end_of_word;
        }
        if (words_.empty() || (words_.front() != "v" && !is_face()) || !words_.back().ends_with('\\')) return false;
        words_.back().remove_suffix(1);
        if (words_.back().empty()) words_.pop_back();
        return true;
    }

    bool is_face() const { return !words_.empty() && words_.front() == "f"; }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 0;
    std::vector<std::string_view> words_;
};

struct ObjContent {
    std::vector<double> coordinates;                 // [m], 3 #S
    std::vector<std::vector<std::size_t>> polygons;  // places of points
    std::vector<int> lines;                          // of each polygon
    std::vector<std::string> names;                  // of objects and groups
    bool is_wanted = true;                           // the polygons that follow
    long long points() const { return static_cast<long long>(coordinates.size() / 3); }
};

void add_point(const std::string& path, const Statements& statement, ObjContent& content)
{
    const std::string field = "vertex " + std::to_string(content.points() + 1);  // counted from 1, as faces do
    for (std::size_t axis = 1; axis <= 3; ++axis) {
        const std::string word(axis < statement.words().size() ? statement.words()[axis] : "");
        const std::optional<double> number = number_in(word);
        if (!number) throw InputError(path, statement.line(), field, word, "expected three numbers");
        if (!(std::abs(*number) <= farthest_m))
            throw InputError(path, statement.line(), field, word,
                             "expected finite coordinates within 1e9 m of the origin");
        content.coordinates.push_back(*number);
    }
}

// Corners are vertex, vertex/texture, vertex//normal or all three, counted from 1, or backwards from -1, the last point
// so far.
void add_polygon(const std::string& path, const Statements& statement, ObjContent& content)
{
    std::vector<std::size_t>& polygon = content.polygons.emplace_back();
    content.lines.push_back(statement.line());
    for (std::size_t k = 1; k < statement.words().size(); ++k) {
        const std::string_view word = statement.words()[k];
        long long index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        const bool is_number = error == std::errc() && (end == word.data() + word.size() || *end == '/');
        if (!is_number || index == 0 || index < -content.points())
            throw InputError(path, statement.line(), "face", std::string(word),
                             "expected the number of a vertex, from 1 or, backwards, from -1 to " +
                                 std::to_string(-content.points()));
        polygon.push_back(static_cast<std::size_t>(index < 0 ? content.points() + index : index - 1));
    }
    if (polygon.size() < 3) {  // a point or a line
        content.polygons.pop_back();
        content.lines.pop_back();
    }
}

ObjContent content_of_obj(const std::string& path, const std::string& mesh_name)
{
    const std::string text = as_utf8(read_text_file(path, most_mesh_bytes));
    ObjContent content;
    content.is_wanted = mesh_name.empty();
    for (Statements statement(text); statement.next();) {
        const std::vector<std::string_view>& words = statement.words();
        if (words[0] == "v")
            add_point(path, statement, content);
        else if (words[0] == "f" && content.is_wanted)
            add_polygon(path, statement, content);
        else if ((words[0] == "o" || words[0] == "g") && !mesh_name.empty()) {
            content.is_wanted = std::find(words.begin() + 1, words.end(), mesh_name) != words.end();
            for (auto name = words.begin() + 1; name != words.end(); ++name)
                if (std::find(content.names.begin(), content.names.end(), *name) == content.names.end())
                    content.names.emplace_back(*name);
        }
    }
    for (std::size_t f = 0; f < content.polygons.size(); ++f)
        for (const std::size_t point : content.polygons[f])
            if (static_cast<long long>(point) >= content.points())
                throw InputError(path, content.lines[f], "face", std::to_string(point + 1),
                                 expected_whole("the number of a vertex", 1, content.points()));
    return content;
}

#ifndef PBS_WITH_CGAL
// Fans from the first corners, which cover convex polygons.
std::vector<int> fans(const std::string& path, const Positions& points, const ObjContent& content)
{
    std::vector<int> triangles;
    for (std::size_t f = 0; f < content.polygons.size(); ++f) {
        const std::vector<std::size_t>& polygon = content.polygons[f];
        const auto point = [&](std::size_t k) -> Vec3 { return points.row(static_cast<Eigen::Index>(polygon[k])); };
        Vec3 area = Vec3::Zero();
        const auto of_fan = [&](std::size_t k) -> Vec3 { return (point(k) - point(0)).cross(point(k + 1) - point(0)); };
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) area += of_fan(k);
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
            if (polygon.size() > 3 && of_fan(k).dot(area) < 0.0)
                throw InputError(path, content.lines[f], "face", std::to_string(polygon.size()) + " corners",
                                 "expected a convex polygon: this build triangulates no other one; configure it with "
                                 "-DPBS_WITH_CGAL=ON");
            for (const std::size_t corner : {polygon[0], polygon[k], polygon[k + 1]})
                triangles.push_back(static_cast<int>(corner));
        }
    }
    return triangles;
}
#endif

}  // namespace

SurfaceMesh read_obj(const std::string& path, const std::string& mesh_name)
{
    const ObjContent content = content_of_obj(path, mesh_name);
    if (content.polygons.empty() && !mesh_name.empty())
        throw InputError(path, 0, "mesh", mesh_name, "expected one of the file's meshes: " + name_list(content.names));
    SurfaceMesh mesh{Eigen::Map<const Positions>(content.coordinates.data(), content.points(), 3), {}};
#ifdef PBS_WITH_CGAL
    const std::vector<int> corners = triangulated(path, mesh.points, content.polygons);
#else
    const std::vector<int> corners = fans(path, mesh.points, content);
#endif
    mesh.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
    return mesh;
}

}  // namespace pbs
