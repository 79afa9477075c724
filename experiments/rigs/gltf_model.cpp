#define TINYGLTF_IMPLEMENTATION
#include "experiments/rigs/rig_formats.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/rigs/tiny_gltf.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace pbs {
namespace {

constexpr std::size_t most_elements = 100'000'000;

// Extensions by how their names begin that do not change where vertices are, although nodes and meshes may have them,
// and the one that stores vertices as integers.
constexpr std::array<std::string_view, 6> known_extensions = {
    "KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_punctual", "KHR_xmp", "KHR_mesh_quantization"};

// Takes the place of an image that is not there: a PNG.
constexpr const char* white_pixel_base64 =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mP4DwABAQEAHLCMmQAAAABJRU5ErkJggg==";

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

// Sets every callback: tinygltf 2.9 ignores an incomplete set and uses its own, which read any file.
template <typename Callbacks>
Callbacks own_files(std::string& path)
{
    Callbacks files{};
    files.FileExists = file_exists;
    files.ExpandFilePath = [](const std::string& file, void*) { return file; };
    files.ReadWholeFile = read_own_file;
    files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    if constexpr (requires { files.GetFileSizeInBytes; })  // not in 2.7
        files.GetFileSizeInBytes = [](std::size_t* size, std::string* error, const std::string& file,
                                      void* path_of_model) {
            std::vector<unsigned char> bytes;
            const bool is_read = read_own_file(&bytes, error, file, path_of_model);
            *size = bytes.size();
            return is_read;
        };
    files.user_data = &path;
    return files;
}

// The JSON of a .gltf file, or of the first chunk of a .glb file; discarded where it is none.
nlohmann::json document_in(const std::string& bytes)
{
    std::uint32_t length = 0;
    const bool is_binary = bytes.starts_with("glTF") && bytes.size() > 20;
    if (is_binary) std::memcpy(&length, bytes.data() + 12, sizeof length);
    return nlohmann::json::parse(is_binary ? bytes.substr(20, length) : bytes, nullptr, false);
}

// Whether an object in this part of a document has the extension.
bool has_extension(const nlohmann::json& part, const std::string& extension)
{
    if (const auto own = part.is_object() ? part.find("extensions") : part.end();
        own != part.end() && own->contains(extension))
        return true;
    return part.is_structured() &&
           std::ranges::any_of(part, [&](const auto& inner) { return has_extension(inner, extension); });
}

// Only an extension of these objects can change where vertices are; materials, textures and images cannot.
bool may_move_vertices(const std::string& extension, const nlohmann::json& document)
{
    if (std::ranges::any_of(known_extensions, [&](std::string_view known) { return extension.starts_with(known); }))
        return false;
    return std::ranges::any_of(
        std::array{"nodes", "meshes", "skins", "animations", "accessors", "bufferViews", "buffers"},
        [&](const char* part) { return document.contains(part) && has_extension(document[part], extension); });
}

void require_known_extensions(const std::string& bytes, const std::string& path)
{
    const nlohmann::json document = document_in(bytes);
    const auto required = document.is_object() ? document.find("extensionsRequired") : document.end();
    if (required == document.end()) return;
    for (const nlohmann::json& extension : *required)
        if (extension.is_string() && may_move_vertices(extension, document))
            throw InputError(path, 0, "extensionsRequired", extension.get<std::string>(),
                             "not supported: export the model without it");
}

// The text of a .gltf file whose buffers may be named as their files are: tinygltf decodes %20, and takes two letters
// behind any other % and each + for codes, too.
std::string with_encoded_names(const std::string& text)
{
    if (text.find_first_of("%+") == std::string::npos) return text;
    nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    if (!document.is_object() || !document.contains("buffers") || !document["buffers"].is_array()) return text;
    for (nlohmann::json& buffer : document["buffers"]) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
        const std::string uri = buffer["uri"];
        if (uri.starts_with("data:")) continue;
        std::string encoded;
        for (std::size_t at = 0; at < uri.size(); ++at) {
            const bool is_code = at + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at + 1])) != 0 &&
                                 std::isxdigit(static_cast<unsigned char>(uri[at + 2])) != 0;
            encoded += uri[at] == '+' ? "%2B" : uri[at] == '%' && !is_code ? "%25" : std::string(1, uri[at]);
        }
        buffer["uri"] = encoded;
    }
    return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string one_line(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (text.starts_with("[json.")) text.erase(0, text.find("] ") + 2);  // the name of an exception
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

// An image in a buffer view is read by image_bytes.
bool keep_image_of_a_data_uri(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                              const unsigned char* bytes, int size, void*)
{
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

// The bytes of an image in the file, below its folder or next to it; empty: there is none.
std::string image_bytes(const tinygltf::Model& model, const tinygltf::Image& image, const std::string& path)
{
    if (image.bufferView >= 0) {
        const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(image.bufferView));
        const std::vector<unsigned char>& bytes = model.buffers.at(static_cast<std::size_t>(view.buffer)).data;
        const bool fits = view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset;
        return fits ? std::string(reinterpret_cast<const char*>(bytes.data()) + view.byteOffset, view.byteLength) : "";
    }
    if (image.uri.empty()) return {image.image.begin(), image.image.end()};
    std::string name = tinygltf::dlib::urldecode(image.uri);
    std::replace(name.begin(), name.end(), '\\', '/');  // of Windows
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    for (const auto& file : {folder / image.uri, folder / name, folder / std::filesystem::path(name).filename()})
        if (may_be_opened_for(path, file.string())) return read_text_file(file.string(), most_mesh_bytes);
    return "";
}

// White is no direction.
void leave_out_normals_of(std::size_t image, nlohmann::json& document)
{
    for (nlohmann::json& material : document["materials"])
        if (const auto normals = material.find("normalTexture"); normals != material.end())
            if (document.at("textures").at(normals->at("index").get<std::size_t>()).value("source", image) == image)
                material.erase(normals);
}

bool has_colours(const tinygltf::Mesh& mesh)
{
    return std::ranges::any_of(mesh.primitives,
                               [](const tinygltf::Primitive& part) { return part.attributes.count("COLOR_0") > 0; });
}

// The place of a number in the file, for errors.
struct Field {
    const std::string& path;
    const std::string& name;

    [[noreturn]] void refuse(const std::string& value, const std::string& rule) const
    {
        throw InputError(path, 0, name, value, rule);
    }
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

// A matrix whose columns of bytes would have to be padded is refused by the caller's number of components: only 4 x 4
// floats are asked for.
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
    if (!view_fits || layout.offset > view.byteLength || layout.count > most_elements || stride < element ||
        stride > 252 + element ||
        (layout.count > 0 && (layout.count - 1) * stride + element > view.byteLength - layout.offset))
        field.refuse(std::to_string(layout.count), "its elements reach beyond the bytes of their buffer");

    AccessorNumbers numbers(static_cast<Eigen::Index>(layout.count), static_cast<Eigen::Index>(layout.components));
    for (std::size_t e = 0; e < layout.count; ++e)
        for (std::size_t c = 0; c < layout.components; ++c)
            numbers(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(c)) = component.number_at(
                bytes.data() + view.byteOffset + layout.offset + e * stride + c * component.bytes, layout.normalised);
    return numbers;
}

void apply_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, const Field& field,
                  AccessorNumbers& numbers)
{
    const auto& sparse = accessor.sparse;
    // Counts and offsets are signed in one version of tinygltf and unsigned in another.
    const auto is_negative = [](auto number) { return static_cast<long long>(number) < 0; };
    if (is_negative(sparse.count) || is_negative(sparse.indices.byteOffset) || is_negative(sparse.values.byteOffset))
        field.refuse(std::to_string(sparse.count), "expected counts and offsets of 0 or more");
    const auto count = static_cast<std::size_t>(sparse.count), components = static_cast<std::size_t>(numbers.cols());
    const AccessorNumbers indices = read_elements(
        model, sparse.indices.bufferView,
        {sparse.indices.componentType, false, count, 1, static_cast<std::size_t>(sparse.indices.byteOffset)}, field);
    const AccessorNumbers values = read_elements(model, sparse.values.bufferView,
                                                 {accessor.componentType, accessor.normalized, count, components,
                                                  static_cast<std::size_t>(sparse.values.byteOffset)},
                                                 field);
    for (Eigen::Index i = 0; i < indices.rows(); ++i) {
        if (!(indices(i, 0) >= 0.0 && indices(i, 0) < static_cast<double>(numbers.rows())))
            field.refuse(std::to_string(indices(i, 0)), "expected an index of the accessor's elements");
        numbers.row(static_cast<Eigen::Index>(indices(i, 0))) = values.row(i);
    }
}

