// Reference: one mesh by hand, written in every version of the format as its specification states it: text, and bytes
// of either order.
#include "experiments/meshes/mesh_io.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace msh_files_tests {
namespace {

struct Node {
    int tag;
    std::array<double, 3> x;
};
struct Element {
    int number, type;  // of Gmsh
    std::vector<int> nodes;
};
constexpr int of_triangle = 2, of_tet = 4;

// Two tets that share a face, and a triangle of their skin.
struct Content {
    std::vector<Node> nodes = {{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {0, 1, 0}}, {4, {0, 0, 1}}, {5, {0, 0, -1}}};
    std::vector<Element> elements = {{1, of_triangle, {1, 2, 4}}, {2, of_tet, {1, 2, 3, 4}}, {3, of_tet, {1, 3, 2, 5}}};
    int nodes_told = 0, elements_told = 0;  // more than there are
};

struct Dialect {
    double version;
    bool is_binary = false, is_swapped = false;
};
const std::vector<Dialect> dialects = {{1.0},       {2.2}, {2.2, true}, {2.2, true, true}, {4.0},
                                       {4.0, true}, {4.1}, {4.1, true}, {4.1, true, true}};

// Values as words, or as bytes of either order.
class Values {
public:
    explicit Values(const Dialect& dialect) : dialect_(dialect) {}

    template <typename Number>
    Values& put(Number number)
    {
        if (!dialect_.is_binary) {
            std::ostringstream word;
            word << number << ' ';
            text += word.str();
            return *this;
        }
        std::array<char, sizeof(Number)> bytes;
        std::copy_n(reinterpret_cast<const char*>(&number), bytes.size(), bytes.begin());
        if (dialect_.is_swapped) std::reverse(bytes.begin(), bytes.end());
        text.append(bytes.begin(), bytes.end());
        return *this;
    }
    void end_line()
    {
        if (!dialect_.is_binary) text += '\n';
    }

