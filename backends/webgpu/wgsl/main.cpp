// kernel_to_wgsl OUT IN PRELUDE MAIN: writes WGSL: PRELUDE, the preprocessed kernel IN translated, and MAIN. An error
// names file and line, with exit code 1.
#include "backends/webgpu/wgsl/translator.h"

#include <fstream>
#include <iostream>
#include <iterator>

namespace {

std::string text_of(const char* path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw tetrace::wgsl::TranslationError(std::string(path) + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

int main(int argc, char** argv)
try {
    if (argc < 5) throw tetrace::wgsl::TranslationError("usage: kernel_to_wgsl OUT IN PRELUDE... MAIN");
    std::string text;
    for (int i = 3; i + 1 < argc; ++i)
        text += text_of(argv[i]);
    text += tetrace::wgsl::translate(text_of(argv[2])) + text_of(argv[argc - 1]);
    std::ofstream out(argv[1], std::ios::binary);
    out << text << std::flush;
    if (!out) throw tetrace::wgsl::TranslationError(std::string(argv[1]) + ": cannot be written");
    return 0;
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
