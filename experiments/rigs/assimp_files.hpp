// assimp's one door, for COLLADA files and the materials of FBX files. It gets the bytes of the file itself, and opens
// only files that content_format.hpp allows: the file itself and regular files below its folder. It chooses its reader
// by the file's name, so that it is given a name whose extension fits the content.
//   Assimp::Importer importer;
//   const aiScene& scene = read_scene(importer, path, aiProcess_Triangulate);
#pragma once

#include "experiments/meshes/content_format.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/source_file.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>

#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

namespace pbs {

class OwnFolder : public Assimp::DefaultIOSystem {
public:
    // path: the file that is read; it may lie anywhere. text: if not empty, a COLLADA document in place of its content;
    // it outlives the object.
    explicit OwnFolder(const std::string& path, std::string_view text = {})
        : path_(path),
          name_(text.empty() ? path_by_content(path) : path + ".dae"),
          source_(path),
          text_(text.empty() ? source_.text(most_mesh_bytes) : text)
    {
    }

    // The path, or one of no file with another extension, in whose place the file is opened.
    const std::string& name_by_content() const { return name_; }

    // False, too, for what may not be opened.
    bool Exists(const char* named) const override { return allows(file_of(named)); }

    // Null for what may not be opened; the first such file that is there is remembered.
    Assimp::IOStream* Open(const char* named, const char* mode) override
    {
        const std::string file = file_of(named);
        if (file == path_)
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
        if (allows(file)) return DefaultIOSystem::Open(file.c_str(), mode);
        std::error_code ignored;
        if (refused_.empty() && std::filesystem::exists(file, ignored)) refused_ = file;
        return nullptr;
    }

    // InputError where assimp requested a file that exists and was not given to it.
    void refuse_what_was_referred_to() const
    {
        if (!refused_.empty())
            throw InputError(path_, 0, "referred file", refused_,
                             "expected a regular file below the folder of the one that refers to it");
    }

private:
    bool allows(const std::string& file) const { return may_be_opened_for(path_, file); }

    std::string file_of(const std::string& named) const { return named == name_ ? path_ : named; }

    std::string path_, name_, refused_;
    SourceFile source_;
    std::string_view text_;  // of the file at path_
};

// The scene, which the importer owns, with a root node. An InputError where assimp cannot read the file. text: as that
// of OwnFolder.
inline const aiScene& read_scene(Assimp::Importer& importer, const std::string& path, unsigned steps,
                                 std::string_view text = {})
{
    auto* files = new OwnFolder(path, text);
    importer.SetIOHandler(files);  // which owns it
    const aiScene* scene = importer.ReadFile(files->name_by_content(), steps);
    if (!scene) files->refuse_what_was_referred_to();
    if (importer.GetErrorString() == std::string("std::bad_alloc")) throw std::bad_alloc();  // which assimp catches
    if (!scene || !scene->mRootNode)
        throw InputError(path, 0, "", "", std::string("assimp: ") + importer.GetErrorString());
    return *scene;
}

}  // namespace pbs
