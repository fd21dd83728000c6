#pragma once

#include <span>
#include <string_view>

namespace tetrace::fuzz {

/// What the program does with one kind of input. Refusing it with an Error is right; anything else that ends a target
/// early is a finding: another exception, a crash, a leak, a hang, memory over the limit.
struct Target {
    std::string_view name; ///< of its folder in corpus/ too
    void (*run)(std::string_view bytes);
};

/// Those that read scenes and meshes: they need only scenes/ and its builder.
[[nodiscard]] std::span<const Target> file_targets();
/// Those of bench/: options and results.
[[nodiscard]] std::span<const Target> word_targets();

} // namespace tetrace::fuzz
