// Gmsh's .msh 1, 2 to 2.2, 4.0 and 4.1, as text and as bytes of either order. Gmsh's library is no help here: it drops
// elements whose number occurred before and nodes that no element uses, and it does not tell in which order the file
// lists its nodes, which is the order that exporters give to frames. What is read here is compared with its files in
// tests/verification. Format: Gmsh reference manual 4.13, "MSH file format" and "Legacy formats".

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace pbs {
namespace {

struct ElementType {
    int nodes, dimension;
    const char* name;
};
constexpr int tet_type = 4;
constexpr std::array<ElementType, 32> element_types = {{{0, 0, ""},
                                                        {2, 1, "line"},
                                                        {3, 2, "triangle"},
                                                        {4, 2, "quadrangle"},
                                                        {4, 3, "tetrahedron"},
                                                        {8, 3, "hexahedron"},
                                                        {6, 3, "prism"},
                                                        {5, 3, "pyramid"},
                                                        {3, 1, "line of 3 nodes"},
                                                        {6, 2, "triangle of 6 nodes"},
                                                        {9, 2, "quadrangle of 9 nodes"},
                                                        {10, 3, "tetrahedron of 10 nodes"},
                                                        {27, 3, "hexahedron of 27 nodes"},
                                                        {18, 3, "prism of 18 nodes"},
                                                        {14, 3, "pyramid of 14 nodes"},
                                                        {1, 0, "point"},
                                                        {8, 2, "quadrangle of 8 nodes"},
                                                        {20, 3, "hexahedron of 20 nodes"},
                                                        {15, 3, "prism of 15 nodes"},
                                                        {13, 3, "pyramid of 13 nodes"},
                                                        {9, 2, "triangle of 9 nodes"},
                                                        {10, 2, "triangle of 10 nodes"},
                                                        {12, 2, "triangle of 12 nodes"},
                                                        {15, 2, "triangle of 15 nodes"},
                                                        {15, 2, "triangle of 15 nodes, incomplete"},
                                                        {21, 2, "triangle of 21 nodes"},
                                                        {4, 1, "line of 4 nodes"},
                                                        {5, 1, "line of 5 nodes"},
                                                        {6, 1, "line of 6 nodes"},
                                                        {20, 3, "tetrahedron of 20 nodes"},
                                                        {35, 3, "tetrahedron of 35 nodes"},
                                                        {56, 3, "tetrahedron of 56 nodes"}}};

// The sections of a file: version 1 has names of its own.
struct Sections {
    const char *nodes, *end_nodes, *elements, *end_elements;
};

// The values of a file, which are words of a text or bytes.
class MshValues {
public:
    explicit MshValues(const std::string& path) : path_(path), words_(path, as_utf8(read_text_file(path)))
    {
        const std::string& text = words_.text();
        if (!text.starts_with("$MeshFormat") && !text.starts_with("$NOD"))
            throw InputError(path, 1, "", "", "expected a Gmsh file beginning with $MeshFormat");
        if (text.starts_with("$MeshFormat")) read_format();
        require_sections();
    }

    double version() const { return version_; }
    bool is_binary() const { return is_binary_; }
    Sections sections() const
    {
        if (version_ == 1.0) return {"$NOD", "$ENDNOD", "$ELM", "$ENDELM"};
        return {"$Nodes", "$EndNodes", "$Elements", "$EndElements"};
    }

    // Goes behind the line that begins a section.
    void enter(const char* section)
    {
        words_.go_to(place_of(section));
        words_.skip_line();
    }
    // The same for the next section of this name after the last one; false: there is none.
    bool enter_next(const std::string& section)
    {
        const std::size_t place = place_of(section, searched_);
        if (place == std::string::npos) return false;
        searched_ = place + section.size();
        words_.go_to(place);
        words_.skip_line();
        return true;
    }
    std::string word(const char* field) { return std::string(words_.next(field)); }
    // The line that begins with the next word, without the quotation marks around it: a text may have blanks.
    std::string text_line(const char* field)
    {
        const std::string& text = words_.text();
        const auto begin = static_cast<std::size_t>(words_.next(field).data() - text.data());
        const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        words_.go_to(end);
        const std::string line = text.substr(begin, end - begin);
        const std::size_t last = line.find_last_not_of(" \t\"");
        if (!line.starts_with('"')) return line.substr(0, line.find_last_not_of(" \t") + 1);
        return last == std::string::npos ? "" : line.substr(1, last);
    }
    // A number that is a word in binary files, too.
    long long whole_word(const char* field) { return words_.whole(field, 0, std::numeric_limits<std::int32_t>::max()); }
    void begin_data()
    {
        if (is_binary_) words_.skip_line();
    }
    // The section ends here, or its count is wrong.
    void leave(const std::string& end, const char* field, long long count)
    {
        if (words_.peek() == end) return;
        const std::string rule =
            "expected the number of those that are listed; " + end + " does not follow the last of them";
        if (is_binary_) throw InputError(path_, 0, field, std::to_string(count), rule);
        words_.next(field);
        words_.fail(field, std::to_string(count), rule);
    }
    // A number of things that follow, each of which takes a byte or more. Version 2 writes it as a word in binary
    // files, too.
    long long count(const char* field)
    {
        const auto most = static_cast<long long>(words_.text().size());
        if (version_ >= 4.0) return whole<std::uint64_t>(field, 0, most);
        const long long count = words_.whole(field, 0, most);
        if (is_binary_) words_.skip_line();
        return count;
    }
    long long tag(const char* field)
    {
        return version_ >= 4.1 ? whole<std::uint64_t>(field) : whole<std::int32_t>(field);
    }

    template <typename Integer>
    long long whole(const char* field, long long low = std::numeric_limits<long long>::min(),
                    long long high = std::numeric_limits<long long>::max())
    {
        if (!is_binary_) return words_.whole(field, low, high);
        const Integer stored = of_bytes<Integer>(field);
        const auto number = static_cast<long long>(stored);
        if (!std::in_range<long long>(stored) || number < low || number > high)
            throw InputError(path_, 0, field, std::to_string(stored), expected_whole("a whole number", low, high));
        return number;
    }
    double real(const char* field) { return is_binary_ ? of_bytes<double>(field) : words_.number(field); }

private:
    void read_format()
    {
        words_.skip_line();
        version_ = words_.number("version");
        constexpr std::array known = {2.0, 2.1, 2.2, 4.0, 4.1};
        if (std::find(known.begin(), known.end(), version_) == known.end())
            words_.fail("version", number_text(version_),
                        "expected 1, 2 to 2.2, 4 or 4.1: save it anew (gmsh FILE -save -format msh41)");
        is_binary_ = words_.whole("file type", 0, 1) == 1;
        if (!is_binary_) return;
        words_.whole("bytes of a number", 8, 8);
        words_.skip_line();
        const auto one = of_bytes<std::int32_t>("order of bytes");
        is_swapped_ = one != 1;
        if (is_swapped_ && one != 1 << 24)
            throw InputError(path_, 0, "order of bytes", std::to_string(one), "expected 1 or 16777216");
    }

    // The place of the line that begins with a keyword; npos: there is no such line.
    std::size_t place_of(const std::string& keyword, std::size_t from = 0) const
    {
        const std::string& text = words_.text();
        const std::size_t before = text.find("\n" + keyword, from);
        return from == 0 && text.starts_with(keyword) ? 0 : before == std::string::npos ? before : before + 1;
    }

    void require_sections() const
    {
        const auto [nodes, end_nodes, elements, end_elements] = sections();
        for (const auto& [begin, end] : {std::pair(nodes, end_nodes), std::pair(elements, end_elements)}) {
            if (place_of(begin) == std::string::npos)
                throw InputError(path_, 0, "", "", std::string("the section ") + begin + " is missing");
            if (place_of(end) == std::string::npos)
                throw InputError(path_, 0, "", "", std::string("truncated: ") + end + " is missing");
        }
    }

    template <typename Number>
    Number of_bytes(const char* field)
    {
        std::array<char, sizeof(Number)> bytes;
        const std::string_view read = words_.bytes(bytes.size(), field);
        std::copy(read.begin(), read.end(), bytes.begin());
        if (is_swapped_) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<Number>(bytes);
    }

    std::string path_;
    TextWords words_;
    double version_ = 1.0;
    bool is_binary_ = false, is_swapped_ = false;
    std::size_t searched_ = 0;
};

// As the file lists them.
struct MshContent {
    std::vector<long long> node_tags, tet_tags, corners;  // #V, #T, 4 #T
    std::vector<double> coordinates;                      // [m], 3 #V
};

// The head of a block in version 4, which all its entries share.
struct Block {
    int dimension;
    bool is_parametric;
    int type;
    long long entries;
};

Block read_block(MshValues& values, bool of_nodes)
{
    long long dimension = values.whole<std::int32_t>("entity"), tag = values.whole<std::int32_t>("entity");
    if (values.version() < 4.1) std::swap(dimension, tag);
    const long long last = values.whole<std::int32_t>(of_nodes ? "parametric" : "element type");
    return {static_cast<int>(std::clamp(dimension, 0LL, 3LL)), of_nodes && last != 0,
            of_nodes ? 0 : static_cast<int>(last), values.count(of_nodes ? "nodes of a block" : "elements of a block")};
}

void read_point(MshValues& values, MshContent& content, int parameters)
{
    for (int axis = 0; axis < 3; ++axis) content.coordinates.push_back(values.real("node"));
    for (int p = 0; p < parameters; ++p) values.real("node");
}

void require_sum(const std::string& path, const char* field, long long stated, std::size_t in_blocks)
{
    if (static_cast<std::size_t>(stated) != in_blocks)
        throw InputError(path, 0, field, std::to_string(stated),
                         "expected the sum of the blocks, " + std::to_string(in_blocks));
}

void read_msh_nodes(const std::string& path, MshValues& values, MshContent& content)
{
    values.enter(values.sections().nodes);
    if (values.version() < 4.0) {
        const long long nodes = values.count("nodes");
        for (long long i = 0; i < nodes; ++i) {
            content.node_tags.push_back(values.tag("node"));
            read_point(values, content, 0);
        }
        return values.leave(values.sections().end_nodes, "nodes", nodes);
    }
    const long long blocks = values.count("blocks"), nodes = values.count("nodes");
    for (int k = 0; k < (values.version() >= 4.1 ? 2 : 0); ++k) values.tag("least and largest tag");
    for (long long b = 0; b < blocks; ++b) {
        const Block block = read_block(values, true);
        const int parameters = block.is_parametric ? block.dimension : 0;
        if (values.version() >= 4.1)
            for (long long i = 0; i < block.entries; ++i) content.node_tags.push_back(values.tag("node"));
        for (long long i = 0; i < block.entries; ++i) {
            if (values.version() < 4.1) content.node_tags.push_back(values.tag("node"));
            read_point(values, content, parameters);
        }
    }
    values.leave(values.sections().end_nodes, "nodes", nodes);
    require_sum(path, "nodes", nodes, content.node_tags.size());
}

const ElementType& volume_is_tet(const std::string& path, long long type)
{
    if (type < 1 || type >= static_cast<long long>(element_types.size()))
        throw InputError(path, 0, "element type", std::to_string(type),
                         "expected 1 to 31; four-node tetrahedra have type 4");
    const ElementType& of = element_types[static_cast<std::size_t>(type)];
    if (of.dimension == 3 && type != tet_type)
        throw InputError(path, 0, "elements", of.name, "expected four-node tetrahedra");
    return of;
}

void read_corners(MshValues& values, long long type, int nodes, long long tag, MshContent& content)
{
    if (type == tet_type) content.tet_tags.push_back(tag);
    for (int k = 0; k < nodes; ++k) {
        const long long node = values.tag("node of an element");
        if (type == tet_type) content.corners.push_back(node);
    }
}

// Version 1: number, type, two regions, number of nodes. Version 2: number, type, number of tags, tags; in bytes, runs
// of elements share type and number of tags.
void read_listed_elements(const std::string& path, MshValues& values, MshContent& content)
{
    const long long elements = values.count("elements");
    long long type = 0, tags = 0;
    for (long long e = 0, in_run = 0; e < elements; ++e) {
        if (values.is_binary() && in_run == 0) {
            type = values.whole<std::int32_t>("element type");
            in_run = values.whole<std::int32_t>("elements of a run", 1, elements - e);
            tags = values.whole<std::int32_t>("tags", 0, 1LL << 30);
        }
        const long long number = values.tag("element");
        if (values.is_binary()) {
            --in_run;
        } else {
            type = values.whole<std::int32_t>("element type");
            tags = values.version() < 2.0 ? 3 : values.whole<std::int32_t>("tags", 0, 1LL << 30);
        }
        const int nodes = volume_is_tet(path, type).nodes;
        for (long long t = 0; t < tags; ++t) values.whole<std::int32_t>("tag of an element");
        read_corners(values, type, nodes, number, content);
    }
    values.leave(values.sections().end_elements, "elements", elements);
}

void read_msh_elements(const std::string& path, MshValues& values, MshContent& content)
{
    values.enter(values.sections().elements);
    if (values.version() < 4.0) return read_listed_elements(path, values, content);
    const long long blocks = values.count("blocks"), elements = values.count("elements");
    std::size_t in_blocks = 0;
    for (int k = 0; k < (values.version() >= 4.1 ? 2 : 0); ++k) values.tag("least and largest tag");
    for (long long b = 0; b < blocks; ++b) {
        const Block block = read_block(values, false);
        const int nodes = volume_is_tet(path, block.type).nodes;
        for (long long e = 0; e < block.entries; ++e)
            read_corners(values, block.type, nodes, values.tag("element"), content);
        in_blocks += static_cast<std::size_t>(block.entries);
    }
    values.leave(values.sections().end_elements, "elements", elements);
    require_sum(path, "elements", elements, in_blocks);
}

// Indices that put the tags in ascending order; equal ones stay in theirs.
std::vector<std::size_t> ascending(const std::vector<long long>& tags)
{
    std::vector<std::size_t> order(tags.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
    return order;
}

// The head of a $NodeData: texts, of which the first is a name, real numbers, and whole numbers: a step, the components
// and the nodes.
struct NodeData {
    std::string name;
    long long components = 0, nodes = 0;
};

NodeData read_head_of_data(MshValues& values)
{
    NodeData data;
    for (long long i = values.whole_word("texts of $NodeData"); i > 0; --i) {
        const std::string text = values.text_line("text of $NodeData");
        if (data.name.empty()) data.name = text;
    }
    for (long long i = values.whole_word("real numbers of $NodeData"); i > 0; --i)
        values.word("real number of $NodeData");
    const long long count = values.whole_word("whole numbers of $NodeData");
    for (long long i = 0; i < count; ++i) {
        const long long number = values.whole_word("whole number of $NodeData");
        if (i == 1) data.components = number;
        if (i == 2) data.nodes = number;
    }
    values.begin_data();
    return data;
}

// #nodes x components, in the order of the nodes' tags.
Eigen::MatrixXd read_node_data(const std::string& path, MshValues& values, const NodeData& data,
                               const std::vector<long long>& tags)
{
    const auto nodes = static_cast<Eigen::Index>(tags.size());
    const std::string field = "nodes of $NodeData " + data.name;
    if (data.nodes != nodes)
        throw InputError(path, 0, field, std::to_string(data.nodes), "expected each of the " + std::to_string(nodes));
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(nodes, data.components);
    std::vector<bool> is_known(tags.size());
    for (Eigen::Index i = 0; i < nodes; ++i) {
        const long long tag = values.whole<std::int32_t>("node of $NodeData");
        const auto found = std::ranges::lower_bound(tags, tag);
        const auto row = found - tags.begin();
        if (found == tags.end() || *found != tag || is_known[static_cast<std::size_t>(row)])
            throw InputError(path, 0, field, std::to_string(tag), "expected the tag of each node once");
        is_known[static_cast<std::size_t>(row)] = true;
        for (Eigen::Index c = 0; c < data.components; ++c) rows(row, c) = values.real("value of $NodeData");
    }
    values.leave("$EndNodeData", "nodes of $NodeData", data.nodes);
    return rows;
}

}  // namespace

std::map<std::string, Eigen::MatrixXd> read_msh_point_arrays(const std::string& path, const std::string& name)
{
    MshValues values(path);
    MshContent content;
    read_msh_nodes(path, values, content);
    std::ranges::sort(content.node_tags);
    std::map<std::string, Eigen::MatrixXd> arrays;
    while (values.enter_next("$NodeData")) {
        const NodeData data = read_head_of_data(values);
        if ((data.components != 1 && data.components != 3) || (!name.empty() && name != data.name)) continue;
        const bool has_steps = arrays.contains(data.name), is_partial = data.nodes != std::ssize(content.node_tags);
        if (has_steps && !name.empty())
            throw InputError(path, 0, "$NodeData", data.name,
                             "expected one of each name: save each step in a file of its own");
        if (name.empty() && (has_steps || is_partial))
            arrays[data.name].resize(0, data.components);
        else
            arrays.emplace(data.name, read_node_data(path, values, data, content.node_tags));
    }
    return arrays;
}

TetFile read_msh(const std::string& path)
{
    MshValues values(path);
    MshContent content;
    read_msh_nodes(path, values, content);
    read_msh_elements(path, values, content);

    TetFile file;
    const auto vertices = static_cast<Eigen::Index>(content.node_tags.size());
    file.mesh.rest.resize(vertices, 3);
    file.listed_at.reserve(content.node_tags.size());
    std::unordered_map<long long, int> index_of;
    for (const std::size_t from : ascending(content.node_tags)) {
        const int to = static_cast<int>(index_of.size());
        if (!index_of.emplace(content.node_tags[from], to).second)
            throw InputError(path, 0, "node", std::to_string(content.node_tags[from]), "expected each tag once");
        file.mesh.rest.row(to) = Eigen::Map<const Eigen::RowVector3d>(content.coordinates.data() + 3 * from);
        file.listed_at.push_back(static_cast<int>(from));
    }
    if (std::is_sorted(file.listed_at.begin(), file.listed_at.end())) file.listed_at.clear();

    file.mesh.tets.resize(static_cast<Eigen::Index>(content.tet_tags.size()), 4);
    Eigen::Index to = 0;
    for (const std::size_t from : ascending(content.tet_tags)) {
        for (std::size_t k = 0; k < 4; ++k) {
            const auto found = index_of.find(content.corners[4 * from + k]);
            if (found == index_of.end())
                throw InputError(path, 0, "element " + std::to_string(content.tet_tags[from]),
                                 std::to_string(content.corners[4 * from + k]), "expected the tag of a node");
            file.mesh.tets(to, static_cast<Eigen::Index>(k)) = found->second;
        }
        ++to;
    }
    return file;
}

}  // namespace pbs