    std::string text;

private:
    Dialect dialect_;
};

std::string nodes_of(const Dialect& dialect, const Content& content)
{
    Values values(dialect);
    const auto told = static_cast<std::uint64_t>(static_cast<int>(content.nodes.size()) + content.nodes_told);
    if (dialect.version < 4.0) {
        values.text = std::to_string(told) + "\n";
        for (const auto& [tag, x] : content.nodes)
            values.put<std::int32_t>(tag).put(x[0]).put(x[1]).put(x[2]).end_line();
        return values.text;
    }
    values.put<std::uint64_t>(1).put(told);
    if (dialect.version == 4.1) values.put<std::uint64_t>(1).put<std::uint64_t>(99);
    const std::array<std::int32_t, 2> entity = {dialect.version == 4.1 ? 3 : 1, dialect.version == 4.1 ? 1 : 3};
    values.put(entity[0]).put(entity[1]).put<std::int32_t>(0).put(told).end_line();
    if (dialect.version == 4.1)
        for (const Node& node : content.nodes) values.put(static_cast<std::uint64_t>(node.tag)).end_line();
    for (const auto& [tag, x] : content.nodes) {
        if (dialect.version == 4.0) values.put<std::int32_t>(tag);
        values.put(x[0]).put(x[1]).put(x[2]).end_line();
    }
    return values.text;
}

std::string elements_of(const Dialect& dialect, const Content& content)
{
    Values values(dialect);
    const auto told = static_cast<std::uint64_t>(static_cast<int>(content.elements.size()) + content.elements_told);
    if (dialect.version < 4.0)
        values.text = std::to_string(told) + "\n";
    else
        values.put(static_cast<std::uint64_t>(content.elements.size())).put(told);  // a block for each element
    if (dialect.version == 4.1) values.put<std::uint64_t>(1).put<std::uint64_t>(99);
    for (const auto& [number, type, nodes] : content.elements) {
        if (dialect.version == 1.0)
            values.put(number).put(type).put(7).put(8).put(nodes.size());
        else if (dialect.version == 2.2 && !dialect.is_binary)
            values.put(number).put(type).put(2).put(7).put(8);
        else if (dialect.version == 2.2)
            values.put(type)
                .put<std::int32_t>(1)
                .put<std::int32_t>(2)
                .put(number)
                .put<std::int32_t>(7)
                .put<std::int32_t>(8);
        else {
            values.put<std::int32_t>(3).put<std::int32_t>(3).put(type).put<std::uint64_t>(1).end_line();
            dialect.version == 4.1 ? values.put(static_cast<std::uint64_t>(number)) : values.put(number);
        }
        for (const int node : nodes)
            dialect.version == 4.1 ? values.put(static_cast<std::uint64_t>(node)) : values.put(node);
        values.end_line();
    }
    return values.text;
}

std::string msh(const Dialect& dialect, const Content& content)
{
    if (dialect.version == 1.0)
        return "$NOD\n" + nodes_of(dialect, content) + "$ENDNOD\n$ELM\n" + elements_of(dialect, content) + "$ENDELM\n";
    Values one(dialect);
    if (dialect.is_binary) one.put<std::int32_t>(1).text += '\n';
    const std::string version = dialect.version == 2.2 ? "2.2" : dialect.version == 4.0 ? "4" : "4.1";
    return "$MeshFormat\n" + version + (dialect.is_binary ? " 1 8\n" : " 0 8\n") + one.text +
           "$EndMeshFormat\n$Nodes\n" + nodes_of(dialect, content) + "\n$EndNodes\n$Elements\n" +
           elements_of(dialect, content) + "\n$EndElements\n";
}

std::string name_of(const Dialect& dialect)
{
    return std::to_string(dialect.version) + (dialect.is_binary ? " binary" : " text") +
           (dialect.is_swapped ? " swapped" : "");
}

class Msh : public test_support::FolderTest {
protected:
    std::string written(const Dialect& dialect, const Content& content) const
    {
        return folder.file("a.msh", msh(dialect, content));
    }
};

const pbs::Positions points = (pbs::Positions(5, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1).finished();
const pbs::Tets tets = (pbs::Tets(2, 4) << 0, 1, 2, 3, 0, 2, 1, 4).finished();

TEST_F(Msh, HoldsTheSameMeshInEveryVersionAsTextAndAsBytesOfEitherOrder)
{
    for (const Dialect& dialect : dialects) {
        const std::string path = written(dialect, {});
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.rest, points) << name_of(dialect);
        EXPECT_EQ(reading.mesh.tets, tets) << name_of(dialect);
        EXPECT_TRUE(pbs::remarks_on(path, reading).empty()) << name_of(dialect);
    }
}

TEST_F(Msh, NumbersVerticesByTagAndSaysSoWhereNodesAreListedInAnotherOrder)
{
    Content content;
    std::rotate(content.nodes.begin(), content.nodes.begin() + 2, content.nodes.end());  // 3 4 5 1 2
    for (const Dialect& dialect : dialects) {
        const std::string path = written(dialect, content);
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.rest, points) << name_of(dialect);
        EXPECT_EQ(reading.listed_at, (std::vector<int>{3, 4, 0, 1, 2})) << name_of(dialect);
        EXPECT_EQ(
            pbs::remarks_on(path, reading),
            std::vector{
                path +
                ": nodes = 5: not listed by their tags; vertices are numbered from 0 by ascending tag, as weights and "
                "frames must be"});
    }
}

TEST_F(Msh, MayHaveGapsInItsTagsAndNodesThatNoTetUses)
{
    Content content;
    for (Node& node : content.nodes) node.tag = 10 * node.tag;
    for (Element& element : content.elements)
        for (int& node : element.nodes) node = 10 * node;
    content.nodes.insert(content.nodes.begin() + 2, {25, {9, 9, 9}});
    for (const Dialect& dialect : dialects) {
        const pbs::MeshReading reading = pbs::read_tet_mesh(written(dialect, content));
        EXPECT_EQ(reading.mesh.rest, points) << name_of(dialect);
        EXPECT_EQ(reading.file_vertices, 6) << name_of(dialect);
        EXPECT_EQ(reading.unused_vertices, std::vector<int>{2}) << name_of(dialect);
    }
}

