// Readers of meshes, scenes and archives meet inputs that nobody would write.
#include "scenes/scene_file.h"
#include "tests/fuzz/corpus_runs.h"
#include "tests/fuzz/memory_file.h"

using namespace tetrace::fuzz;

TEST(FuzzFiles, no_changed_input_crashes_a_reader)
{
    for (const Target& target : file_targets()) {
        SCOPED_TRACE(target.name);
        run_changed(target, 2000);
    }
}

// Were it of another version of the format, every change of it would be refused at the first bytes.
TEST(FuzzFiles, the_scene_of_the_corpus_is_read_unchanged)
{
    for (const Target& target : file_targets()) {
        if (std::string_view(target.name) != "tet") continue;
        const std::string checked = corpus_of(target).front();
        EXPECT_GT(tetrace::read_scene(MemoryFile(checked.substr(1)).path()).tets.tets.size(), 0u);
    }
}
