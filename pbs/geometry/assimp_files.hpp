// assimp opens only files that content_format.hpp allows: the file itself and regular files below its folder. It chooses its reader by the
// file's name, so that it is given a name whose extension fits the content.
//   Assimp::Importer importer;
//   const OwnFolder& files = only_own_folder(importer, path);
//   if (!importer.ReadFile(files.name_by_content(), 0)) files.refuse_what_was_referred_to();
#pragma once

#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/input_error.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace pbs {

class OwnFolder : public Assimp::DefaultIOSystem {
public:
    // path: the file that is read; it may lie anywhere.
    explicit OwnFolder(const std::string& path) : path_(path), name_(path_by_content(path)) {}

    // The path, or one of no file with another extension, in whose place the file is opened.
    const std::string& name_by_content() const { return name_; }

    // False, too, for what may not be opened.
    bool Exists(const char* named) const override
    {
        const std::string file = file_of(named);
        return allows(file) && DefaultIOSystem::Exists(file.c_str());
    }

    // Null for what may not be opened; the first such file that is there is remembered.
    Assimp::IOStream* Open(const char* named, const char* mode) override
    {
        const std::string file = file_of(named);
        if (allows(file)) return DefaultIOSystem::Open(file.c_str(), mode);
        std::error_code ignored;
        if (refused_.empty() && std::filesystem::exists(file, ignored)) refused_ = file;
        return nullptr;
    }

    // InputError where assimp requested a file that exists and was not given to it.
    void refuse_what_was_referred_to() const
    {
        if (!refused_.empty())
            throw InputError(path_, 0, "referred file", refused_, "expected a regular file below the folder of the one that refers to it");
    }

private:
    bool allows(const std::string& file) const { return may_be_opened_for(path_, file); }

    std::string file_of(const std::string& named) const { return named == name_ ? path_ : named; }

    std::string path_, name_, refused_;
};

// The importer owns it.
inline const OwnFolder& only_own_folder(Assimp::Importer& importer, const std::string& path)
{
    auto* files = new OwnFolder(path);
    importer.SetIOHandler(files);
    return *files;
}

// The unit of a file that assimp has read.

// FBX states its unit in centimetres. COLLADA's is in the root's transform, and the other formats have none.
inline double metres_per_unit(const aiScene& scene)
{
    constexpr double metres_per_centimetre = 0.01;
    double centimetres = 0.0;
    float single = 0.0F;
    if (!scene.mMetaData) return 1.0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return metres_per_centimetre * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", single)) return metres_per_centimetre * static_cast<double>(single);
    return 1.0;
}

}  // namespace pbs