// Gmsh 2.2 lists a tet once for each of its groups, and partitions do.
TEST_F(Msh, CountsATetThatItListsTwiceOnceWithARemark)
{
    Content content;
    content.elements.push_back({4, of_tet, {2, 3, 1, 4}});
    for (const Dialect& dialect : dialects) {
        const std::string path = written(dialect, content);
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.tets, tets) << name_of(dialect);
        EXPECT_EQ(pbs::remarks_on(path, reading), std::vector{path + ": tets listed more than once = 1: counted once"});
        EXPECT_EQ(pbs::read_tet_frame(path).tets, tets) << name_of(dialect);
    }
}

TEST_F(Msh, KeepsAllTetsWhoseNumbersRepeat)
{
    Content content;
    content.elements[2].number = 2;
    for (const Dialect& dialect : dialects)
        EXPECT_EQ(pbs::read_tet_mesh(written(dialect, content)).mesh.tets, tets) << name_of(dialect);
}

TEST_F(Msh, RefusesCountsThatAreWrongByOne)
{
    for (const Dialect& dialect : dialects)
        for (const int more : {-1, 1}) {
            Content content{.nodes_told = more};
            const std::string of_nodes = written(dialect, content);
            EXPECT_THROW(pbs::read_tet_mesh(of_nodes), pbs::InputError) << name_of(dialect) << more;
            content = {.elements_told = more};
            const std::string of_elements = written(dialect, content);
            EXPECT_THROW(pbs::read_tet_mesh(of_elements), pbs::InputError) << name_of(dialect) << more;
        }
    const std::string path = written({2.2}, {.elements_told = -1});
    expect_input_error([&] { pbs::read_tet_mesh(path); }, path + ":17: elements = 2: ",
                       "expected the number of those that are listed; $EndElements does not follow the last of them");
}

TEST_F(Msh, RefusesOtherVolumesWrongTagsAndUnknownVersionsByName)
{
    Content content;
    content.elements[1] = {2, 5, {1, 2, 3, 4, 1, 2, 3, 4}};
    for (const Dialect& dialect : dialects) {
        const std::string path = written(dialect, content);
        expect_input_error([&] { pbs::read_tet_mesh(path); },
                           path + ": elements = hexahedron: ", "expected four-node tetrahedra");
    }
    content = {};
    content.elements[1].nodes[3] = 6;
    const std::string path = written({4.1}, content);
    expect_input_error([&] { pbs::read_tet_mesh(path); }, path + ": element 2 = 6: ", "expected the tag of a node");
    content = {};
    content.nodes[3].tag = 2;
    expect_input_error([&] { pbs::read_tet_mesh(written({4.1}, content)); },
                       path + ": node = 2: ", "expected each tag once");
    folder.file("a.msh", "$MeshFormat\n3 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n$EndElements\n");
    expect_input_error([&] { pbs::read_tet_mesh(path); }, path + ":2: version = 3: ", "gmsh FILE -save -format msh41");
}

TEST_F(Msh, AsTextMayHaveAByteOrderMarkTabsAndLineEndsOfWindows)
{
    std::string text = "\xEF\xBB\xBF";
    for (const char c : msh({4.1}, {})) text += c == '\n' ? "\r\n" : c == ' ' ? "\t" : std::string(1, c);
    const pbs::MeshReading reading = pbs::read_tet_mesh(folder.file("a.msh", text));
    EXPECT_EQ(reading.mesh.rest, points);
    EXPECT_EQ(reading.mesh.tets, tets);
}

}  // namespace
}  // namespace msh_files_tests
