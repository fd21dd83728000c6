#pragma once

#include "bench/variants/changes.h"
#include "core/device/backend.h"
#include "core/pack/kernel_id.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// The text of a backend's kernel, and programs of its variants.
class VariantProgram {
public:
    /// Throws Error{unsupported} if the backend has no text of the kernel that a compiler can be given here.
    VariantProgram(const std::string& backend, const KernelId& kernel);

    [[nodiscard]] const VariantText& text() const { return text_; }

    /// Writes the program of a text into a folder, as SessionOptions::program_file has it; returns its file. Throws
    /// Error{driver} with its messages if its compiler refuses the text, and Error{missing} if it is not installed.
    [[nodiscard]] std::filesystem::path write(const std::string& text, const std::filesystem::path& folder) const;

    /// A text with the command that makes its program, or for OpenCL that checks it. more: follows what the unchanged
    /// text is.
    [[nodiscard]] KernelFile text_file(const std::string& text, const std::string& more) const
    {
        return {source_.name, source_.what + more, source_.readme_command, text};
    }

private:
    struct Source {
        std::string name, text;
        std::string program, command;     ///< that makes the program of the text; empty: the text is the program
        std::string package;              ///< that has the compiler
        std::string what, readme_command; ///< of the text, as kernel_files() has them, or that makes the program
    };
    static Source source_of(const std::string& backend, const KernelId& kernel);
    explicit VariantProgram(Source source) : source_(std::move(source)), text_(source_.text) {}

    Source source_;
    VariantText text_;
};

/// The backends with texts that a compiler can be given here; kernels of the others are parts of this program. Loads no
/// driver.
[[nodiscard]] std::vector<std::string> backends_with_texts();

} // namespace tetrace
