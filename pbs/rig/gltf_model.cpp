#include "pbs/rig/gltf_model.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/own_folder.hpp"
#include "pbs/geometry/text_file.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace pbs {
namespace {

// Extensions by how their names begin that do not change where vertices are, and the one that stores them as integers.
constexpr std::array<std::string_view, 6> known_extensions = {"KHR_materials_",      "KHR_texture_", "EXT_texture_",
                                                              "KHR_lights_punctual", "KHR_xmp",      "KHR_mesh_quantization"};

bool no_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*)
{
    return true;
}

bool file_exists(const std::string& file, void* path)
{
    return may_be_opened_for(*static_cast<const std::string*>(path), file);
}

std::string file_as_named(const std::string& file, void*)
{
    return file;
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

}  // namespace

void read_gltf_model(const std::string& path, tinygltf::Model& model)
{
    const std::string bytes = read_text_file(path, most_mesh_bytes), folder = std::filesystem::absolute(path).parent_path().string();
    std::string own_path = path, error, warning;
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(no_image, nullptr);
    loader.SetFsCallbacks({file_exists, file_as_named, read_own_file, nullptr, &own_path});
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

}  // namespace pbs
