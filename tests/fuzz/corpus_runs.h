#pragma once

#include "tests/fuzz/targets.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tetrace::fuzz {

/// The files of a target's folder in corpus/, in the order of their names.
inline std::vector<std::string> corpus_of(const Target& target)
{
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(TETRACE_CORPUS) / target.name))
        paths.push_back(entry.path());
    std::ranges::sort(paths);
    std::vector<std::string> corpus;
    for (const auto& path : paths) {
        std::ifstream file(path, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return corpus;
}

/// One change: a bit, a byte of those that numbers and texts trip over, a piece removed, doubled or replaced by another
/// input's.
inline void change(std::string& bytes, const std::vector<std::string>& corpus, test::Random& random)
{
    const auto below = [&](std::size_t end) { return random.below(static_cast<std::uint32_t>(end)); };
    if (bytes.empty()) bytes = "0";
    const std::size_t place = below(bytes.size()), length = 1 + below(std::min<std::size_t>(64, bytes.size() - place));
    switch (below(6)) {
    case 0: bytes[place] = static_cast<char>(bytes[place] ^ (1 << below(8))); break;
    case 1: bytes[place] = "\0\xff\x7f\x80-9eE.\n\"[{ "[below(15)]; break;
    case 2: bytes.erase(place, length); break;
    case 3: bytes.insert(place, bytes.substr(place, length)); break;
    case 4: bytes.resize(place); break;
    default: {
        const std::string& other = corpus[below(corpus.size())];
        if (!other.empty()) bytes.replace(place, length, other.substr(below(other.size()), 1 + below(64)));
    }
    }
}

/// Runs a target on its corpus, and then on inputs that were changed, the same ones on every machine.
inline void run_changed(const Target& target, int runs)
{
    const std::vector<std::string> corpus = corpus_of(target);
    ASSERT_FALSE(corpus.empty()) << target.name;
    const auto run_one = [&](const std::string& bytes, int run) {
        try {
            target.run(bytes);
        } catch (const std::exception& problem) {
            ADD_FAILURE() << target.name << ", run " << run << ": " << problem.what();
        }
    };
    for (const std::string& bytes : corpus)
        run_one(bytes, -1);
    test::Random random(19);
    for (int run = 0; run < runs; ++run) {
        std::string bytes = corpus[static_cast<std::size_t>(run) % corpus.size()];
        for (std::uint32_t left = 1 + random.below(4); left > 0; --left)
            change(bytes, corpus, random);
        run_one(bytes, run);
    }
}

} // namespace tetrace::fuzz