// An InputError for a buffer in a file that is there and may not be opened.
void refuse_buffers_elsewhere(const std::string& bytes, const std::string& path)
{
    const nlohmann::json document = document_in(bytes);
    if (!document.is_object() || !document.contains("buffers")) return;
    for (const nlohmann::json& buffer : document.at("buffers")) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer.at("uri").is_string()) continue;
        const std::string uri = buffer.at("uri").get<std::string>();
        if (uri.starts_with("data:")) continue;
        const std::string file = (std::filesystem::path(path).parent_path() / tinygltf::dlib::urldecode(uri)).string();
        std::error_code ignored;
        if (std::filesystem::exists(file, ignored) && !may_be_opened_for(path, file))
            throw InputError(path, 0, "referred file", file,
                             "expected a regular file below the folder of the one that refers to it");
    }
}

}  // namespace

void read_gltf_model(const std::string& bytes, const std::string& path, tinygltf::Model& model)
{
    const std::string folder = std::filesystem::absolute(path).parent_path().string();
    std::string own_path = path, error, warning;
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_image_of_a_data_uri, nullptr);
    loader.SetFsCallbacks(own_files<tinygltf::FsCallbacks>(own_path));
    bool read = false;
    if (bytes.starts_with("glTF")) {
        constexpr std::size_t version_at = 4;
        if (bytes.size() > version_at && bytes[version_at] != 2)  // little-endian; tinygltf does not ask
            throw InputError(path, 0, "version of the container",
                             std::to_string(static_cast<unsigned char>(bytes[version_at])),
                             "expected 2: convert the file (gltf-pipeline -i FILE)");
        read =
            loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                        static_cast<unsigned>(bytes.size()), folder);
    } else {
        const std::string text = with_encoded_names(bytes);
        read = loader.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                          folder);
    }
    if (!read) {
        require_known_extensions(bytes, path);  // which may be why
        refuse_buffers_elsewhere(bytes, path);
        throw InputError(path, 0, "", "", "no glTF that tinygltf can read: " + one_line(error));
    }
    if (model.asset.version.rfind("2.", 0) != 0)
        throw InputError(path, 0, "asset.version", model.asset.version,
                         "expected 2.0: convert the file (gltf-pipeline -i FILE)");
    if (!model.extensionsRequired.empty()) require_known_extensions(bytes, path);
}

