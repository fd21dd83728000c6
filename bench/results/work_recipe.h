#pragma once

#include "bench/results/result_file.h"

#include <string>

namespace tetrace {

/// How to do the work of one result's scene where another result did something else.
struct WorkRecipe {
    std::string options;     ///< those that B lacked, as a command line takes them: "--scene bunny-1 --size 512x512"
    bool usual_tets = false; ///< whether B has to leave out what it asked for of tets
    std::string obstacle;    ///< why no options bring back all of A's work; empty if they do

    /// Both as a sentence's end: "measure B with --size 512x512".
    [[nodiscard]] std::string text() const;
};

/// What to change in B's run of a scene so that its rows do A's work: scene, tets, cameras, views, size. same_geometry:
/// nothing has to change of what the rays hit, as for rows of BVHs whose meshes are the same. Tets for rays that A's
/// version of tetrace made, and that are not pinned (scenes/pinned.h), can be out of reach.
[[nodiscard]] WorkRecipe work_recipe(const ResultScene& a, const ResultScene& b, bool same_geometry);

/// For results that share no row: A's command line, if A has it; else the options that select A's rows, each with its
/// values in A, where B lacks one of these, or A's verb. As a sentence's end, or empty.
[[nodiscard]] std::string rows_recipe(const ResultFile& a, const ResultFile& b);

} // namespace tetrace
