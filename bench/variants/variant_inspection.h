#pragma once

#include "bench/variants/variant_trials.h"

namespace tetrace {

/// Compiles variants of each kernel for each target of --target, as run_trials(); nothing runs. A variant fails if it
/// does not compile, or if a fused operation decides a sign and none does in the unchanged kernel. A row is a program
/// of a target's compiler, with those of its entry points that the options keep. Throws Error{usage} if no kernel is
/// kept.
[[nodiscard]] std::vector<VariantRow> inspect_variants(const Options& options, const Budget& budget);

} // namespace tetrace
