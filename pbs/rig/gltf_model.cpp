#define TINYGLTF_IMPLEMENTATION
#include "pbs/rig/gltf_rig.hpp"

#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string_view>
#include <type_traits>

namespace pbs {
namespace {

constexpr std::size_t most_elements = 100'000'000;

// Extensions by how their names begin that do not change where vertices are, and the one that stores them as integers.
constexpr std::array<std::string_view, 6> known_extensions = {"KHR_materials_",      "KHR_texture_", "EXT_texture_",
                                                              "KHR_lights_punctual", "KHR_xmp",      "KHR_mesh_quantization"};

bool file_exists(const std::string& file, void* path)
{
    return may_be_opened_for(*static_cast<const std::string*>(path), file);
}

bool read_own_file(std::vector<unsigned char>* bytes, std::string* error, const std::string& file, void* path)
{
    if (!file_exists(file, path)) {
        *error += "expected a regular file below the folder of the one that refers to it: " + file;
        return false;
    }
    const std::string text = read_text_file(file, most_mesh_bytes);
    bytes->assign(text.begin(), text.end());
    return true;
}

void require_known_extensions(const tinygltf::Model& model, const std::string& path)
{
    for (const std::string& extension : model.extensionsRequired)
        if (std::none_of(known_extensions.begin(), known_extensions.end(),
                         [&](std::string_view known) { return extension.rfind(known, 0) == 0; }))
            throw InputError(path, 0, "extensionsRequired", extension, "not supported: export the model without it");
}

std::string one_line(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

// The place of a number in the file, for errors.
struct Field {
    const std::string& path;
    const std::string& name;

    [[noreturn]] void refuse(const std::string& value, const std::string& rule) const { throw InputError(path, 0, name, value, rule); }
};

// A signed integer c of b bits means max(c / (2^(b-1) - 1), -1), an unsigned one c / (2^b - 1).
template <typename Number>
double converted(const unsigned char* bytes, bool normalised)
{
    Number number{};
    std::memcpy(&number, bytes, sizeof number);
    if (std::is_floating_point_v<Number> || !normalised) return static_cast<double>(number);
    return std::max(static_cast<double>(number) / static_cast<double>(std::numeric_limits<Number>::max()), -1.0);
}

struct Component {
    int type;
    std::size_t bytes;
    double (*number_at)(const unsigned char* bytes, bool normalised);
};

const Component& component_of(int type, const Field& field)
{
    static constexpr Component components[] = {{TINYGLTF_COMPONENT_TYPE_BYTE, 1, converted<std::int8_t>},
                                               {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, converted<std::uint8_t>},
                                               {TINYGLTF_COMPONENT_TYPE_SHORT, 2, converted<std::int16_t>},
                                               {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 2, converted<std::uint16_t>},
                                               {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 4, converted<std::uint32_t>},
                                               {TINYGLTF_COMPONENT_TYPE_FLOAT, 4, converted<float>}};
    for (const Component& component : components)
        if (component.type == type) return component;
    field.refuse(std::to_string(type), "expected a component type of glTF 2.0: 5120 to 5123, 5125 or 5126");
}

// A matrix whose columns of bytes would have to be padded is refused by the caller's number of components: only 4 x 4 floats are asked for.
struct Layout {
    int component_type = 0;
    bool normalised = false;
    std::size_t count = 0, components = 0, offset = 0;
};

AccessorNumbers read_elements(const tinygltf::Model& model, int view_index, const Layout& layout, const Field& field)
{
    if (view_index < 0 || view_index >= static_cast<int>(model.bufferViews.size()))
        field.refuse(std::to_string(view_index), "expected a buffer view of the file");
    const tinygltf::BufferView& view = model.bufferViews[view_index];
    if (view.buffer < 0 || view.buffer >= static_cast<int>(model.buffers.size()))
        field.refuse(std::to_string(view.buffer), "expected a buffer of the file");
    const std::vector<unsigned char>& bytes = model.buffers[view.buffer].data;
    const Component& component = component_of(layout.component_type, field);
    const std::size_t element = component.bytes * layout.components;
    const std::size_t stride = view.byteStride > 0 ? view.byteStride : element;
    const bool view_fits = view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset;
    if (!view_fits || layout.offset > view.byteLength || layout.count > most_elements || stride < element || stride > 252 + element ||
        (layout.count > 0 && (layout.count - 1) * stride + element > view.byteLength - layout.offset))
        field.refuse(std::to_string(layout.count), "its elements reach beyond the bytes of their buffer");

    AccessorNumbers numbers(static_cast<Eigen::Index>(layout.count), static_cast<Eigen::Index>(layout.components));
    for (std::size_t e = 0; e < layout.count; ++e)
        for (std::size_t c = 0; c < layout.components; ++c)
            numbers(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(c)) =
                component.number_at(bytes.data() + view.byteOffset + layout.offset + e * stride + c * component.bytes, layout.normalised);
    return numbers;
}

void apply_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, const Field& field, AccessorNumbers& numbers)
{
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        field.refuse(std::to_string(sparse.count), "expected counts and offsets of 0 or more");
    const auto count = static_cast<std::size_t>(sparse.count), components = static_cast<std::size_t>(numbers.cols());
    const AccessorNumbers indices =
        read_elements(model, sparse.indices.bufferView,
                      {sparse.indices.componentType, false, count, 1, static_cast<std::size_t>(sparse.indices.byteOffset)}, field);
    const AccessorNumbers values = read_elements(
        model, sparse.values.bufferView,
        {accessor.componentType, accessor.normalized, count, components, static_cast<std::size_t>(sparse.values.byteOffset)}, field);
    for (Eigen::Index i = 0; i < indices.rows(); ++i) {
        if (!(indices(i, 0) >= 0.0 && indices(i, 0) < static_cast<double>(numbers.rows())))
            field.refuse(std::to_string(indices(i, 0)), "expected an index of the accessor's elements");
        numbers.row(static_cast<Eigen::Index>(indices(i, 0))) = values.row(i);
    }
}

}  // namespace

void read_gltf_model(const std::string& path, tinygltf::Model& model)
{
    const std::string bytes = read_text_file(path, most_mesh_bytes), folder = std::filesystem::absolute(path).parent_path().string();
    std::string own_path = path, error, warning;
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader([](tinygltf::Image*, auto...) { return true; }, nullptr);
    loader.SetFsCallbacks({file_exists, [](const std::string& file, void*) { return file; }, read_own_file, nullptr, &own_path});
    const auto length = static_cast<unsigned>(bytes.size());
    const bool read =
        bytes.rfind("glTF", 0) == 0
            ? loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()), length, folder)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), length, folder);
    if (!read) {
        require_known_extensions(model, path);  // which may be why
        throw InputError(path, 0, "", "", "no glTF that tinygltf can read: " + one_line(error));
    }
    if (model.asset.version.rfind("2.", 0) != 0) throw InputError(path, 0, "asset.version", model.asset.version, "expected 2.0");
    require_known_extensions(model, path);
}

AccessorNumbers accessor_numbers(const tinygltf::Model& model, int accessor, int components, const std::string& path,
                                 const std::string& field_name)
{
    const Field field{path, field_name};
    if (accessor < 0 || accessor >= static_cast<int>(model.accessors.size()))
        field.refuse(std::to_string(accessor), "expected an accessor of the file");
    const tinygltf::Accessor& from = model.accessors[accessor];
    if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type)) != components)
        field.refuse(std::to_string(accessor), "expected an accessor with " + std::to_string(components) + " numbers per element");
    if (from.count > most_elements) field.refuse(std::to_string(from.count), "expected at most 100,000,000 elements");

    AccessorNumbers numbers = AccessorNumbers::Zero(static_cast<Eigen::Index>(from.count), components);  // of a purely sparse one
    if (from.bufferView >= 0)
        numbers =
            read_elements(model, from.bufferView,
                          {from.componentType, from.normalized, from.count, static_cast<std::size_t>(components), from.byteOffset}, field);
    if (from.sparse.isSparse) apply_sparse(model, from, field, numbers);
    if (!numbers.allFinite()) field.refuse(std::to_string(accessor), "expected finite numbers");
    return numbers;
}

}  // namespace pbs
