#include "experiments/meshes/mesh_io.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/guarded_reading.hpp"
#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace pbs {
namespace {

enum class TetFormat { vtk, gmsh, medit, tetgen, tobj };

// By what the file holds; files of TetGen and HOBAK, which begin with plain numbers or vertices, by their extension.
TetFormat format_of(const std::string& path)
{
    const std::string beginning = beginning_of(path), extension = lower_extension(path);
    const auto holds = [&](const char* text) { return beginning.find(text) != std::string::npos; };
    if (holds("# vtk DataFile") || holds("<VTKFile")) return TetFormat::vtk;
    const std::string format = format_extension(path);
    if (format == ".msh") return TetFormat::gmsh;
    if (format == ".mesh") return TetFormat::medit;
    if (extension == ".vtu" || extension == ".pvtu" || extension == ".vtk") return TetFormat::vtk;
    if (extension == ".node" || extension == ".ele") return TetFormat::tetgen;
    if (extension == ".tobj") return TetFormat::tobj;
    throw InputError(path, 0, "extension", extension,
                     "expected a tet mesh: .msh, .vtu, .pvtu, .vtk, .mesh, .tobj, .node or .ele");
}

TetFile read_as_listed(const std::string& path)
{
    const TetFormat format = format_of(path);
    require_readable(path, format == TetFormat::vtk ? most_mesh_bytes : most_text_bytes);
    if (format == TetFormat::tetgen) return {.mesh = read_tetgen(path)};
    if (format == TetFormat::tobj) return {.mesh = read_tobj(path)};
    if (format == TetFormat::medit) return {.mesh = read_medit(path)};
    if (format == TetFormat::vtk) return {.mesh = read_guarded(path, "tets", read_vtk)};
    return read_msh(path);
}

// Keeps the first of the tets on the same four vertices: files list a tet once for each group or partition that it
// belongs to.
int drop_repeated_tets(Tets& tets)
{
    std::vector<std::pair<std::array<int, 4>, Eigen::Index>> sorted;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        std::array<int, 4> corners = {tets(t, 0), tets(t, 1), tets(t, 2), tets(t, 3)};
        std::sort(corners.begin(), corners.end());
        sorted.emplace_back(corners, t);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < sorted.size(); ++i)
        if (i == 0 || sorted[i].first != sorted[i - 1].first) kept.push_back(sorted[i].second);
    const auto repeated = static_cast<int>(sorted.size() - kept.size());
    std::sort(kept.begin(), kept.end());
    if (repeated > 0) tets = tets(kept, Eigen::all).eval();
    return repeated;
}

TetFile read_by_content(const std::string& path)
{
    TetFile file = read_as_listed(path);
    file.repeated_tets = drop_repeated_tets(file.mesh.tets);
    return file;
}

// TetGen's pair NAME.node and NAME.ele: plain numbers, '#' begins a comment, vertices counted from 0 or 1 as the first
// one says. Format: Si, "TetGen, a Delaunay-based quality tetrahedral mesh generator", ACM TOMS 41 (2015), and its
// manual, section 5.2.

// The lines of numbers of one file, one at a time.
class NumberLines {
public:
    explicit NumberLines(const std::string& path) : path_(path)
    {
        require_readable(path, most_text_bytes);
        file_.str(as_utf8(read_text_file(path)));
    }

    // The next line that holds numbers; at least `least` of them.
    const std::vector<double>& next(const char* field, std::size_t least)
    {
        do read_line(field);
        while (numbers_.empty());
        if (numbers_.size() < least) fail(field, text_, "expected at least " + std::to_string(least) + " numbers");
        return numbers_;
    }

    // The last of the stated number of lines has been read: no line of numbers follows.
    void require_end(const char* field, long long count)
    {
        while (file_.peek() != std::istringstream::traits_type::eof()) {
            read_line(field);
            if (!numbers_.empty())
                fail(field, std::to_string(count),
                     "expected the number of those that are listed; more lines follow the last of them");
        }
    }

    // A whole number from the current line.
    long long whole(const char* field, std::size_t column, long long low, long long high) const
    {
        const double number = numbers_[column];
        if (!(number >= static_cast<double>(low) && number <= static_cast<double>(high)) ||
            number != static_cast<double>(static_cast<long long>(number)))
            fail(field, number_text(number, 15), expected_whole("a whole number", low, high));
        return static_cast<long long>(number);
    }

    [[noreturn]] void fail(const std::string& field, const std::string& value, const std::string& rule) const
    {
        throw InputError(path_, line_, field, value, rule);
    }

private:
    void read_line(const char* field)
    {
        if (!std::getline(file_, text_)) fail(field, "", "truncated: the file ends here");
        ++line_;
        text_.erase(std::min(text_.find('#'), text_.size()));
        numbers_.clear();
        std::istringstream words(text_);
        for (std::string word; words >> word;) {
            const std::optional<double> number = number_in(word);
            if (!number) fail(field, text_.substr(0, 40), "expected numbers");
            numbers_.push_back(*number);
        }
    }

