#include "backends/embree/backend.h"

#include "backends/embree/session.h"
#include "core/base/error.h"
#include "core/device/device_facts.h"
#include "core/device/host.h"

#include <memory>
#include <omp.h>
#include <vector>

namespace tetrace {
namespace {

Device embree_device(const embree::Abilities& abilities)
{
    Device device = host_device();
    device.driver = embree::version_text();
    device.implementation = "embree";
    device.threads = static_cast<unsigned>(omp_get_max_threads());
    device.group_width = abilities.native_width;
    return device;
}

class EmbreeBackend : public Backend {
public:
    EmbreeBackend()
    {
        try {
            abilities_ = embree::abilities();
            devices_ = {embree_device(abilities_)};
        } catch (const Error& error) { // the program starts without it
            devices_ = {unusable_device("none", error.what())};
        }
    }
    [[nodiscard]] std::string name() const override { return "embree"; }
    [[nodiscard]] std::string clock() const override { return "host steady clock"; }

    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override
    {
        return kernel.structure == Structure::bvh && is_embree(kernel.layout) && has_task(kernel);
    }

    [[nodiscard]] std::string why_not(std::size_t, const KernelId& kernel) const override
    {
        if (!has_kernel(kernel)) return "Embree traces its own BVH only";
        return embree::why_not_traced(abilities_, kernel.method);
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        if (const auto reason = why_not(0, kernel); !reason.empty()) throw Error(ErrorKind::unsupported, reason);
        const unsigned threads = options.threads != 0 ? options.threads : devices_.front().threads;
        return std::make_unique<embree::EmbreeSession>(
            kernel, abilities_.native_width, tree(*scene.mesh, embree::tree_of(kernel.layout), threads), threads);
    }

    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode, std::span<const Quad>) override { return {}; }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    /// Sessions that are open together share their trees: a scene has a row for each entry point.
    struct SharedTree {
        const TriangleMesh* mesh; // alive as long as a session has the tree
        embree::Tree kind;
        unsigned threads;
        std::weak_ptr<const embree::Accelerator> tree;
    };

    [[nodiscard]] std::shared_ptr<const embree::Accelerator> tree(const TriangleMesh& mesh, embree::Tree kind,
                                                                  unsigned threads)
    {
        std::erase_if(trees_, [](const SharedTree& shared) { return shared.tree.expired(); });
        for (const SharedTree& shared : trees_)
            if (shared.mesh == &mesh && shared.kind == kind && shared.threads == threads) return shared.tree.lock();
        auto made = std::make_shared<const embree::Accelerator>(mesh, kind, threads);
        trees_.push_back({&mesh, kind, threads, made});
        return made;
    }

    embree::Abilities abilities_;
    std::vector<Device> devices_;
    std::vector<SharedTree> trees_;
};

} // namespace

Backend& embree_backend()
{
    static EmbreeBackend backend;
    return backend;
}

} // namespace tetrace
