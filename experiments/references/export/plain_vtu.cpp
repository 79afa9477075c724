#include "experiments/references/export/plain_vtu.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string_view>

namespace experiments {
namespace {

constexpr int vtk_tetra = 10;  // the type of a cell

// One row per line. `values` is a matrix of Eigen; VTK takes the corners of all cells for one component.
template <typename Values>
void add_array(std::string& text, const char* type, const std::string& name, const Values& values,
               Eigen::Index components)
{
    auto end = std::back_inserter(text);
    fmt::format_to(end, "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type, name,
                   components);
    for (Eigen::Index row = 0; row < values.rows(); ++row)
        for (Eigen::Index column = 0; column < values.cols(); ++column)
            fmt::format_to(end, "{}{}", values(row, column), column + 1 < values.cols() ? ' ' : '\n');
    text += "</DataArray>\n";
}

void add_labels(std::string& text, const std::string& name, const std::vector<int>& labels)
{
    add_array(text, "Int32", name, Eigen::VectorXi::Map(labels.data(), static_cast<Eigen::Index>(labels.size())), 1);
}

void add_cells(std::string& text, const pbs::Tets& tets)
{
    text += "<Cells>\n";
    add_array(text, "Int64", "connectivity", tets, 1);
    const Eigen::VectorXi ends = Eigen::VectorXi::LinSpaced(tets.rows(), 4, 4 * static_cast<int>(tets.rows()));
    add_array(text, "Int64", "offsets", ends, 1);
    add_array(text, "UInt8", "types", Eigen::VectorXi::Constant(tets.rows(), vtk_tetra).eval(), 1);
    text += "</Cells>\n";
}

std::vector<double> numbers_in(const std::string& path, const std::string& array, std::string_view text)
{
    constexpr const char* blanks = " \t\r\n";
    std::vector<double> numbers;
    for (std::size_t begin = text.find_first_not_of(blanks), end = 0; begin != text.npos;
         begin = text.find_first_not_of(blanks, end)) {
        end = std::min(text.find_first_of(blanks, begin), text.size());
        const std::string_view word = text.substr(begin, end - begin);
        double& number = numbers.emplace_back();
        const auto read = std::from_chars(word.begin(), word.end(), number);
        if (read.ec != std::errc() || read.ptr != word.end() || !std::isfinite(number))
            throw pbs::InputError(path, 0, array, std::string(word),
                                  fmt::format("expected a finite number at place {}", numbers.size()));
    }
    return numbers;
}

// The array of a field: one row per point.
Eigen::MatrixXd rows_in(const std::string& path, const std::string& array, const pugi::xml_node& node,
                        Eigen::Index points)
{
    const std::vector<double> numbers = numbers_in(path, array, node.text().get());
    const auto size = static_cast<Eigen::Index>(numbers.size());
    const Eigen::Index components = std::max(1, node.attribute("NumberOfComponents").as_int(1));
    if (size != points * components)
        throw pbs::InputError(path, 0, array, fmt::format("{} numbers", size),
                              fmt::format("expected {} for each of the {} points", components, points));
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(numbers.data(),
                                                                                                    points, components);
}

bool is_plain(const pugi::xml_node& array)
{
    return std::string_view(array.attribute("format").value()) == "ascii";
}

}  // namespace

std::string plain_vtu(const pbs::TetMesh& mesh, const PlainFields& fields)
{
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "<UnstructuredGrid>\n<FieldData>\n";
    for (const auto& [name, value] : fields.facts)
        text += fmt::format(
            "<DataArray type=\"Float64\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n", name,
            value);
    text += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
                        mesh.rest.rows(), mesh.tets.rows());
    for (const auto& [name, values] : fields.of_points) add_array(text, "Float64", name, values, values.cols());
    for (const auto& [name, labels] : fields.labels_of_points) add_labels(text, name, labels);
    text += "</PointData>\n<CellData>\n";
    for (const auto& [name, labels] : fields.labels_of_tets) add_labels(text, name, labels);
    text += "</CellData>\n<Points>\n";
    add_array(text, "Float64", "points", mesh.rest, 3);
    text += "</Points>\n";
    add_cells(text, mesh.tets);
    text += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return text;
}

PlainFields read_plain_fields(const std::string& path)
{
    if (std::filesystem::file_size(path) > pbs::most_text_bytes) return {};
    const std::string text = analysis::read_text(path);
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) return {};  // a file of another format
    const pugi::xml_node grid = document.child("VTKFile").child("UnstructuredGrid"), piece = grid.child("Piece");
    if (piece.next_sibling("Piece")) return {};
    PlainFields fields;
    for (const pugi::xml_node& array : grid.child("FieldData").children("DataArray")) {
        const std::string name = array.attribute("Name").value();
        if (!is_plain(array) || array.attribute("NumberOfTuples").as_int() != 1) continue;
        fields.facts[name] = rows_in(path, name, array, 1)(0);
    }
    const auto points = static_cast<Eigen::Index>(piece.attribute("NumberOfPoints").as_llong());
    for (const pugi::xml_node& array : piece.child("PointData").children("DataArray")) {
        const std::string name = array.attribute("Name").value();
        if (is_plain(array)) fields.of_points[name] = rows_in(path, name, array, points);
    }
    return fields;
}

}  // namespace experiments