    std::string path_, text_;
    std::istringstream file_;
    int line_ = 0;
    std::vector<double> numbers_;
};

// A file of n bytes holds fewer than n entries: a larger count is damage. There may be fewer entries than the count:
// memory is reserved as they are read.
long long most_entries(const std::string& path)
{
    return static_cast<long long>(std::filesystem::file_size(path));
}

Positions read_nodes(const std::string& path, long long& first)
{
    NumberLines lines(path);
    lines.next("header", 2);
    const long long count = lines.whole("#points", 0, 0, most_entries(path));
    lines.whole("dimension", 1, 3, 3);
    require_points(path, count);
    std::vector<double> coordinates;
    first = 0;
    for (long long i = 0; i < count; ++i) {
        const std::vector<double>& numbers = lines.next("point", 4);
        if (i == 0) first = lines.whole("first point", 0, 0, 1);
        lines.whole("point", 0, first + i, first + i);
        coordinates.insert(coordinates.end(), numbers.begin() + 1, numbers.begin() + 4);
    }
    lines.require_end("#points", count);
    return Eigen::Map<const Positions>(coordinates.data(), count, 3);
}

Tets read_elements(const std::string& path, long long points, long long first)
{
    NumberLines lines(path);
    lines.next("header", 2);
    const long long count = lines.whole("#tets", 0, 0, most_entries(path));
    lines.whole("nodes per tet", 1, 4, 4);
    std::vector<int> corners;
    for (long long t = 0; t < count; ++t) {
        lines.next("tet", 5);
        for (std::size_t k = 1; k <= 4; ++k)
            corners.push_back(static_cast<int>(lines.whole("tet vertex", k, first, first + points - 1) - first));
    }
    lines.require_end("#tets", count);
    return Eigen::Map<const Tets>(corners.data(), count, 4);
}

// .tobj, the tet meshes of HOBAK: lines "v x y z" and "t a b c d", vertices counted from 0; '#' begins a comment, other
// lines (the triangles of the surface) are left out.

// `count` numbers after the first word of a line.
std::vector<double> numbers_of(const std::string& line, std::size_t count, const std::string& path, int number)
{
    std::istringstream words(line.substr(1));
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
        const std::optional<double> value = number_in(word);
        if (!value) throw InputError(path, number, line.substr(0, 1), word, "expected a number");
        numbers.push_back(*value);
    }
    if (numbers.size() != count)
        throw InputError(path, number, line.substr(0, 1), line.substr(0, 40),
                         "expected " + std::to_string(count) + " numbers");
    return numbers;
}

bool is_of_kind(const std::string& line, char kind)
{
    return line.size() > 1 && line[0] == kind && (line[1] == ' ' || line[1] == '\t');
}

}  // namespace

TetMesh read_tetgen(const std::string& path)
{
    long long first = 0;
    TetMesh mesh;
    mesh.rest = read_nodes(std::filesystem::path(path).replace_extension(".node").string(), first);
    mesh.tets = read_elements(std::filesystem::path(path).replace_extension(".ele").string(), mesh.rest.rows(), first);
    return mesh;
}

TetMesh read_tobj(const std::string& path)
{
    std::istringstream file(as_utf8(read_text_file(path)));
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
                    throw InputError(path, number, "t", number_text(index, 12),
                                     "expected the number of a vertex, from 0");
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

TetMesh read_tet_frame(const std::string& path)
{
    const SourceFile file(path);
    TetMesh mesh = read_by_content(path).mesh;
    check_frame(path, mesh);
    return mesh;
}

MeshReading read_tet_mesh(const std::string& path, bool for_computing)
{
    const SourceFile source(path);
    TetFile file = read_by_content(path);
    MeshReading reading = check_rest(path, std::move(file.mesh), for_computing);
    reading.listed_at = std::move(file.listed_at);
    reading.repeated_tets = file.repeated_tets;
    if (const std::string format = format_extension(path);
        (format == ".msh" || format == ".mesh") && format != lower_extension(path))
        reading.read_as = format;
    return reading;
}

void require_tet_mesh_format(const std::string& path)
{
    const std::string extension = lower_extension(path);
    if (extension != ".msh" && extension != ".vtu" && extension != ".mesh")
        throw InputError(path, 0, "extension", extension, "expected .msh, .vtu or .mesh");
}

void write_tet_mesh(const std::string& path, const TetMesh& mesh)
{
    require_tet_mesh_format(path);
    const std::string extension = lower_extension(path);
    if (extension == ".msh") return write_msh(path, mesh);
    if (extension == ".mesh") return write_medit(path, mesh);
    write_vtu(path, mesh.rest, mesh.tets, {});
}

}  // namespace pbs