RigMaterials read_gltf_materials(const std::string& path)
{
    return gltf_materials(read_text_file(path, most_mesh_bytes), path);
}

RigMaterials gltf_materials(const std::string& bytes, const std::string& path)
{
    tinygltf::Model model;
    read_gltf_model(bytes, path, model);
    const nlohmann::json source = document_in(bytes);
    RigMaterials materials;
    if (!source.contains("materials")) return materials;
    nlohmann::json document;
    for (const char* part : {"materials", "textures", "samplers", "extensionsUsed"})
        if (source.contains(part)) document[part] = source[part];
    for (std::size_t i = 0; i < model.images.size(); ++i) {
        std::string image = image_bytes(model, model.images[i], path);
        const bool is_jpeg = image.starts_with("\xff\xd8\xff"), is_known = is_jpeg || image.starts_with("\x89PNG");
        if (!is_known) {
            const tinygltf::Image& named = model.images[i];
            materials.remarks.push_back(
                "image " + (named.uri.empty() ? number_text(static_cast<double>(i)) + " " + named.name : named.uri) +
                ": expected PNG or JPEG in the file or below its folder; it is white there");
            image = tinygltf::base64_decode(white_pixel_base64);
            leave_out_normals_of(i, document);
        }
        document["images"].push_back({{"mimeType", is_jpeg ? "image/jpeg" : "image/png"}});
        materials.images.push_back(std::move(image));
    }
    if (std::ranges::any_of(model.meshes, has_colours)) materials.remarks.push_back("colours of points");
    materials.document = document.dump();
    return materials;
}

AccessorNumbers accessor_values(const tinygltf::Model& model, int accessor, int components, const std::string& path,
                                const std::string& field_name)
{
    const Field field{path, field_name};
    if (accessor < 0 || accessor >= static_cast<int>(model.accessors.size()))
        field.refuse(std::to_string(accessor), "expected an accessor of the file");
    const tinygltf::Accessor& from = model.accessors[accessor];
    if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type)) != components)
        field.refuse(std::to_string(accessor),
                     "expected an accessor with " + std::to_string(components) + " numbers per element");
    if (from.count > most_elements) field.refuse(std::to_string(from.count), "expected at most 100,000,000 elements");

    // of a purely sparse one
    AccessorNumbers numbers = AccessorNumbers::Zero(static_cast<Eigen::Index>(from.count), components);
    if (from.bufferView >= 0)
        numbers = read_elements(
            model, from.bufferView,
            {from.componentType, from.normalized, from.count, static_cast<std::size_t>(components), from.byteOffset},
            field);
    if (from.sparse.isSparse) apply_sparse(model, from, field, numbers);
    return numbers;
}

AccessorNumbers accessor_numbers(const tinygltf::Model& model, int accessor, int components, const std::string& path,
                                 const std::string& field_name)
{
    AccessorNumbers numbers = accessor_values(model, accessor, components, path, field_name);
    if (numbers.allFinite()) return numbers;
    Eigen::Index first = 0, bad = 0;
    for (Eigen::Index e = numbers.rows(); e-- > 0;)
        if (!numbers.row(e).allFinite()) {
            first = e;
            ++bad;
        }
    Field{path, field_name}.refuse(std::to_string(bad) + " of " + std::to_string(numbers.rows()) + " elements",
                                   "expected finite numbers, first in element " + std::to_string(first));
}

}  // namespace pbs
