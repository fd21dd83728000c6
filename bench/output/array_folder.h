#pragma once

#include "bench/measuring/verify.h"
#include "bench/options/options.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace tetrace {

/// Writes the verified answers of rows into a folder, as .npy files of records (docs/volume.md): one for each row and
/// view, and for each row of task tally one of the sums per tet.
class ArrayFolder {
public:
    /// Makes the folder. Throws Error{invalid_input} naming it if it cannot be made or written.
    explicit ArrayFolder(std::filesystem::path folder);

    /// Writes the answers of a view; after the last view of a scene also the sums of all views. Throws as write_npy()
    /// does.
    void see(const SeenImage& image);
    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

private:
    void add_tally(const SeenImage& image, const std::string& name);

    std::filesystem::path folder_;
    std::map<std::string, std::vector<std::uint64_t>> sums_; ///< by row; by tet, in packed order
};

/// The folder of --out-arrays; null if there is none. Throws as the constructor does, and Error{usage} together with
/// options by which a run would lack views, or have them twice.
[[nodiscard]] std::unique_ptr<ArrayFolder> make_array_folder(const Options& options);

} // namespace tetrace
