#pragma once

#include "scenes/builder/gltf_file.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// The values of an accessor, checked to be inside its buffers; sparse ones too.
class GltfValues {
public:
    /// components: of an element, 1 or 3. Throws as MeshSource::fail does.
    GltfValues(GltfFile& file, std::uint64_t accessor, std::size_t components, std::string place);

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] bool has_whole_numbers() const;
    /// NaN if the type of component is none of glTF's; so is refused as a coordinate and as an index.
    [[nodiscard]] double at(std::size_t element, std::size_t component) const;

private:
    /// Elements of one type in a buffer view.
    struct Elements {
        const char* data = nullptr; ///< null: all are 0
        std::uint64_t type = 0;
        std::size_t size = 0, stride = 0; ///< of a component, and from one element to the next
        bool is_normalized = false;

        [[nodiscard]] double at(std::size_t element, std::size_t component) const;
    };

    [[nodiscard]] Elements elements(GltfFile& file, const nlohmann::json& object, std::uint64_t type, std::size_t count,
                                    std::size_t components, const std::string& place) const;
    void read_sparse(GltfFile& file, const nlohmann::json& sparse, std::size_t components, const std::string& place);

    std::size_t count_ = 0;
    Elements all_, replacements_;
    std::vector<std::size_t> replaced_; ///< numbers of the elements that replacements_ has; rising
};

} // namespace tetrace
