#include "experiments/deformers/external/external_deformers.hpp"

#include "experiments/deformers/external/pbskin_deformer.h"
#include "pbs/geometry/cost.hpp"

#include <fmt/format.h>

#include <dlfcn.h>

#include <type_traits>

namespace experiments {
namespace {

struct LibraryFunctions {
    decltype(pbskin_deformer_version)* version = nullptr;
    decltype(pbskin_deformer_create)* create = nullptr;
    decltype(pbskin_deformer_advance)* advance = nullptr;
    decltype(pbskin_deformer_destroy)* destroy = nullptr;
};

// Returns why the library cannot be used, or an empty text if it can.
std::string load(const std::string& library, LibraryFunctions& functions)
{
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) return std::string("cannot be loaded: ") + dlerror();
    std::string missing;
    const auto find = [&](const char* name, auto*& function) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
        if (!function && missing.empty()) missing = std::string("has no function ") + name;
    };
    find("pbskin_deformer_version", functions.version);
    if (functions.version && functions.version() != PBSKIN_DEFORMER_VERSION)
        return fmt::format("was compiled for version {} of pbskin_deformer.h: expected version {}", functions.version(),
                           PBSKIN_DEFORMER_VERSION);
    find("pbskin_deformer_create", functions.create);
    find("pbskin_deformer_advance", functions.advance);
    find("pbskin_deformer_destroy", functions.destroy);
    return missing;
}

class LibraryDeformer : public Deformer {
public:
    explicit LibraryDeformer(const ExternalOptions& options) : options_(options)
    {
        const std::string why_not = load(options.library, functions_);
        if (!why_not.empty()) refuse_external(options, why_not);
    }
    ~LibraryDeformer() override { release(); }  // the library itself stays loaded: its threads and statics may be in use
    LibraryDeformer(const LibraryDeformer&) = delete;
    LibraryDeformer& operator=(const LibraryDeformer&) = delete;

    void reset(const pbs::Character& character) override
    {
        release();
        const std::size_t bones = character.skeleton.bones.size();
        const std::vector<double> weights = dense_weights(character.weights, bones);
        std::vector<double> ends;
        std::vector<int> parents;
        for (const pbs::Bone& bone : character.skeleton.bones) {
            ends.insert(ends.end(), bone.head.begin(), bone.head.end());
            ends.insert(ends.end(), bone.tail.begin(), bone.tail.end());
            parents.push_back(bone.parent);
        }
        const pbskin_character given = {static_cast<int>(character.mesh.rest.rows()),
                                        static_cast<int>(character.mesh.tets.rows()),
                                        static_cast<int>(bones),
                                        character.mesh.rest.data(),
                                        character.mesh.tets.data(),
                                        weights.data(),
                                        ends.data(),
                                        parents.data()};
        deformer_ = functions_.create(&given);
        if (!deformer_) refuse_external(options_, "pbskin_deformer_create returned null: expected a deformer");
        positions_ = character.mesh.rest;
    }

    bool has_memory() const override { return options_.has_memory; }
    const pbs::Positions& positions() const override { return positions_; }

    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        const std::vector<double> transforms = transform_rows(pose);
        const pbs::Stopwatch stopwatch;
        const int status = functions_.advance(deformer_, transforms.data(), dt_s, positions_.data());
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        if (status != 0) refuse_external(options_, fmt::format("pbskin_deformer_advance returned {}: expected 0", status));
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

private:
    void release()
    {
        if (deformer_) functions_.destroy(deformer_);
        deformer_ = nullptr;
    }

    ExternalOptions options_;
    LibraryFunctions functions_;
    void* deformer_ = nullptr;
    pbs::Positions positions_;
};

}  // namespace

std::string why_library_not_usable(const std::string& library)
{
    LibraryFunctions functions;
    return load(library, functions);
}

std::unique_ptr<Deformer> make_library_deformer(const ExternalOptions& options)
{
    return std::make_unique<LibraryDeformer>(options);
}

}  // namespace experiments
