#include "experiments/deformers/external/external_deformers.hpp"

#include "experiments/deformers/external/exchange_folder.hpp"
#include "experiments/deformers/external/pbskin_deformer.h"
#include "pbs/geometry/stopwatch.hpp"

#include <fmt/format.h>

#include <dlfcn.h>

namespace experiments {
namespace {

class LibraryDeformer : public Deformer {
public:
    explicit LibraryDeformer(const ExternalOptions& options) : options_(options)
    {
        handle_ = dlopen(options.library.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!handle_) refuse_external(options, std::string("cannot be loaded: ") + dlerror());
        const int version = function<decltype(pbskin_deformer_version)>("pbskin_deformer_version")();
        if (version != PBSKIN_DEFORMER_VERSION)
            refuse_external(options, fmt::format("was compiled for version {} of pbskin_deformer.h: expected version {}", version,
                                                 PBSKIN_DEFORMER_VERSION));
        create_ = function<decltype(pbskin_deformer_create)>("pbskin_deformer_create");
        advance_ = function<decltype(pbskin_deformer_advance)>("pbskin_deformer_advance");
        destroy_ = function<decltype(pbskin_deformer_destroy)>("pbskin_deformer_destroy");
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
        deformer_ = create_(&given);
        if (!deformer_) refuse_external(options_, "pbskin_deformer_create returned null: expected a deformer");
        positions_ = character.mesh.rest;
    }

    bool has_memory() const override { return options_.has_memory; }
    const pbs::Positions& positions() const override { return positions_; }

    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        const std::vector<double> transforms = transform_rows(pose);
        const pbs::Stopwatch stopwatch;
        const int status = advance_(deformer_, transforms.data(), dt_s, positions_.data());
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        if (status != 0) refuse_external(options_, fmt::format("pbskin_deformer_advance returned {}: expected 0", status));
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

private:
    template <typename Function>
    Function* function(const char* name) const
    {
        void* address = dlsym(handle_, name);
        if (!address) refuse_external(options_, std::string("has no function ") + name);
        return reinterpret_cast<Function*>(address);
    }

    void release()
    {
        if (deformer_) destroy_(deformer_);
        deformer_ = nullptr;
    }

    ExternalOptions options_;
    void *handle_ = nullptr, *deformer_ = nullptr;
    decltype(pbskin_deformer_create)* create_ = nullptr;
    decltype(pbskin_deformer_advance)* advance_ = nullptr;
    decltype(pbskin_deformer_destroy)* destroy_ = nullptr;
    pbs::Positions positions_;
};

}  // namespace

std::unique_ptr<Deformer> make_library_deformer(const ExternalOptions& options)
{
    return std::make_unique<LibraryDeformer>(options);
}

}  // namespace experiments
